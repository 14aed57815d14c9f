#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>
#include <tiny_gltf.h>

namespace patina {

/// A linear colour as normalised u16, alpha 1.
using GltfColor = std::array<uint16_t, 4>;

/// 65535 restarts a primitive, so no vertex may have it as its index.
inline constexpr uint64_t kMostVerticesOfShortIndices = 65535;

/// Append an array to the model's first buffer, with a view and an accessor of their own that are named `name`; return
/// the accessor.
int add_vertices(tinygltf::Model& model, const char* name, const std::vector<glm::vec3>& vectors);
int add_vertices(tinygltf::Model& model, const char* name, const std::vector<float>& values);
int add_vertices(tinygltf::Model& model, const char* name, const std::vector<GltfColor>& colors);

/// Positions, of which there is at least one, with their bounds.
int add_positions(tinygltf::Model& model, const std::vector<glm::vec3>& positions_m);

/// Indices as short as the count of vertices allows.
int add_indices(tinygltf::Model& model, std::span<const std::array<uint32_t, 3>> triangles, uint64_t vertices);

}  // namespace patina
