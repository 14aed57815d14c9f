#include "export/gltf_arrays.h"

namespace patina {
namespace {

static_assert(sizeof(glm::vec3) == 12 && sizeof(std::array<uint32_t, 3>) == 12 && sizeof(GltfColor) == 8,
              "glTF wants them tightly packed");

/// How an array's elements are stored and what they are for.
struct ElementFormat {
    int component;
    int type;
    int target;
    bool normalized = false;
};
constexpr ElementFormat kFloat{TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ARRAY_BUFFER};
constexpr ElementFormat kFloat3{TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER};
constexpr ElementFormat kColor{TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER,
                               true};
constexpr ElementFormat kShortIndex{TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR,
                                    TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER};
constexpr ElementFormat kIndex{TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                               TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER};

int add_view(tinygltf::Model& model, const char* name, std::span<const std::byte> bytes, int target) {
    std::vector<unsigned char>& data = model.buffers[0].data;
    data.resize((data.size() + 3) / 4 * 4);  // accessors start at multiples of four
    tinygltf::BufferView view;
    view.name = name;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = bytes.size();
    view.target = target;
    const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
    data.insert(data.end(), first, first + bytes.size());
    model.bufferViews.push_back(std::move(view));
    return static_cast<int>(model.bufferViews.size()) - 1;
}

int add_array(tinygltf::Model& model, const char* name, std::span<const std::byte> bytes, size_t count,
              ElementFormat format) {
    tinygltf::Accessor accessor;
    accessor.name = name;
    accessor.bufferView = add_view(model, name, bytes, format.target);
    accessor.componentType = format.component;
    accessor.type = format.type;
    accessor.count = count;
    accessor.normalized = format.normalized;
    model.accessors.push_back(std::move(accessor));
    return static_cast<int>(model.accessors.size()) - 1;
}

template <class Element>
int add_elements(tinygltf::Model& model, const char* name, const std::vector<Element>& elements, ElementFormat format) {
    return add_array(model, name, std::as_bytes(std::span(elements)), elements.size(), format);
}

}  // namespace

int add_vertices(tinygltf::Model& model, const char* name, const std::vector<glm::vec3>& vectors) {
    return add_elements(model, name, vectors, kFloat3);
}

int add_vertices(tinygltf::Model& model, const char* name, const std::vector<float>& values) {
    return add_elements(model, name, values, kFloat);
}

int add_vertices(tinygltf::Model& model, const char* name, const std::vector<GltfColor>& colors) {
    return add_elements(model, name, colors, kColor);
}

int add_positions(tinygltf::Model& model, const std::vector<glm::vec3>& positions_m) {
    const int index = add_vertices(model, "POSITION", positions_m);
    glm::vec3 low = positions_m.front(), high = low;
    for (const glm::vec3& position : positions_m) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    tinygltf::Accessor& accessor = model.accessors[static_cast<size_t>(index)];
    accessor.minValues = {low.x, low.y, low.z};
    accessor.maxValues = {high.x, high.y, high.z};
    return index;
}

int add_indices(tinygltf::Model& model, std::span<const std::array<uint32_t, 3>> triangles, uint64_t vertices) {
    const size_t count = triangles.size() * 3;
    if (vertices > kMostVerticesOfShortIndices)
        return add_array(model, "indices", std::as_bytes(triangles), count, kIndex);
    std::vector<uint16_t> indices;
    indices.reserve(count);
    for (const auto& triangle : triangles) {
        for (const uint32_t vertex : triangle) indices.push_back(static_cast<uint16_t>(vertex));
    }
    return add_elements(model, "indices", indices, kShortIndex);
}

}  // namespace patina
