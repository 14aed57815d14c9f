#include "export/glb_model.h"

#include <algorithm>
#include <cstring>

#include "engine/core/error.h"
#include "engine/core/input_file.h"

namespace patina {

namespace {

constexpr uint64_t kMostBytes = UINT32_MAX;  // of a GLB

/// Keeps a picture as it is in the file.
bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
    image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

void check_json(const std::filesystem::path& file, const std::vector<uint8_t>& bytes) {
    constexpr size_t kJson = 20;  // where it begins
    if (bytes.size() < kJson || std::memcmp(bytes.data(), "glTF", 4) != 0) throw Error(file, " is no GLB file");
    uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, sizeof(length));
    if (length > bytes.size() - kJson)
        throw Error(file, " is truncated: its JSON has ", length, " bytes, the file ", bytes.size());
    check_json_depth(file.string(), std::span(bytes).subspan(kJson, length));
}

}  // namespace

tinygltf::Model read_glb(const std::filesystem::path& file) {
    const std::vector<uint8_t> bytes = read_file(file, kMostBytes);
    check_json(file, bytes);
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_encoded, nullptr);
    tinygltf::Model model;
    std::string error, warning;
    if (!loader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), static_cast<unsigned>(bytes.size())))
        throw Error(file, " cannot be read as glTF: ", error);
    return model;
}

void GlbArrays::fail_missing(const char* what, int index, size_t count) const {
    throw Error(file_, ": ", what, " ", index, " is asked for, but there are ", count);
}

template <class Element>
std::vector<Element> GlbArrays::elements(int index, int component, int type) const {
    const tinygltf::Accessor& accessor = at(model_.accessors, index, "accessor");
    if (accessor.componentType != component || accessor.type != type || accessor.sparse.isSparse)
        throw Error(file_, ": accessor ", index, " has elements of type ", accessor.type, " of ",
                    accessor.componentType, ", not ", type, " of ", component);
    const tinygltf::BufferView& view = at(model_.bufferViews, accessor.bufferView, "buffer view");
    const tinygltf::Buffer& buffer = at(model_.buffers, view.buffer, "buffer");
    const size_t step = view.byteStride == 0 ? sizeof(Element) : view.byteStride;
    const size_t first = view.byteOffset + accessor.byteOffset, size = buffer.data.size();
    const bool fits = first <= size && step >= sizeof(Element) && step <= 255 &&
                      (accessor.count == 0 ||
                       (accessor.count <= size && first + (accessor.count - 1) * step + sizeof(Element) <= size));
    if (!fits)
        throw Error(file_, ": accessor ", index, " of ", accessor.count, " elements reaches beyond its buffer of ",
                    size, " bytes");
    std::vector<Element> result(accessor.count);
    for (size_t i = 0; i < result.size(); ++i)
        std::memcpy(static_cast<void*>(&result[i]), buffer.data.data() + first + i * step, sizeof(Element));
    return result;
}

std::vector<glm::vec3> GlbArrays::vectors(int accessor) const {
    return elements<glm::vec3>(accessor, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
}

std::vector<glm::vec2> GlbArrays::pairs(int accessor) const {
    return elements<glm::vec2>(accessor, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2);
}

std::vector<glm::vec4> GlbArrays::quads(int accessor) const {
    return elements<glm::vec4>(accessor, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4);
}

std::vector<float> GlbArrays::scalars(int accessor) const {
    return elements<float>(accessor, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR);
}

std::vector<glm::vec3> GlbArrays::colors(int accessor) const {
    std::vector<glm::vec3> linear;
    for (const auto& color :
         elements<std::array<uint16_t, 4>>(accessor, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4))
        linear.push_back(glm::vec3(color[0], color[1], color[2]) / 65535.0f);
    return linear;
}

std::vector<std::array<uint32_t, 3>> GlbArrays::triangles(const tinygltf::Primitive& primitive, size_t vertices) const {
    const bool is_short = at(model_.accessors, primitive.indices, "accessor of indices").componentType ==
                          TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    std::vector<uint32_t> indices;
    if (is_short) {
        const auto narrow =
            elements<uint16_t>(primitive.indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR);
        indices.assign(narrow.begin(), narrow.end());
    } else {
        indices = elements<uint32_t>(primitive.indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
    }
    std::vector<std::array<uint32_t, 3>> triangles(indices.size() / 3);
    for (size_t i = 0; i < 3 * triangles.size(); ++i) {
        if (indices[i] >= vertices) throw Error(file_, ": a triangle names vertex ", indices[i], " of ", vertices);
        triangles[i / 3][i % 3] = indices[i];
    }
    return triangles;
}

size_t base_color_pages(const tinygltf::Model& model) {
    size_t pages = 0;
    for (const tinygltf::Material& material : model.materials) {
        const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
        if (texture < 0 || static_cast<size_t>(texture) >= model.textures.size()) continue;
        const int source = model.textures[static_cast<size_t>(texture)].source;
        pages = std::max(pages, static_cast<size_t>(std::max(source + 1, 0)));
    }
    return std::min(pages, model.images.size());
}

int attribute_of(const tinygltf::Primitive& primitive, const char* name) {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
}

}  // namespace patina
