#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina::sensor::testing {

/// What OpenNI's recorder writes of one stream. The container is written down here a second time, from its reader's
/// description.
struct OniStreamText {
    uint32_t type = 2;  ///< 2: depth, 3: colour
    std::string codec = "NONE";
    Extent2D extent;
    uint64_t pixel_format = 0;  ///< 0: left out
    std::optional<glm::dvec2> view_rad;
    bool mirrored = false;
};

/// A picture, of stream 0 or 1.
struct OniPictureText {
    uint32_t stream = 0;
    uint64_t microseconds = 0;
    std::vector<uint8_t> bytes;
};

/// The bytes of a recording.
std::string oni_recording(const std::vector<OniStreamText>& streams, const std::vector<OniPictureText>& pictures);

/// Depth as the codec "16zT" has it (or "16zP" without `table`).
std::vector<uint8_t> encode_oni_depth(const std::vector<uint16_t>& values, bool table);

}  // namespace patina::sensor::testing
