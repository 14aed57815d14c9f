#include "reconstruction/session/surroundings.h"

#include <bit>

#include "cameras/open_sequence.h"
#include "reconstruction/session/choices.h"
#include "reconstruction/session/rgbd_frame.h"

namespace patina {

namespace {

constexpr uint32_t kMostFrames = 240;     // eight seconds of video, which decode in three
constexpr float kUsualBrightness = 0.5f;  // of bright surfaces, where pictures are exposed for them

}  // namespace

Illumination light_of_surroundings(vulkan::Device& device, const SessionOptions& options, glm::dvec3 world_offset_m) {
    Illumination light;
    light.found_by = "surroundings";
    light.world_offset_m = world_offset_m;
    if (options.sequence.empty()) {
        light.ambient = light.assumed = glm::dvec3(kUsualBrightness / options.white_albedo);
        return light;
    }
    const auto source = cameras::open_sequence(device, options.sequence, options.format);
    BrightSurfaces bright;
    for (uint32_t looked_at = 0; looked_at < kMostFrames; ++looked_at) {
        if (stop_requested(options.callbacks)) throw Interrupted("interrupted while the brightness was measured");
        const auto reading = source->next();
        if (!reading) break;
        const auto* frame = std::get_if<Frame>(&*reading);
        if (frame != nullptr && !is_held_out(frame->index, options.hold_out)) bright.add(frame->color);
    }
    light.ambient = light.assumed = glm::dvec3(bright.ambient(options.white_albedo));
    return light;
}

std::optional<glm::vec3> SurroundingsSeen::add(const ColorImage& color) {
    if (frames_ >= kMostFrames) return std::nullopt;
    bright_.add(color);
    if (!std::has_single_bit(++frames_)) return std::nullopt;
    const glm::vec3 ambient = bright_.ambient(white_albedo_);
    return ambient == glm::vec3(0) ? std::nullopt : std::optional(ambient);  // black pictures tell nothing
}

}  // namespace patina
