#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "patina/scene.h"

namespace patina {

/// Throws Error, naming the file that it is for, where a value is not finite or an index beyond the vertices.
void check_mesh(const std::filesystem::path& path, const Mesh& mesh);
/// The same for what its vertices reflect.
void check_reflectance(const std::filesystem::path& path, const Mesh& mesh, const MeshReflectance& reflectance);

/// The triangles that have an area.
std::vector<std::array<uint32_t, 3>> drawable_triangles(const Mesh& mesh);

/// By vertex, unit length. A normal without direction becomes that of the triangles around it.
std::vector<glm::vec3> unit_normals(const Mesh& mesh, std::span<const std::array<uint32_t, 3>> triangles);

}  // namespace patina
