#include "scenes/description/vary.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/core/luminance.h"
#include "scenes/description/clearance.h"
#include "scenes/description/draws.h"
#include "scenes/description/vary_path.h"
#include "scenes/render/material_table.h"

namespace patina::scenes {
namespace {

constexpr double kMost = 0.95;  // of kd + ks
constexpr double kSmoothest = 0.02, kRoughest = 0.5;

double largest(glm::dvec3 v) { return std::max({v.x, v.y, v.z}); }

/// A material like `entry`: of another colour, a little smoother or rougher.
void set_like(const TableMaterial& entry, Draws draws, sensor::Material& material) {
    const double brightness = draws.factor(1.25);
    glm::dvec3 kd = entry.kd * brightness;
    for (int c = 0; c < 3; ++c) kd[c] *= draws.factor(1.3);
    const glm::dvec3 ks = entry.ks * draws.factor(1.3);
    const double excess = std::max(1.0, largest(kd + ks) / kMost);
    material.kd = kd / excess;
    material.ks = ks / excess;
    material.alpha = std::clamp(entry.alpha * draws.factor(1.25), kSmoothest, kRoughest);
}

/// Another coat on the same picture. Its darkest tint leaves room for the strongest ks, whatever the picture.
void vary_coat(Draws draws, SceneObject& object) {
    glm::dvec3 tint(0);
    for (int c = 0; c < 3; ++c) tint[c] = draws.between(0.65, 0.9);
    Image<glm::vec3> kd = *object.texture->kd;
    for (glm::vec3& pixel : kd.pixels()) pixel *= glm::vec3(tint);
    object.texture->kd = std::make_shared<const Image<glm::vec3>>(std::move(kd));
    object.material.ks = glm::dvec3(0.03 * draws.factor(3));
    object.material.alpha = 0.14 * draws.factor(3.5);
}

/// Each material of the table comes once before any comes twice.
void vary_materials(std::vector<SceneObject>& objects, uint64_t seed) {
    std::vector<TableMaterial> table(material_table().begin(), material_table().end());
    Draws order(seed, "order of materials");
    for (size_t i = table.size(); i > 1; --i) std::swap(table[i - 1], table[order.below(i)]);
    for (size_t i = 0; i < objects.size(); ++i) {
        const Draws draws(seed, "material", i);
        if (objects[i].texture) {
            vary_coat(draws, objects[i]);
        } else {
            set_like(table[i % table.size()], draws, objects[i].material);
        }
    }
}

double total_luminance(const std::vector<Light>& lights) {
    return std::accumulate(lights.begin(), lights.end(), 0.0,
                           [](double sum, const Light& light) { return sum + luminance(light.intensity); });
}

/// Black bodies of 3500 K to 6500 K, of luminance 1 and relative to 4500 K, in linear sRGB (CIE 1931).
glm::dvec3 tint_between_warm_and_cool(double share) {
    return glm::mix(glm::dvec3(1.233, 0.967, 0.637), glm::dvec3(0.779, 1.011, 1.541), share);
}

/// How far a lamp gets along `way_m` if it keeps half its room.
glm::dvec3 moved(const Light& light, glm::dvec3 way_m, const Clearance& clearance) {
    const double room_m = clearance.at(light.position_m) - light.radius_m;
    return clearance.reached(light.position_m, way_m, light.radius_m + room_m / 2);
}

glm::dvec3 center_of(const std::vector<SceneObject>& objects) {
    glm::dvec3 sum(0);
    for (const SceneObject& object : objects) sum += glm::dvec3(object.parts.front().world_from_part[3]);
    return sum / std::max<double>(1, static_cast<double>(objects.size()));
}

void vary_lights(SyntheticScene& scene, const Clearance& clearance, uint64_t seed, double reach) {
    const double total = total_luminance(scene.lights);
    const glm::dvec3 center_m = center_of(scene.objects);
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        Light& light = scene.lights[i];
        Draws draws(seed, "light", i);
        const double reach_m = reach * glm::distance(light.position_m, center_m);
        light.position_m = moved(light, reach_m * draws.in_ball(), clearance);
        light.intensity *= tint_between_warm_and_cool(draws.between(0, 1)) * draws.factor(1.4);
    }
    const double changed = total_luminance(scene.lights);
    if (!(changed > 0)) return;
    for (Light& light : scene.lights) light.intensity *= total / changed;
}

void turn(Environment& environment, Draws draws) {
    Image<glm::vec3> radiance = *environment.radiance;
    const uint32_t width = radiance.extent().width;
    const auto columns = static_cast<std::ptrdiff_t>(draws.below(width));
    for (auto row = radiance.pixels().begin(); row != radiance.pixels().end(); row += width)
        std::rotate(row, row + columns, row + width);
    environment.radiance = std::make_shared<const Image<glm::vec3>>(std::move(radiance));
}

}  // namespace

SyntheticScene with_varied_light(SyntheticScene scene, uint64_t seed, double reach) {
    vary_lights(scene, Clearance(scene.objects), seed, reach);
    if (scene.environment) turn(*scene.environment, Draws(seed, "environment"));
    return scene;
}

SyntheticScene varied(SyntheticScene scene, uint64_t seed) {
    vary_materials(scene.objects, seed);
    scene = with_varied_light(std::move(scene), seed);
    Clearance clearance(scene.objects);
    for (const Light& light : scene.lights) clearance.add(light);
    scene.path = varied(scene.path, Draws(seed, "path"), clearance);
    if (scene.lighting) scene.lighting->path = varied(scene.lighting->path, Draws(seed, "lighting path"), clearance);
    return scene;
}

}  // namespace patina::scenes
