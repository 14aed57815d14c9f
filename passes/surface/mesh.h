#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace patina {

/// A welded triangle mesh in world coordinates (metres). The three vertex arrays have one length. Triangles are
/// counter-clockwise seen from outside (free space).
struct Mesh {
    std::vector<glm::vec3> positions_m;
    std::vector<glm::vec3> normals;  ///< unit length, towards free space
    std::vector<glm::vec3> colors;   ///< linear RGB; zero where no colour was seen
    std::vector<std::array<uint32_t, 3>> triangles;
};

}  // namespace patina
