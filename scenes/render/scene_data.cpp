#include "scenes/render/scene_data.h"

#include <algorithm>
#include <array>
#include <bit>
#include <set>
#include <string>

#include "engine/core/shader_light.h"
#include "scenes/render/bvh.h"

namespace patina::scenes {
namespace {

constexpr uint32_t kTrianglesPerLeaf = 4;
constexpr uint32_t kPartsPerLeaf = 1;

using glm::dvec3;
using glm::vec3;
using glm::vec4;

template <class... Parts>
[[noreturn]] void fail(const SyntheticScene& scene, const SceneObject& object, const Parts&... parts) {
    throw Error("scene '", scene.name, "': object '", object.material.name, "' ", parts...);
}

void check_mesh(const SyntheticScene& scene, const SceneObject& object, const TriangleMesh& mesh) {
    const size_t count = mesh.positions_m.size();
    const auto check_list = [&](const char* what, size_t entries) {
        if (entries != 0 && entries != count)
            fail(scene, object, "has ", entries, ' ', what, " for ", count, " positions");
    };
    check_list("normals", mesh.normals.size());
    check_list("texture coordinates", mesh.texture_coordinates.size());
    for (const glm::uvec3& t : mesh.triangles) {
        const uint32_t largest = std::max({t.x, t.y, t.z});
        if (largest >= count) fail(scene, object, "has a triangle with vertex ", largest, " of ", count);
    }
}

void check(const SyntheticScene& scene) {
    std::set<uint32_t> ids;
    for (const SceneObject& object : scene.objects) {
        const sensor::Material& m = object.material;
        if (m.id == 0 || m.id > UINT16_MAX) fail(scene, object, "has id ", m.id, ", outside 1 to ", UINT16_MAX);
        if (!ids.insert(m.id).second) fail(scene, object, "has id ", m.id, ", which is another object's");
        if (!m.kd && !object.texture) fail(scene, object, "has neither kd nor a texture");
        if (!(m.alpha > 0 && m.alpha <= 1)) fail(scene, object, "has alpha ", m.alpha, ", outside (0, 1]");
        if (object.texture && (!object.texture->kd || object.texture->kd->empty()))
            fail(scene, object, "has a texture without texels");
        for (const Part& part : object.parts)
            if (const auto* shape = std::get_if<MeshShape>(&part.shape)) check_mesh(scene, object, *shape->mesh);
    }
}

gpu::SceneObject to_gpu(const SceneObject& object, std::vector<vec4>& texels) {
    gpu::SceneObject out{};
    out.ks_alpha = vec4(object.material.ks, object.material.alpha);
    out.id = object.material.id;
    out.first_texel = static_cast<uint32_t>(texels.size());
    if (!object.texture) {
        out.texture_size = {1, 1};
        out.texels_per_uv = glm::vec2(1);
        texels.emplace_back(vec3(*object.material.kd), 0);
        return out;
    }
    const Image<vec3>& picture = *object.texture->kd;
    out.texture_size = {picture.extent().width, picture.extent().height};
    out.texels_per_uv = glm::vec2(glm::dvec2(out.texture_size) / object.texture->repeat);
    for (const vec3& kd : picture.pixels()) texels.emplace_back(kd, 0);
    return out;
}

/// What bounds an analytic shape, and the factors of its quadric.
struct Sides {
    vec4 size;
    glm::vec2 quadric{0};
    dvec3 reach_m;  ///< half sizes of the box around it
};

struct SidesOf {
    Sides operator()(const RectangleShape& s) const {
        const dvec3 half(s.half_size_m, 0);
        return {vec4(half, gpu::kUnbounded), {0, 0}, half};
    }
    Sides operator()(const BoxShape& s) const { return {vec4(s.half_size_m, gpu::kUnbounded), {0, 0}, s.half_size_m}; }
    Sides operator()(const SphereShape& s) const {
        return {vec4(vec3(gpu::kUnbounded), s.radius_m * s.radius_m), {1, 1}, dvec3(s.radius_m)};
    }
    Sides operator()(const CylinderShape& s) const {
        return {vec4(gpu::kUnbounded, s.half_height_m, gpu::kUnbounded, s.radius_m * s.radius_m),
                {1, 0},
                {s.radius_m, s.half_height_m, s.radius_m}};
    }
    Sides operator()(const MeshShape&) const { return {}; }
};

/// The box around a part, a little larger than it: the part is intersected in its own frame, which rounds elsewhere.
Bounds bounds_of(const RigidTransform& world_from_part, dvec3 reach_m) {
    const dvec3 center_m(world_from_part[3]);
    dvec3 half_m(0);
    for (int i = 0; i < 3; ++i) half_m += glm::abs(dvec3(world_from_part[i])) * reach_m[i];
    half_m += 1e-6 * (1.0 + half_m + glm::abs(center_m));
    return {vec3(center_m - half_m), vec3(center_m + half_m)};
}

vec4 row_of(const RigidTransform& m, int row) { return vec4(m[0][row], m[1][row], m[2][row], m[3][row]); }

/// Everything that is hit, in the scene's order.
struct Primitives {
    std::vector<gpu::ScenePart> parts;
    std::vector<Bounds> part_bounds;
    std::vector<vec4> corners;
    std::vector<gpu::SceneTriangle> triangles;
    std::vector<Bounds> triangle_bounds;
};

void add_part(Primitives& to, const Part& part, float object) {
    const Sides sides = std::visit(SidesOf{}, part.shape);
    const RigidTransform part_from_world = rigid_inverse(part.world_from_part);
    to.parts.push_back({row_of(part_from_world, 0), row_of(part_from_world, 1), row_of(part_from_world, 2), sides.size,
                        vec4(sides.quadric, object, 0)});
    to.part_bounds.push_back(bounds_of(part.world_from_part, sides.reach_m));
}

/// The unit vector along `v`; some unit vector where v is 0, as the normal of a triangle without area is.
dvec3 direction_of(dvec3 v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : dvec3(0, 0, 1);
}

void add_triangle(Primitives& to, const TriangleMesh& mesh, glm::uvec3 triangle, const RigidTransform& world_from_part,
                  float object) {
    Bounds bounds;
    std::array<dvec3, 3> corners_m;
    for (int i = 0; i < 3; ++i) {
        corners_m[i] = dvec3(world_from_part * glm::dvec4(dvec3(mesh.positions_m[triangle[i]]), 1));
        to.corners.emplace_back(vec3(corners_m[i]), 0);
        bounds.add(vec3(corners_m[i]));
    }
    to.triangle_bounds.push_back(bounds);
    const dvec3 geometric = direction_of(glm::cross(corners_m[1] - corners_m[0], corners_m[2] - corners_m[0]));
    std::array<vec4, 3> corner_normals;
    vec4 v(0);
    for (int i = 0; i < 3; ++i) {
        const dvec3 normal = mesh.normals.empty()
                                 ? geometric
                                 : glm::dmat3(world_from_part) * direction_of(dvec3(mesh.normals[triangle[i]]));
        const bool has_uv = !mesh.texture_coordinates.empty();
        const glm::vec2 uv = has_uv ? mesh.texture_coordinates[triangle[i]] : glm::vec2(0);
        corner_normals[i] = vec4(normal, uv.x);
        v[i] = uv.y;
    }
    to.triangles.push_back({vec4(geometric, object), corner_normals[0], corner_normals[1], corner_normals[2], v});
}

Primitives primitives_of(const SyntheticScene& scene) {
    Primitives all;
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        const auto object = static_cast<float>(i);
        for (const Part& part : scene.objects[i].parts) {
            const auto* shape = std::get_if<MeshShape>(&part.shape);
            if (!shape) {
                add_part(all, part, object);
                continue;
            }
            for (const glm::uvec3& triangle : shape->mesh->triangles)
                add_triangle(all, *shape->mesh, triangle, part.world_from_part, object);
        }
    }
    return all;
}

/// Appends a tree's nodes to those of the current order, which begins at `order_begin`.
void append(std::vector<gpu::SceneNode>& nodes, size_t order_begin, const Bvh& bvh, uint32_t octant, uint32_t kind) {
    const auto base = static_cast<uint32_t>(nodes.size() - order_begin);
    for (const ThreadedNode& node : thread_bvh(bvh, octant)) {
        const uint32_t leaf = node.count == 0 ? 0 : node.count | kind | node.first << gpu::kLeafIndexShift;
        nodes.push_back({vec4(node.bounds.low, std::bit_cast<float>(base + node.skip)),
                         vec4(node.bounds.high, std::bit_cast<float>(leaf))});
    }
}

/// `values` in the order of a tree's leaves, `stride` of them per primitive.
template <class T>
std::vector<T> in_leaf_order(const std::vector<T>& values, const Bvh& bvh, size_t stride = 1) {
    std::vector<T> sorted;
    sorted.reserve(values.size());
    for (const uint32_t i : bvh.primitives)
        for (size_t k = 0; k < stride; ++k) sorted.push_back(values[i * stride + k]);
    return sorted;
}

void check_size(const SyntheticScene& scene, const char* what, size_t texels) {
    const size_t most = size_t{gpu::kTexelRow} * gpu::kTexelRow;
    if (texels > most)
        throw Error("scene '", scene.name, "': its ", what, " take ", texels, " texels, an image holds ", most);
}

}  // namespace

SceneData pack_scene(const SyntheticScene& scene) {
    check(scene);
    SceneData data;
    for (const SceneObject& object : scene.objects) data.objects.push_back(to_gpu(object, data.texels));
    for (const Light& light : scene.lights)
        data.lights.push_back({make_point_light(light), vec4(emitted_radiance(light), 0)});
    const Primitives all = primitives_of(scene);
    const Bvh parts = build_bvh(all.part_bounds, kPartsPerLeaf);
    const Bvh triangles = build_bvh(all.triangle_bounds, kTrianglesPerLeaf);
    data.shapes = in_leaf_order(all.corners, triangles, gpu::kTriangleTexels);
    data.info.first_part_texel = static_cast<uint32_t>(data.shapes.size());
    for (const gpu::ScenePart& part : in_leaf_order(all.parts, parts))
        data.shapes.insert(data.shapes.end(), {part.row_x, part.row_y, part.row_z, part.size, part.quadric});
    data.triangles = in_leaf_order(all.triangles, triangles);
    for (uint32_t octant = 0; octant < gpu::kNodeOrders; ++octant) {
        const size_t order_begin = data.nodes.size();
        append(data.nodes, order_begin, parts, octant, gpu::kLeafParts);
        append(data.nodes, order_begin, triangles, octant, 0);
    }
    data.info.node_count = static_cast<uint32_t>(parts.nodes.size() + triangles.nodes.size());
    data.info.light_count = static_cast<uint32_t>(data.lights.size());
    data.info.has_lamps = std::ranges::any_of(scene.lights, [](const Light& l) { return l.radius_m > 0; });
    check_size(scene, "nodes", data.nodes.size() * gpu::kNodeTexels);
    check_size(scene, "shapes", data.shapes.size());
    check_size(scene, "textures", data.texels.size());
    return data;
}

}  // namespace patina::scenes
