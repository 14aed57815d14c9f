#include "tests/reference/scenes/trace_scene.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "tests/reference/lighting/lamp_emission.h"
#include "tests/reference/scenes/scene_shapes.h"
#include "tests/reference/shading/ward.h"

namespace patina::reference {
namespace {

using scenes::SceneObject;

struct TracedShape {
    Primitive surface;
    const SceneObject* object;
};

using TracedWorld = std::vector<TracedShape>;

struct Hit {
    double distance_m = INFINITY;
    const TracedShape* what = nullptr;
};

Hit nearest(const TracedWorld& world, glm::dvec3 origin_m, glm::dvec3 direction) {
    Hit best;
    for (const TracedShape& owned : world) {
        const auto distance_m = intersect(owned.surface, origin_m, direction);
        if (distance_m && *distance_m < best.distance_m) best = {*distance_m, &owned};
    }
    return best;
}

bool occluded(const TracedWorld& world, glm::dvec3 from_m, glm::dvec3 light_m) {
    return nearest(world, from_m, glm::normalize(light_m - from_m)).distance_m < glm::distance(light_m, from_m);
}

/// Bilinear and repeated; texel (i, j) has its centre at ((i + 0.5) / width, (j + 0.5) / height) of the repeat.
glm::dvec3 kd_at(const SceneObject& object, glm::dvec2 uv) {
    if (!object.texture) return *object.material.kd;
    const Image<glm::vec3>& picture = *object.texture->kd;
    const auto texel = [&](double x, double y) {
        const auto wrapped = [](double i, uint32_t size) {
            return static_cast<uint32_t>((static_cast<int64_t>(i) % size + size) % size);
        };
        return glm::dvec3(picture.at(wrapped(x, picture.extent().width), wrapped(y, picture.extent().height)));
    };
    const double x = uv.x / object.texture->repeat.x * picture.extent().width - 0.5;
    const double y = uv.y / object.texture->repeat.y * picture.extent().height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    return (1 - (x - left)) * (1 - (y - top)) * texel(left, top) + (x - left) * (1 - (y - top)) * texel(left + 1, top) +
           (1 - (x - left)) * (y - top) * texel(left, top + 1) + (x - left) * (y - top) * texel(left + 1, top + 1);
}

TracedPixel shade(const TracedWorld& world, const scenes::SyntheticScene& scene, const Hit& hit, glm::dvec3 viewer_m,
                  glm::dvec3 direction, bool shadows) {
    const glm::dvec3 point_m = viewer_m + hit.distance_m * direction;
    const Spot spot = spot_at(hit.what->surface, point_m, viewer_m);
    const glm::dvec3 geometric = glm::dot(spot.geometric, direction) > 0 ? -spot.geometric : spot.geometric;
    const glm::dvec3 interpolated = glm::dot(spot.normal, geometric) < 0 ? -spot.normal : spot.normal;
    const sensor::Material& m = hit.what->object->material;
    TracedPixel pixel{.seen = true, .object_id = m.id};
    pixel.normal = glm::dot(interpolated, direction) < 0 ? interpolated : geometric;
    pixel.kd = kd_at(*hit.what->object, spot.uv);
    pixel.facing = -glm::dot(geometric, direction);
    for (const Light& light : scene.lights) {
        if (shadows && occluded(world, spot.smooth_m + 1e-9 * geometric, light.position_m)) continue;
        const double r = glm::distance(light.position_m, point_m);
        const glm::dvec3 to_light = (light.position_m - point_m) / r;
        pixel.radiance += ward({pixel.kd, m.ks, m.alpha}, pixel.normal, to_light, -direction) *
                          emitted(light.intensity, light.axis, to_light) / (r * r) * glm::dot(pixel.normal, to_light);
    }
    return pixel;
}

/// The lamp's own light, where it is nearer than `distance_m`.
std::optional<TracedPixel> see_lamp(const Light& light, glm::dvec3 origin_m, glm::dvec3 direction, double& distance_m) {
    if (light.radius_m == 0) return std::nullopt;
    const RigidTransform world_from_lamp = scenes::placed(light.position_m, {0, 1, 0}, 0);
    const auto hit = intersect(Ball{world_from_lamp, light.radius_m}, origin_m, direction);
    if (!hit || *hit >= distance_m) return std::nullopt;
    distance_m = *hit;
    TracedPixel pixel{.seen = true};
    pixel.radiance =
        emitted(light.intensity, light.axis, direction) / (std::numbers::pi * light.radius_m * light.radius_m);
    pixel.normal = (origin_m + distance_m * direction - light.position_m) / light.radius_m;
    return pixel;
}

}  // namespace

Image<TracedPixel> trace_scene(const scenes::SyntheticScene& scene, const Intrinsics& camera,
                               const RigidTransform& world_from_camera, bool shadows) {
    TracedWorld world;
    for (const SceneObject& object : scene.objects)
        for (const scenes::Part& part : object.parts)
            for (const Primitive& surface : surfaces_of(part)) world.push_back({surface, &object});
    Image<TracedPixel> image(camera.extent);
    const glm::dvec3 center_m(world_from_camera[3]);
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            const glm::dvec3 ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
            const glm::dvec3 direction = glm::normalize(glm::dmat3(world_from_camera) * ray);
            const Hit hit = nearest(world, center_m, direction);
            TracedPixel& pixel = image.at(x, y);
            if (hit.what) pixel = shade(world, scene, hit, center_m, direction, shadows);
            double distance_m = hit.distance_m;
            for (const Light& light : scene.lights)
                if (const auto lamp = see_lamp(light, center_m, direction, distance_m)) pixel = *lamp;
            if (pixel.seen) pixel.depth_m = distance_m / glm::length(ray);
        }
    }
    return image;
}

}  // namespace patina::reference
