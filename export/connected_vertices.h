#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace patina {

/// Which vertices of a mesh hang together.
class ConnectedVertices {
  public:
    /// Those of one position do, and those with an edge between them. With `labels` (by vertex) only those of one
    /// label.
    ConnectedVertices(std::span<const glm::vec3> positions_m, std::span<const std::array<uint32_t, 3>> triangles,
                      std::span<const uint32_t> labels = {});

    /// The same for all vertices of a part: the first of them.
    uint32_t part_of(uint32_t vertex);

  private:
    void join(uint32_t a, uint32_t b);

    std::vector<uint32_t> parent_;
};

}  // namespace patina
