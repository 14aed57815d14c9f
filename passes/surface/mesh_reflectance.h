#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace patina {

/// Ward's specular material (paper, Eq. 2-4).
struct WardGloss {
    glm::vec3 ks{0};
    float alpha = 1;
    std::optional<float> confidence{};  ///< of an estimate: 0 to 1
};

/// What is known of a segment.
struct SegmentReflectance {
    std::optional<glm::vec3> kd;     ///< mean over its voxels; empty where too few know it
    std::optional<WardGloss> gloss;  ///< empty: all is diffuse
    uint32_t voxels = 0;             ///< that were observed
    uint32_t observations = 0;       ///< kept by them
    float confidence = 0;            ///< mean certainty of kd over its voxels, of the least sure channel: 0 to 1
};

/// What the surface of a mesh reflects.
struct MeshReflectance {
    std::vector<glm::vec4> kd;     ///< by vertex: diffuse albedo; a: 1 known, 0.5 its segment's, 0 unknown (all is 0)
    std::vector<uint32_t> labels;  ///< by vertex: segment, 0 for none
    std::vector<SegmentReflectance> segments;  ///< by label; label 0 is no segment
};

}  // namespace patina
