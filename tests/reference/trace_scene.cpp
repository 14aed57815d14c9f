#include "tests/reference/trace_scene.h"

#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "tests/reference/ward.h"

namespace patina::reference {
namespace {

using sensor::Part;
using sensor::SceneObject;

struct Hit {
    double distance_m = INFINITY;
    glm::dvec3 normal{0};
    const SceneObject* object = nullptr;
};

/// A bounded plane; the half edges lead from its centre to the middles of two sides.
struct Face {
    glm::dvec3 center_m, half_edge_u, half_edge_v;
    const SceneObject* object;
    bool two_sided;
};

struct Ball {
    glm::dvec3 center_m;
    double radius_m;
    const SceneObject* object;
};

struct World {
    std::vector<Face> faces;
    std::vector<Ball> balls;
};

void add(World& world, const SceneObject& object, const Part& part, const sensor::RectangleShape& shape) {
    const glm::dmat4& m = part.world_from_part;
    world.faces.push_back({glm::dvec3(m[3]), glm::dvec3(m[0]) * shape.half_size_m.x,
                           glm::dvec3(m[1]) * shape.half_size_m.y, &object, true});
}

void add(World& world, const SceneObject& object, const Part& part, const sensor::BoxShape& shape) {
    const glm::dmat4& m = part.world_from_part;
    for (int axis = 0; axis < 3; ++axis) {
        const auto half_edge = [&](int i) { return glm::dvec3(m[i % 3]) * shape.half_size_m[i % 3]; };
        const glm::dvec3 u = half_edge(axis + 1), v = half_edge(axis + 2);
        world.faces.push_back({glm::dvec3(m[3]) + half_edge(axis), u, v, &object, false});
        world.faces.push_back({glm::dvec3(m[3]) - half_edge(axis), v, u, &object, false});
    }
}

void add(World& world, const SceneObject& object, const Part& part, const sensor::SphereShape& shape) {
    world.balls.push_back({glm::dvec3(part.world_from_part[3]), shape.radius_m, &object});
}

/// `direction` has unit length. A box's face is seen from outside only.
void add(World&, const SceneObject& object, const Part&, const sensor::CylinderShape&) {
    PATINA_ASSERT(false, "cylinder ", object.material.name);
}

void add(World&, const SceneObject& object, const Part&, const sensor::MeshShape&) {
    PATINA_ASSERT(false, "mesh ", object.material.name);
}

std::optional<Hit> intersect(const Face& face, glm::dvec3 origin_m, glm::dvec3 direction) {
    const glm::dvec3 outward = glm::normalize(glm::cross(face.half_edge_u, face.half_edge_v));
    const double facing = glm::dot(outward, direction);
    if (facing == 0 || (facing > 0 && !face.two_sided)) return std::nullopt;
    const double distance_m = glm::dot(outward, face.center_m - origin_m) / facing;
    const glm::dvec3 offset = origin_m + distance_m * direction - face.center_m;
    const double u = glm::dot(offset, face.half_edge_u) / glm::dot(face.half_edge_u, face.half_edge_u);
    const double v = glm::dot(offset, face.half_edge_v) / glm::dot(face.half_edge_v, face.half_edge_v);
    if (distance_m <= 0 || std::abs(u) > 1 || std::abs(v) > 1) return std::nullopt;
    return Hit{distance_m, facing > 0 ? -outward : outward, face.object};
}

std::optional<Hit> intersect(const Ball& ball, glm::dvec3 origin_m, glm::dvec3 direction) {
    const glm::dvec3 offset = origin_m - ball.center_m;
    const double half_b = glm::dot(offset, direction);
    const double c = glm::dot(offset, offset) - ball.radius_m * ball.radius_m;
    const double discriminant = half_b * half_b - c;
    const double distance_m = -half_b - std::sqrt(discriminant);
    if (discriminant < 0 || distance_m <= 0) return std::nullopt;
    return Hit{distance_m, (offset + distance_m * direction) / ball.radius_m, ball.object};
}

Hit nearest(const World& world, glm::dvec3 origin_m, glm::dvec3 direction) {
    Hit best;
    const auto consider = [&](const auto& primitive) {
        const auto hit = intersect(primitive, origin_m, direction);
        if (hit && hit->distance_m < best.distance_m) best = *hit;
    };
    for (const Face& face : world.faces) consider(face);
    for (const Ball& ball : world.balls) consider(ball);
    return best;
}

bool occluded(const World& world, glm::dvec3 point_m, glm::dvec3 normal, glm::dvec3 light_m) {
    const glm::dvec3 origin_m = point_m + 1e-9 * normal;
    return nearest(world, origin_m, glm::normalize(light_m - origin_m)).distance_m < glm::distance(light_m, origin_m);
}

glm::dvec3 shade(const World& world, const sensor::Scene& scene, const Hit& hit, glm::dvec3 point_m,
                 glm::dvec3 to_viewer, bool shadows) {
    const sensor::Material& m = hit.object->material;
    glm::dvec3 sum(0);
    for (const sensor::PointLight& light : scene.lights) {
        if (shadows && occluded(world, point_m, hit.normal, light.position_m)) continue;
        const double r = glm::distance(light.position_m, point_m);
        const glm::dvec3 to_light = (light.position_m - point_m) / r;
        sum += ward({*m.kd, m.ks, m.alpha}, hit.normal, to_light, to_viewer) * light.intensity / (r * r) *
               glm::dot(hit.normal, to_light);
    }
    return sum;
}

}  // namespace

Image<TracedPixel> trace_scene(const sensor::Scene& scene, const Intrinsics& camera,
                               const RigidTransform& world_from_camera, bool shadows) {
    World world;
    for (const SceneObject& object : scene.objects)
        for (const Part& part : object.parts)
            std::visit([&](const auto& shape) { add(world, object, part, shape); }, part.shape);
    Image<TracedPixel> image(camera.extent);
    const glm::dvec3 center_m(world_from_camera[3]);
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            const glm::dvec3 ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
            const glm::dvec3 direction = glm::normalize(glm::dmat3(world_from_camera) * ray);
            const Hit hit = nearest(world, center_m, direction);
            if (!hit.object) continue;
            const glm::dvec3 point_m = center_m + hit.distance_m * direction;
            image.at(x, y) = {shade(world, scene, hit, point_m, -direction, shadows), hit.distance_m / glm::length(ray),
                              hit.object->material.id, hit.normal};
        }
    }
    return image;
}

}  // namespace patina::reference
