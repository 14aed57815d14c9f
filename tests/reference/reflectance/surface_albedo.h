#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace patina::reference {

/// What a record tells of its albedo.
struct ToldAlbedo {
    glm::dvec3 point_m{0}, normal{0};
    uint32_t label = 0;    ///< 0: none
    glm::dvec3 raw_kd{0};  ///< what it reflects over what it receives, without a bound
    glm::dvec3 light{0};   ///< irradiance over pi
    bool sure = true;      ///< of its light: gathered, and in no shadow's border
};

/// The albedo of the surface around each record; 0 where it is not known. Cells of 16 cm, a quarter of a step of e in
/// brightness, and 0.3 in the logarithms of red and blue over green, whose means are interpolated in place and
/// brightness; drawn to the mean of the same segment and tint by inverse variances. Where a twentieth of the records
/// around asks for an albedo above 2, light is missing.
std::vector<glm::dvec3> surface_albedo(const std::vector<ToldAlbedo>& records);

}  // namespace patina::reference
