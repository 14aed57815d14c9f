#include "tools/synth.h"

#include <system_error>
#include <variant>
#include <vector>

#include "sensor/picture_file.h"
#include "sensor/pose.h"
#include "sensor/synthetic/scene_file.h"
#include "sensor/synthetic/synthetic_source.h"
#include "sensor/truth.h"
#include "sensor/write_sequence.h"

namespace patina::tools {
namespace fs = std::filesystem;

void synthesise(vulkan::Device& device, const std::string& scene, uint32_t frames, const fs::path& out) {
    sensor::SyntheticSource source(device, sensor::load_scene(scene), frames);
    sensor::SequenceWriter writer(out, source.info());
    const fs::path truth = writer.partial_folder() / "truth";
    std::error_code failure;
    fs::create_directories(truth / "labels", failure);
    if (failure) throw Error((truth / "labels").string(), " cannot be created: ", failure.message());
    sensor::write_lights(truth / "lights.json", source.scene().lights);
    sensor::write_materials(truth / "materials.json", sensor::materials_of(source.scene()));

    std::vector<sensor::StampedPose> poses;
    while (const auto reading = source.next()) {
        const auto& frame = std::get<sensor::Frame>(*reading);
        writer.write(frame);
        sensor::write_png(truth / "labels" / (sensor::picture_stem(frame.index) + ".png"), source.labels());
        poses.push_back({frame.timestamp_s, *frame.world_from_camera});
    }
    sensor::write_trajectory(truth / "trajectory.txt", poses);
    writer.finish();
}

}  // namespace patina::tools
