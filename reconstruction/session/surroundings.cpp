#include "reconstruction/session/surroundings.h"

#include "cameras/open_sequence.h"
#include "reconstruction/session/bright_surfaces.h"
#include "reconstruction/session/choices.h"
#include "reconstruction/session/rgbd_frame.h"

namespace patina {

namespace {

constexpr uint32_t kMostFrames = 240;  // eight seconds of video, which decode in three

}  // namespace

Illumination light_of_surroundings(vulkan::Device& device, const SessionOptions& options, glm::dvec3 world_offset_m) {
    const auto source = cameras::open_sequence(device, options.sequence, options.format);
    BrightSurfaces bright;
    for (uint32_t looked_at = 0; looked_at < kMostFrames; ++looked_at) {
        if (stop_requested(options.callbacks)) throw Interrupted("interrupted while the brightness was measured");
        const auto reading = source->next();
        if (!reading) break;
        const auto* frame = std::get_if<Frame>(&*reading);
        if (frame != nullptr && !is_held_out(frame->index, options.hold_out)) bright.add(frame->color);
    }
    Illumination light;
    light.found_by = "surroundings";
    light.world_offset_m = world_offset_m;
    light.ambient = glm::dvec3(bright.ambient(options.white_albedo));
    return light;
}

}  // namespace patina
