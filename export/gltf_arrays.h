#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>
#include <tiny_gltf.h>

#include "export/glb_file.h"

namespace patina {

/// A linear colour as normalised u16, alpha 1.
using GltfColor = std::array<uint16_t, 4>;

/// 65535 restarts a primitive, so no vertex may have it as its index.
inline constexpr uint64_t kMostVerticesOfShortIndices = 65535;

/// Appends arrays to a file's buffer, and describes them in a model: each has a view and an accessor of its own, which
/// are named `name`. Functions return the accessor, and throw Error as GlbFile::append() does.
class GltfArrays {
  public:
    /// Both must outlive this.
    GltfArrays(tinygltf::Model& model, GlbFile& file) : model_(model), file_(file) {}

    int add_vertices(const char* name, const std::vector<glm::vec3>& vectors);
    int add_vertices(const char* name, const std::vector<glm::vec2>& vectors);
    int add_vertices(const char* name, const std::vector<glm::vec4>& vectors);
    int add_vertices(const char* name, const std::vector<float>& values);
    int add_vertices(const char* name, const std::vector<GltfColor>& colors);

    /// Positions, of which there is at least one, with their bounds.
    int add_positions(const std::vector<glm::vec3>& positions_m);

    /// Indices as short as the count of vertices allows.
    int add_indices(std::span<const std::array<uint32_t, 3>> triangles, uint64_t vertices);

    /// Bytes that are no array, such as a picture's. Returns their view.
    int add_bytes(const char* name, std::span<const std::byte> bytes);

  private:
    struct Format;
    int add(const char* name, std::span<const std::byte> bytes, size_t count, const Format& format);

    tinygltf::Model& model_;
    GlbFile& file_;
};

}  // namespace patina
