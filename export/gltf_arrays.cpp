#include "export/gltf_arrays.h"

namespace patina {
namespace {

static_assert(sizeof(glm::vec3) == 12 && sizeof(std::array<uint32_t, 3>) == 12 && sizeof(GltfColor) == 8,
              "glTF wants them tightly packed");

template <class Element>
std::span<const std::byte> bytes_of(const std::vector<Element>& elements) {
    return std::as_bytes(std::span(elements));
}

}  // namespace

/// How an array's elements are stored and what they are for.
struct GltfArrays::Format {
    int component;
    int type;
    int target;
    bool normalized = false;

    static constexpr Format vertices(int component, int type, bool normalized = false) {
        return {component, type, TINYGLTF_TARGET_ARRAY_BUFFER, normalized};
    }
    static constexpr Format indices(int component) {
        return {component, TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER};
    }
};

int GltfArrays::add_bytes(const char* name, std::span<const std::byte> bytes) {
    tinygltf::BufferView view;
    view.name = name;
    view.buffer = 0;
    view.byteOffset = file_.append(bytes);
    view.byteLength = bytes.size();
    model_.bufferViews.push_back(std::move(view));
    return static_cast<int>(model_.bufferViews.size()) - 1;
}

int GltfArrays::add(const char* name, std::span<const std::byte> bytes, size_t count, const Format& format) {
    tinygltf::Accessor accessor;
    accessor.name = name;
    accessor.bufferView = add_bytes(name, bytes);
    model_.bufferViews.back().target = format.target;
    accessor.componentType = format.component;
    accessor.type = format.type;
    accessor.count = count;
    accessor.normalized = format.normalized;
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
}

int GltfArrays::add_vertices(const char* name, const std::vector<glm::vec3>& vectors) {
    return add(name, bytes_of(vectors), vectors.size(),
               Format::vertices(TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3));
}

int GltfArrays::add_vertices(const char* name, const std::vector<glm::vec2>& vectors) {
    return add(name, bytes_of(vectors), vectors.size(),
               Format::vertices(TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2));
}

int GltfArrays::add_vertices(const char* name, const std::vector<glm::vec4>& vectors) {
    return add(name, bytes_of(vectors), vectors.size(),
               Format::vertices(TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4));
}

int GltfArrays::add_vertices(const char* name, const std::vector<float>& values) {
    return add(name, bytes_of(values), values.size(),
               Format::vertices(TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR));
}

int GltfArrays::add_vertices(const char* name, const std::vector<GltfColor>& colors) {
    return add(name, bytes_of(colors), colors.size(),
               Format::vertices(TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4, true));
}

int GltfArrays::add_positions(const std::vector<glm::vec3>& positions_m) {
    const int index = add_vertices("POSITION", positions_m);
    glm::vec3 low = positions_m.front(), high = low;
    for (const glm::vec3& position : positions_m) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    tinygltf::Accessor& accessor = model_.accessors[static_cast<size_t>(index)];
    accessor.minValues = {low.x, low.y, low.z};
    accessor.maxValues = {high.x, high.y, high.z};
    return index;
}

int GltfArrays::add_indices(std::span<const std::array<uint32_t, 3>> triangles, uint64_t vertices) {
    const size_t count = triangles.size() * 3;
    if (vertices > kMostVerticesOfShortIndices)
        return add("indices", std::as_bytes(triangles), count, Format::indices(TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT));
    std::vector<uint16_t> indices;
    indices.reserve(count);
    for (const auto& triangle : triangles) {
        for (const uint32_t vertex : triangle) indices.push_back(static_cast<uint16_t>(vertex));
    }
    return add("indices", bytes_of(indices), count, Format::indices(TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT));
}

}  // namespace patina
