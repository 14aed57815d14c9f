#include "scenes/files/mesh_readers/gltf.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/quaternion.hpp>
#include <tiny_gltf.h>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "scenes/files/mesh_readers/mesh_builder.h"

namespace patina::scenes {
namespace {

namespace fs = std::filesystem;

// ---- loading --------------------------------------------------------------------------------------------------------

/// What tinygltf may read: files in one folder, all together as much as a mesh file.
struct Surroundings {
    fs::path folder;
    uint64_t bytes_left = limits::kMeshBytes;
};

bool is_inside(const Surroundings& around, const std::string& file) {
    std::error_code failure;
    const fs::path inner = fs::canonical(file, failure);
    if (failure) return false;
    const fs::path outer = fs::canonical(around.folder, failure);
    return !failure && std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

bool read_beside(std::vector<unsigned char>* out, std::string* error, const std::string& file, void* surroundings) {
    auto& around = *static_cast<Surroundings*>(surroundings);
    try {
        *out = read_file(file, around.bytes_left);
    } catch (const std::exception& failure) {
        *error = failure.what();
        return false;
    }
    around.bytes_left -= out->size();
    return true;
}

tinygltf::FsCallbacks callbacks(Surroundings& around) {
    tinygltf::FsCallbacks calls{};
    calls.FileExists = [](const std::string& file, void* data) {
        return is_inside(*static_cast<Surroundings*>(data), file);
    };
    calls.ExpandFilePath = [](const std::string& file, void*) { return file; };
    calls.ReadWholeFile = read_beside;
    calls.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    calls.user_data = &around;
    return calls;
}

bool ignore_picture(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
    return true;
}

bool is_binary(std::span<const uint8_t> bytes) {
    return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

/// The JSON text of a file; tinygltf checks the lengths itself.
std::span<const uint8_t> json_of(std::span<const uint8_t> bytes) {
    if (!is_binary(bytes)) return bytes;
    constexpr size_t kHeader = 20;  // of the file and its first chunk
    if (bytes.size() < kHeader)
        throw Error("it is truncated: it has ", bytes.size(), " bytes, but ", kHeader, " are its header");
    uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, sizeof(length));
    if (length > bytes.size() - kHeader) {
        throw Error("it is truncated: its JSON has ", length, " bytes, but ", bytes.size() - kHeader, " follow");
    }
    return bytes.subspan(kHeader, length);
}

/// tinygltf makes up to 2 kB of an object of two bytes, and 150 bytes of a number in "extras"; the largest scenes have
/// some 100 000 objects of ten entries each.
void check_json(std::span<const uint8_t> json) {
    constexpr std::ptrdiff_t kMostObjects = 1 << 20, kMostCommas = 1 << 23;
    if (json.size() > limits::kTextBytes)
        throw Error("its JSON has ", json.size(), " bytes, at most ", limits::kTextBytes, " are read");
    const auto objects = std::ranges::count(json, '{');
    if (objects > kMostObjects) throw Error("its JSON has ", objects, " objects, at most ", kMostObjects, " are read");
    const auto commas = std::ranges::count(json, ',');
    if (commas > kMostCommas) throw Error("its JSON has ", commas, " commas, at most ", kMostCommas, " are read");
    check_json_depth("its JSON", json);
}

tinygltf::Model load(const fs::path& file, std::span<const uint8_t> bytes) {
    check_json(json_of(bytes));
    Surroundings around{file.has_parent_path() ? file.parent_path() : fs::path(".")};
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(callbacks(around));
    loader.SetImageLoader(ignore_picture, nullptr);
    tinygltf::Model model;
    std::string error, warning;
    const auto size = static_cast<unsigned>(bytes.size());
    const auto* data = bytes.data();
    const bool loaded = is_binary(bytes)
                            ? loader.LoadBinaryFromMemory(&model, &error, &warning, data, size, around.folder.string())
                            : loader.LoadASCIIFromString(&model, &error, &warning, reinterpret_cast<const char*>(data),
                                                         size, around.folder.string());
    if (loaded) return model;
    error.erase(error.find_last_not_of(" \n") + 1);
    throw Error("it cannot be read: ", error.empty() ? "it is damaged" : error);
}

// ---- numbers --------------------------------------------------------------------------------------------------------

template <class List>
const auto& element(const List& list, int64_t index, const char* what) {
    if (index < 0 || static_cast<uint64_t>(index) >= list.size())
        throw Error("it uses ", what, " ", index, ", but there are ", list.size());
    return list[static_cast<size_t>(index)];
}

/// The numbers of an accessor, checked against the bytes that there are.
class Numbers {
  public:
    Numbers(const tinygltf::Model& model, int index) : name_(text("accessor ", index)) {
        const tinygltf::Accessor& accessor = element(model.accessors, index, "accessor");
        if (accessor.sparse.isSparse) throw Error(name_, " is sparse, which is not read");
        const tinygltf::BufferView& view = element(model.bufferViews, accessor.bufferView, "bufferView");
        const std::vector<unsigned char>& buffer = element(model.buffers, view.buffer, "buffer").data;
        component_type_ = accessor.componentType;
        normalized_ = accessor.normalized;
        const int components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
        const int size = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(component_type_));
        if (components <= 0 || size <= 0) throw Error(name_, " has no known type");
        components_ = static_cast<size_t>(components);
        component_bytes_ = static_cast<size_t>(size);
        count_ = accessor.count;
        stride_ = view.byteStride > 0 ? view.byteStride : components_ * component_bytes_;
        bytes_ = part(part(std::span(buffer), view.byteOffset, view.byteLength), accessor.byteOffset, needed());
    }

    size_t count() const { return count_; }

    /// Throws Error unless each element has so many numbers.
    void expect_components(size_t components) const {
        if (components_ != components)
            throw Error(name_, " has ", components_, " numbers an element, must have ", components);
    }

    /// As the vertex attributes of KHR_mesh_quantization: normalized integers are parts of the largest.
    double at(size_t element, size_t component) const {
        switch (component_type_) {
            case TINYGLTF_COMPONENT_TYPE_BYTE: return signed_part<int8_t>(element, component);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return signed_part<uint8_t>(element, component);
            case TINYGLTF_COMPONENT_TYPE_SHORT: return signed_part<int16_t>(element, component);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return signed_part<uint16_t>(element, component);
            case TINYGLTF_COMPONENT_TYPE_FLOAT: return static_cast<double>(raw<float>(element, component));
            default: throw Error(name_, " has components of type ", component_type_, ", which no vertex has");
        }
    }

    glm::dvec3 vec3(size_t element) const { return {at(element, 0), at(element, 1), at(element, 2)}; }

    uint32_t index(size_t element) const {
        switch (component_type_) {
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return raw<uint8_t>(element, 0);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return raw<uint16_t>(element, 0);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return raw<uint32_t>(element, 0);
            default: throw Error(name_, " has components of type ", component_type_, ", which no index has");
        }
    }

  private:
    /// The bytes from the first element's begin to the last one's end.
    size_t needed() const {
        if (count_ == 0) return 0;
        const size_t element_bytes = components_ * component_bytes_;
        if (count_ - 1 > (limits::kMeshBytes - element_bytes) / stride_)
            throw Error(name_, " has ", count_, " elements, more than a file of ", limits::kMeshBytes, " bytes holds");
        return (count_ - 1) * stride_ + element_bytes;
    }

    std::span<const uint8_t> part(std::span<const uint8_t> whole, size_t offset, size_t length) const {
        if (offset > whole.size() || length > whole.size() - offset) {
            throw Error(name_, " needs ", length, " bytes from byte ", offset, " on, but there are ", whole.size());
        }
        return whole.subspan(offset, length);
    }

    template <class Number>
    Number raw(size_t element, size_t component) const {
        Number number;
        std::memcpy(&number, bytes_.data() + element * stride_ + component * component_bytes_, sizeof(number));
        return number;
    }

    template <class Number>
    double signed_part(size_t element, size_t component) const {
        const double value = raw<Number>(element, component);
        return normalized_ ? std::max(value / std::numeric_limits<Number>::max(), -1.0) : value;
    }

    std::string name_;
    int component_type_ = 0;
    bool normalized_ = false;
    size_t components_ = 0, component_bytes_ = 0, count_ = 0, stride_ = 0;
    std::span<const uint8_t> bytes_;
};

// ---- the scene ------------------------------------------------------------------------------------------------------

/// A node's transform in its parent.
glm::dmat4 placement(const tinygltf::Node& node) {
    glm::dmat4 m(1);
    if (node.matrix.size() == 16) {
        for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[static_cast<size_t>(i)];  // column by column
        return m;
    }
    if (node.translation.size() == 3) m[3] = {node.translation[0], node.translation[1], node.translation[2], 1};
    if (node.rotation.size() == 4) {
        const std::vector<double>& q = node.rotation;
        m = m * glm::mat4_cast(glm::dquat(q[3], q[0], q[1], q[2]));
    }
    if (node.scale.size() == 3) {
        for (int i = 0; i < 3; ++i) m[i] *= node.scale[static_cast<size_t>(i)];
    }
    return m;
}

/// The corners of each triangle that `count` vertices in a row make.
template <class Use>
void for_each_triangle(int mode, size_t count, Use use) {
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        for (size_t i = 2; i < count; i += 3) use(std::array{i - 2, i - 1, i});
    } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        for (size_t i = 2; i < count; ++i) use(i % 2 == 0 ? std::array{i - 2, i - 1, i} : std::array{i - 1, i - 2, i});
    } else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
        for (size_t i = 2; i < count; ++i) use(std::array{size_t{0}, i - 1, i});
    }  // points and lines have no surface
}

class GltfReader {
  public:
    explicit GltfReader(const tinygltf::Model& model) : model_(model), reached_(model.nodes.size()) {}

    TriangleMesh read() {
        for (const std::string& extension : model_.extensionsRequired) {
            if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression")
                throw Error("it requires ", extension, ", and compressed meshes are not read");
        }
        push(roots(), glm::dmat4(1));
        while (!open_.empty()) {
            const auto [index, world_from_node] = open_.back();
            open_.pop_back();
            const tinygltf::Node& node = model_.nodes[index];
            if (node.mesh >= 0) add(element(model_.meshes, node.mesh, "mesh"), world_from_node);
            push(node.children, world_from_node);
        }
        return std::move(builder_).finish();
    }

  private:
    /// Any number of nodes may place one mesh, and a primitive takes time even where it has no triangle.
    static constexpr size_t kMostPlaced = size_t{1} << 22;

    struct Open {
        size_t node;
        glm::dmat4 world_from_node;
    };

    /// The default scene's, else the first one's, else all nodes that are no children.
    std::vector<int> roots() const {
        if (!model_.scenes.empty()) return element(model_.scenes, std::max(model_.defaultScene, 0), "scene").nodes;
        std::vector<bool> is_child(model_.nodes.size());
        for (const tinygltf::Node& node : model_.nodes) {
            for (const int child : node.children) {
                if (child >= 0 && static_cast<size_t>(child) < is_child.size())
                    is_child[static_cast<size_t>(child)] = true;
            }
        }
        std::vector<int> roots;
        for (size_t i = 0; i < is_child.size(); ++i) {
            if (!is_child[i]) roots.push_back(static_cast<int>(i));
        }
        return roots;
    }

    /// Puts nodes on the stack, the first on top.
    void push(const std::vector<int>& nodes, const glm::dmat4& world_from_parent) {
        for (size_t i = nodes.size(); i-- > 0;) {
            const tinygltf::Node& node = element(model_.nodes, nodes[i], "node");
            const auto index = static_cast<size_t>(nodes[i]);
            if (reached_[index]) throw Error("its node ", index, " has two parents, must have at most one");
            reached_[index] = true;
            open_.push_back({index, world_from_parent * placement(node)});
        }
    }

    void add(const tinygltf::Mesh& mesh, const glm::dmat4& world_from_node) {
        if (mesh.primitives.size() > kMostPlaced - placed_)
            throw Error("its nodes place more than ", kMostPlaced, " primitives, the most that are read");
        placed_ += mesh.primitives.size();
        for (const tinygltf::Primitive& primitive : mesh.primitives) add(primitive, world_from_node);
    }

    /// The attribute `name` of as many vertices as there are positions; empty where the primitive has none.
    std::optional<Numbers> attribute(const tinygltf::Primitive& primitive, const char* name, size_t components,
                                     std::optional<size_t> count) const {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) return std::nullopt;
        const Numbers numbers(model_, found->second);
        numbers.expect_components(components);
        if (count && numbers.count() != *count)
            throw Error("a primitive has ", numbers.count(), " of ", name, " for ", *count, " of POSITION");
        return numbers;
    }

    void add(const tinygltf::Primitive& primitive, const glm::dmat4& world_from_node) {
        const auto positions = attribute(primitive, "POSITION", 3, std::nullopt);
        if (!positions) return;
        const auto normals = attribute(primitive, "NORMAL", 3, positions->count());
        const auto uvs = attribute(primitive, "TEXCOORD_0", 2, positions->count());
        std::optional<Numbers> indices;
        if (primitive.indices >= 0) indices.emplace(model_, primitive.indices);
        const bool mirrored = glm::determinant(glm::dmat3(world_from_node)) < 0;
        const glm::dmat3 normals_from_node = glm::inverseTranspose(glm::dmat3(world_from_node));
        for_each_triangle(primitive.mode, indices ? indices->count() : positions->count(), [&](auto places) {
            if (mirrored) std::swap(places[1], places[2]);
            std::array<MeshCorner, 3> corners;
            for (size_t i = 0; i < 3; ++i) {
                const size_t vertex = indices ? indices->index(places[i]) : places[i];
                if (vertex >= positions->count())
                    throw Error("an index is ", vertex, ", but there are ", positions->count(), " vertices");
                corners[i].position = glm::dvec3(world_from_node * glm::dvec4(positions->vec3(vertex), 1));
                if (normals) corners[i].normal = normals_from_node * normals->vec3(vertex);
                if (uvs) corners[i].uv = {uvs->at(vertex, 0), uvs->at(vertex, 1)};
            }
            builder_.add_face(corners);
        });
    }

    const tinygltf::Model& model_;
    std::vector<bool> reached_;
    std::vector<Open> open_;
    size_t placed_ = 0;  ///< primitives
    MeshBuilder builder_;
};

}  // namespace

TriangleMesh read_gltf(const fs::path& file, std::span<const uint8_t> bytes) {
    const tinygltf::Model model = load(file, bytes);
    return GltfReader(model).read();
}

}  // namespace patina::scenes
