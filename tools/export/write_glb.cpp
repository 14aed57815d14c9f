#include "tools/export/write_glb.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <tiny_gltf.h>

#include "engine/core/error.h"

namespace patina {
namespace {

using Triangle = std::array<uint32_t, 3>;
using Color = std::array<uint16_t, 4>;

static_assert(sizeof(glm::vec3) == 12 && sizeof(Triangle) == 12 && sizeof(Color) == 8,
              "glTF wants them tightly packed");

constexpr uint64_t kVertexBytes = sizeof(glm::vec3) + sizeof(glm::vec3) + sizeof(Color);
/// Left for the headers and the JSON, whose size does not depend on the mesh.
constexpr uint64_t kJsonAllowance = 1 << 20;
/// 65535 restarts a primitive, so no vertex may have it as its index.
constexpr uint64_t kMostVerticesOfShortIndices = 65535;

bool short_indices(uint64_t vertices) { return vertices <= kMostVerticesOfShortIndices; }

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_finite(const std::filesystem::path& path, const char* what, std::span<const glm::vec3> values) {
    const auto bad = std::ranges::find_if_not(values, finite);
    if (bad == values.end()) return;
    throw Error(path, ": the ", what, " of vertex ", bad - values.begin(), " of ", values.size(), " is not finite: (",
                bad->x, ", ", bad->y, ", ", bad->z, ")");
}

void check_mesh(const std::filesystem::path& path, const Mesh& mesh) {
    const size_t vertices = mesh.positions_m.size();
    PATINA_ASSERT(mesh.normals.size() == vertices && mesh.colors.size() == vertices, "positions ", vertices,
                  ", normals ", mesh.normals.size(), ", colors ", mesh.colors.size());
    check_finite(path, "position", mesh.positions_m);
    check_finite(path, "normal", mesh.normals);
    check_finite(path, "colour", mesh.colors);
    for (const Triangle& triangle : mesh.triangles) {
        const uint32_t largest = std::ranges::max(triangle);
        if (largest >= vertices) throw Error(path, ": a triangle names vertex ", largest, " of ", vertices);
    }
}

/// Twice the triangle's area along its normal. Float differences are exact in double, so that coinciding and (but for
/// extreme scales) collinear corners give exactly zero.
glm::dvec3 area_vector(const Mesh& mesh, const Triangle& t) {
    const glm::dvec3 a(mesh.positions_m[t[0]]), b(mesh.positions_m[t[1]]), c(mesh.positions_m[t[2]]);
    return glm::cross(b - a, c - a);
}

std::vector<Triangle> drawable_triangles(const Mesh& mesh) {
    std::vector<Triangle> kept;
    kept.reserve(mesh.triangles.size());
    std::ranges::copy_if(mesh.triangles, std::back_inserter(kept),
                         [&](const Triangle& t) { return area_vector(mesh, t) != glm::dvec3(0); });
    return kept;
}

/// The sum of the area vectors around each vertex that has no normal; zero for all others.
std::vector<glm::dvec3> substitute_normals(const Mesh& mesh, std::span<const Triangle> triangles) {
    std::vector<glm::dvec3> sums(mesh.normals.size());
    for (const Triangle& triangle : triangles) {
        const glm::dvec3 area = area_vector(mesh, triangle);
        for (uint32_t vertex : triangle) {
            if (mesh.normals[vertex] == glm::vec3(0)) sums[vertex] += area;
        }
    }
    return sums;
}

std::vector<glm::vec3> unit_normals(const Mesh& mesh, std::span<const Triangle> triangles) {
    std::vector<glm::vec3> normals(mesh.normals.size());
    std::vector<glm::dvec3> substitutes;
    for (size_t i = 0; i < normals.size(); ++i) {
        glm::dvec3 normal(mesh.normals[i]);
        if (normal == glm::dvec3(0)) {
            if (substitutes.empty()) substitutes = substitute_normals(mesh, triangles);
            normal = substitutes[i];
        }
        // A vertex of no triangle is never drawn; the format still wants a direction there.
        normals[i] = normal == glm::dvec3(0) ? glm::vec3(0, 0, 1) : glm::vec3(glm::normalize(normal));
    }
    return normals;
}

Color encode(glm::vec3 linear) {
    const auto channel = [](float v) {
        return static_cast<uint16_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 65535.0f));
    };
    return {channel(linear.r), channel(linear.g), channel(linear.b), 65535};
}

bool displayable(glm::vec3 linear) { return linear == glm::clamp(linear, 0.0f, 1.0f); }

/// How an array's elements are stored and what they are for.
struct ElementFormat {
    int component;
    int type;
    int target;
    bool normalized = false;
};
constexpr ElementFormat kFloat3{TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER};
constexpr ElementFormat kColor{TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER,
                               true};
constexpr ElementFormat kShortIndex{TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR,
                                    TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER};
constexpr ElementFormat kIndex{TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                               TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER};

int add_view(tinygltf::Model& model, const char* name, std::span<const std::byte> bytes, int target) {
    std::vector<unsigned char>& data = model.buffers[0].data;
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

/// Appends `count` elements to the model's one buffer, with a view and an accessor of their own; returns the accessor.
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
int add_vertices(tinygltf::Model& model, const char* name, const std::vector<Element>& elements, ElementFormat format) {
    return add_array(model, name, std::as_bytes(std::span(elements)), elements.size(), format);
}

int add_positions(tinygltf::Model& model, const std::vector<glm::vec3>& positions_m) {
    const int index = add_vertices(model, "POSITION", positions_m, kFloat3);
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

int add_indices(tinygltf::Model& model, std::span<const Triangle> triangles, uint64_t vertices) {
    const size_t count = triangles.size() * 3;
    if (!short_indices(vertices)) return add_array(model, "indices", std::as_bytes(triangles), count, kIndex);
    std::vector<uint16_t> indices;
    indices.reserve(count);
    for (const Triangle& triangle : triangles) {
        for (uint32_t vertex : triangle) indices.push_back(static_cast<uint16_t>(vertex));
    }
    return add_array(model, "indices", std::as_bytes(std::span(indices)), count, kShortIndex);
}

/// Adds the mesh "surface" and its material.
void add_surface(tinygltf::Model& model, const Mesh& mesh, std::span<const Triangle> triangles) {
    std::vector<Color> colors(mesh.colors.size());
    std::ranges::transform(mesh.colors, colors.begin(), encode);

    model.buffers.resize(1);
    model.buffers[0].data.reserve(glb_buffer_bytes(colors.size(), triangles.size()));
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = 0;
    primitive.attributes["POSITION"] = add_positions(model, mesh.positions_m);
    primitive.attributes["NORMAL"] = add_vertices(model, "NORMAL", unit_normals(mesh, triangles), kFloat3);
    primitive.attributes["COLOR_0"] = add_vertices(model, "COLOR_0", colors, kColor);
    primitive.indices = add_indices(model, triangles, colors.size());

    tinygltf::Mesh surface;
    surface.name = "surface";
    surface.primitives.push_back(std::move(primitive));
    model.meshes.push_back(std::move(surface));

    tinygltf::Material material;
    material.name = "surface";
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 1;
    model.materials.push_back(std::move(material));
}

/// The scene: a root node that turns the world upright, and the node "surface" below it.
void add_scene(tinygltf::Model& model, const GlbInfo& info) {
    const glm::dquat turn = glm::normalize(info.y_up_from_world);
    tinygltf::Node root;
    root.name = info.name;
    root.rotation = {turn.x, turn.y, turn.z, turn.w};
    root.children = {1};
    tinygltf::Node surface;
    surface.name = "surface";
    if (!model.meshes.empty()) surface.mesh = 0;
    model.nodes = {std::move(root), std::move(surface)};

    tinygltf::Scene scene;
    scene.name = info.name;
    scene.nodes = {0};
    model.scenes.push_back(std::move(scene));
    model.defaultScene = 0;
    model.asset.version = "2.0";
    model.asset.generator = "Patina " + info.version;
}

void write_model(const std::filesystem::path& path, const tinygltf::Model& model) {
    constexpr bool kPretty = false, kBinary = true;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    const bool written = tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, file, kPretty, kBinary);
    file.close();
    if (!written || !file) throw Error(path, ": the scene cannot be written");
}

}  // namespace

uint64_t glb_buffer_bytes(uint64_t vertices, uint64_t triangles) {
    constexpr uint64_t kMost = std::numeric_limits<uint32_t>::max() - kJsonAllowance;
    const uint64_t bytes = vertices * kVertexBytes + triangles * 3 * (short_indices(vertices) ? 2 : 4);
    if (vertices > kMost || triangles > kMost || bytes > kMost) {
        throw Error("a GLB file holds at most ", kMost, " bytes, but ", vertices, " vertices and ", triangles,
                    " triangles need ", bytes);
    }
    return bytes;
}

GlbSummary write_glb(const std::filesystem::path& path, const Mesh& mesh, const GlbInfo& info) {
    check_mesh(path, mesh);
    const std::vector<Triangle> triangles = drawable_triangles(mesh);
    tinygltf::Model model;
    GlbSummary summary{.degenerate_triangles = mesh.triangles.size() - triangles.size()};
    if (!triangles.empty()) {
        add_surface(model, mesh, triangles);
        summary.vertices = mesh.positions_m.size();
        summary.triangles = triangles.size();
        summary.clamped_colors = static_cast<uint64_t>(std::ranges::count_if(mesh.colors, std::not_fn(displayable)));
    }
    add_scene(model, info);
    write_model(path, model);
    return summary;
}

}  // namespace patina
