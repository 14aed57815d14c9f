#include "patina/source.h"

#include "reconstruction/api/access.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "sensor/open.h"
#include "sensor/prefetch.h"

namespace patina {

std::unique_ptr<Source> open_recording(const std::filesystem::path& path, const std::string& format) {
    return std::make_unique<sensor::PrefetchSource>(sensor::open_sequence(path, format));
}

std::unique_ptr<Source> open_synthetic(Device& device, const std::string& scene, uint32_t frames) {
    scenes::SyntheticOptions recording;
    if (frames > 0) recording.frames = frames;
    return std::make_unique<scenes::SyntheticSource>(Access::vulkan(device), scenes::load_scene(scene), recording);
}

}  // namespace patina
