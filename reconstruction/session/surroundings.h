#pragma once

#include <cstdint>
#include <optional>

#include <glm/glm.hpp>

#include "patina/image.h"
#include "reconstruction/session/bright_surfaces.h"
#include "reconstruction/session/find_lights.h"

namespace patina {

/// The light of a recording of which no lamp is known: what its surfaces send each other is gathered while they are
/// reconstructed; from where nothing is seen, white light arrives under which bright surfaces of the recording's first
/// frames have SessionOptions::white_albedo (BrightSurfaces). Of a source that is read once, a camera, nothing is known
/// before its first frame: SurroundingsSeen takes over from there. Throws Error when the recording cannot be opened;
/// Interrupted when the user stops it.
Illumination light_of_surroundings(vulkan::Device& device, const SessionOptions& options, glm::dvec3 world_offset_m);

/// The same as frames of a camera come.
class SurroundingsSeen {
  public:
    explicit SurroundingsSeen(float white_albedo) : white_albedo_(white_albedo) {}

    /// Takes some of a frame's pixels. What arrives from where nothing is seen, whenever there are twice as many
    /// frames: 1, 2, 4 ... 128; else empty.
    std::optional<glm::vec3> add(const ColorImage& color);

  private:
    float white_albedo_;
    uint32_t frames_ = 0;
    BrightSurfaces bright_;
};

}  // namespace patina
