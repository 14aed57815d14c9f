#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"
#include "tests/reference/shading/ward.h"

namespace patina::reference {

/// What shading needs of a voxel's record.
struct ShadedRecord {
    glm::dvec3 normal{0, 0, 1};
    double offset_vox = 0;  ///< of the surface along the normal, from the voxel's centre
    glm::dvec3 kd{0};
    glm::dvec3 certainty{1};  ///< 0: unknown
    bool marched = true;      ///< `reached` is known
    uint64_t reached = 0;     ///< a bit per light
    uint32_t label = 0;
    std::optional<glm::dvec3> around{};  ///< albedo of the surface around it
};

struct ShadedLight {
    glm::dvec3 position_m;
    glm::dvec3 intensity;
    glm::dvec3 axis{0};  ///< of a flat lamp
};

/// A model and its lights.
struct ShadedScene {
    double voxel_m = 0.02;
    std::map<std::array<int, 3>, ShadedRecord> records;  ///< voxel v spans [v, v + 1) times its size
    std::vector<ShadedLight> lights;
    glm::dvec3 ambient{0};
    std::map<uint32_t, Ward> materials;         ///< by label; kd is not used
    std::map<uint32_t, glm::dvec3> segment_kd;  ///< by label, average_segments(records)
    bool shadows = true;
};

/// The mean kd of each label over its records, weighted by their certainty; only of labels whose records are as certain
/// as three that are.
std::map<uint32_t, glm::dvec3> average_segments(const std::map<std::array<int, 3>, ShadedRecord>& records);

struct ShadedPoint {
    bool known = false;  ///< kd is
    glm::dvec3 kd{0};
    uint32_t label = 0;
    Ward gloss{{}, {}, 0};
    glm::dvec3 rgb{0};
};

/// Reflectance and radiance of a surface point as passes/shading/predict_radiance.h defines them.
ShadedPoint predict_radiance(const ShadedScene& scene, glm::dvec3 point_m, glm::dvec3 normal, glm::dvec3 viewer_m);

}  // namespace patina::reference
