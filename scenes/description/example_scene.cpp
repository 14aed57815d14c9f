#include "scenes/description/example_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/luminance.h"
#include "scenes/description/draws.h"

namespace patina::scenes {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMostAlbedo = 0.95;    // of kd + ks
constexpr double kSeenCosine = 0.1736;  // 80 degrees: from where a voxel may be observed
constexpr uint32_t kUsefulViews = 7;    // at least, that a voxel faces, so that it gets into HemiImages

/// Towards an azimuth and an elevation; world y points down.
glm::dvec3 direction_of(double azimuth, double elevation) {
    return {std::cos(elevation) * std::sin(azimuth), -std::sin(elevation), std::cos(elevation) * std::cos(azimuth)};
}

glm::dvec3 on_sphere(Draws& draws) {
    for (;;) {
        const glm::dvec3 p = draws.in_ball();
        if (const double length = glm::length(p); length > 0.1) return p / length;
    }
}

bool chance(Draws& draws, double share) { return draws.between(0, 1) < share; }

glm::dvec3 three(Draws& draws, double low, double high) {
    const double r = draws.between(low, high), g = draws.between(low, high), b = draws.between(low, high);
    return {r, g, b};
}

/// Black bodies of about 3500 K to 6500 K, of luminance 1.
glm::dvec3 lamp_tint(Draws& draws) {
    return glm::mix(glm::dvec3(1.233, 0.967, 0.637), glm::dvec3(0.779, 1.011, 1.541), draws.between(0, 1));
}

glm::dvec3 draw_kd(Draws& draws) {
    // As often a colour as a shade of grey; even steps of sRGB, not of radiance.
    const bool colored = chance(draws, 0.5);
    for (;;) {
        glm::dvec3 code = three(draws, 0, 1);
        if (!colored) code = glm::clamp(glm::dvec3(code.x) + 0.12 * (2.0 * three(draws, 0, 1) - 1.0), 0.0, 1.0);
        const glm::dvec3 kd = glm::pow(code, glm::dvec3(2.2));
        const double brightness = luminance(kd);
        if (brightness >= 0.02 && brightness <= 0.85) return kd;
    }
}

/// A curved, a boxy, or a flat thing around the origin.
class ExampleShape {
  public:
    ExampleShape(Draws& draws) {
        const double kind = draws.between(0, 1);
        kind_ = kind < 0.4 ? Kind::kBall : kind < 0.55 ? Kind::kCylinder : kind < 0.78 ? Kind::kBox : Kind::kPlane;
        half_m_ = 0.05 * std::exp(draws.between(0, std::log(12.0))) * three(draws, 0.7, 1.3);
        if (kind_ == Kind::kPlane) half_m_ = 2.5 * half_m_;
        upright_ = kind_ == Kind::kPlane && chance(draws, 0.35);
        azimuth_ = draws.between(-kPi, kPi);
    }

    struct Point {
        glm::dvec3 point_m, normal;
    };
    Point point(Draws& draws) const {
        switch (kind_) {
            case Kind::kBall: {
                const glm::dvec3 n = on_sphere(draws);
                return {half_m_.x * n, n};
            }
            case Kind::kCylinder: {
                const glm::dvec3 n = direction_of(draws.between(-kPi, kPi), 0);
                return {half_m_.x * n + glm::dvec3(0, half_m_.y * draws.between(-1.5, 1.5), 0), n};
            }
            case Kind::kBox: {
                const size_t face = draws.below(5);  // top, then the four sides
                return face == 0 ? flat(draws, {0, -1, 0}, half_m_.y)
                                 : flat(draws, direction_of(azimuth_ + static_cast<double>(face) * kPi / 2, 0),
                                        face % 2 == 0 ? half_m_.x : half_m_.z);
            }
            case Kind::kPlane: break;
        }
        return flat(draws, main_normal(), 0);
    }

    bool is_plane() const { return kind_ == Kind::kPlane; }
    bool is_wall() const { return upright_; }
    double azimuth() const { return azimuth_; }
    double reach_m() const { return std::max({half_m_.x, half_m_.y, half_m_.z}); }
    glm::dvec3 main_normal() const { return upright_ ? direction_of(azimuth_, 0) : glm::dvec3(0, -1, 0); }

  private:
    enum class Kind { kBall, kCylinder, kBox, kPlane };

    Point flat(Draws& draws, glm::dvec3 normal, double away_m) const {
        const bool level = std::abs(normal.y) > 0.5;
        const glm::dvec3 across = level ? direction_of(azimuth_, 0) : glm::dvec3(0, 1, 0);
        const glm::dvec3 along = glm::cross(across, normal);
        const double u = draws.between(-1, 1) * half_m_.y, v = draws.between(-1, 1) * half_m_.x;
        return {away_m * normal + u * across + v * along, normal};
    }

    Kind kind_;
    glm::dvec3 half_m_;
    bool upright_;
    double azimuth_;
};

/// A camera's ways around the origin: a few waves of azimuth, elevation and distance.
void draw_views(Draws draws, const ExampleShape& shape, ExampleScene& result) {
    const bool orbit = !shape.is_wall() && chance(draws, 0.5);
    result.scene.views = static_cast<uint32_t>(draws.between(10, gpu::kExampleViews + 1));
    const double arc = glm::radians(orbit ? draws.between(60, 360) : draws.between(15, 110));
    const double azimuth = shape.is_wall() ? shape.azimuth() + draws.between(-0.8, 0.8) : draws.between(-kPi, kPi);
    const double elevation = glm::radians(shape.is_wall() ? draws.between(-20, 35) : draws.between(5, 60));
    const double rise = glm::radians(draws.between(2, orbit ? 20 : 30));
    const double distance_m = 1.3 * shape.reach_m() + 0.4 * std::exp(draws.between(0, std::log(8.0)));
    const glm::dvec3 phases = three(draws, 0, 2 * kPi), turns = three(draws, 0.4, orbit ? 1.5 : 3);
    for (uint32_t i = 0; i < result.scene.views; ++i) {
        const double time = (i + draws.between(0, 0.8)) / result.scene.views;
        const glm::dvec3 wave = glm::sin(phases + 2 * kPi * time * turns);
        const double around = orbit ? azimuth + arc * time : azimuth + arc / 2 * wave.x;
        const double up = std::clamp(elevation + rise * wave.y, glm::radians(-30.0), glm::radians(80.0));
        const glm::dvec3 at_m = distance_m * (1 + 0.2 * wave.z) * direction_of(around, up) + 0.03 * draws.in_ball();
        result.views[i] = glm::vec4(glm::vec3(at_m), 0);
    }
}

void draw_lamps(Draws draws, const ExampleShape& shape, ExampleScene& result) {
    double total = 0;
    for (uint32_t i = 0; i < result.scene.lamps; ++i) {
        glm::dvec3 away = direction_of(draws.between(-kPi, kPi), glm::radians(draws.between(-10, 80)));
        const double beyond = glm::dot(away, shape.main_normal());
        if (shape.is_plane() && beyond < 0.1) away += (0.2 - 2 * std::min(beyond, 0.0)) * shape.main_normal();
        const double distance_m = shape.reach_m() + draws.between(1, 4);
        const double strength = draws.factor(2);
        total += strength;
        result.lamps[i].position_m = glm::vec4(glm::vec3(distance_m * glm::normalize(away)), 0);
        result.lamps[i].axis = glm::vec4(0, 0, 0, 1);
        result.lamps[i].intensity = glm::vec4(glm::vec3(strength * distance_m * distance_m * lamp_tint(draws)), 0);
    }
    if (result.scene.windows > 0) return;
    // Light from all around, up to 30 % of what the lamps give.
    const glm::dvec3 ambient = draws.between(0, 0.3) * total / kPi * lamp_tint(draws);
    const double tilt = draws.between(0, 0.7);
    result.scene.sky = glm::vec4(glm::vec3(ambient * (1 + tilt)), 0);
    result.scene.ground = glm::vec4(glm::vec3(ambient * (1 - tilt)), 0);
}

void draw_environment(Draws draws, ExampleScene& result) {
    const glm::dvec3 sky = lamp_tint(draws) * draws.between(0.1, 1);
    const glm::dvec3 ground = sky * three(draws, 0.2, 1) * draws.between(0.1, 1);
    result.scene.sky = glm::vec4(glm::vec3(sky), 0);
    result.scene.ground = glm::vec4(glm::vec3(ground), 0);
    for (uint32_t i = 0; i < result.scene.windows; ++i) {
        const glm::dvec3 middle = direction_of(draws.between(-kPi, kPi), glm::radians(draws.between(-10, 85)));
        const double outer = 5 * std::exp(draws.between(0, std::log(8.0)));  // degrees, to 40
        const double inner = outer * draws.between(0.3, 0.9);
        // A small window is brighter, so that each gives about as much light.
        const double radiance = std::min(draws.factor(4) * 800 / (outer * outer), 60.0);
        result.windows[i].direction = glm::vec4(glm::vec3(middle), std::cos(glm::radians(outer)));
        result.windows[i].radiance = glm::vec4(glm::vec3(radiance * lamp_tint(draws)), std::cos(glm::radians(inner)));
    }
}

/// Planes behind which a lamp is hidden from a part of the voxels.
uint32_t shadow_at(const Draws& common, const ExampleScene& scene, double reach_m, glm::dvec3 point_m) {
    Draws draws = common;
    uint32_t shadow = 0;
    for (uint32_t i = 0; i < scene.scene.lamps; ++i) {
        const bool casts = chance(draws, 0.35);
        const glm::dvec3 across = on_sphere(draws);
        const double beyond_m = draws.between(-0.3, 0.9) * reach_m;
        if (casts && glm::dot(across, point_m) > beyond_m) shadow |= 1u << i;
    }
    return shadow;
}

uint32_t views_faced(const ExampleScene& scene, const ExampleShape::Point& at) {
    uint32_t faced = 0;
    for (uint32_t i = 0; i < scene.scene.views; ++i) {
        const glm::dvec3 toward = glm::dvec3(scene.views[i]) - at.point_m;
        faced += glm::dot(at.normal, toward) > kSeenCosine * glm::length(toward) ? 1u : 0u;
    }
    return faced;
}

/// A point that several views face, if there is one.
ExampleShape::Point draw_point(Draws& draws, const ExampleShape& shape, const ExampleScene& scene) {
    ExampleShape::Point best = shape.point(draws);
    const uint32_t enough = std::max(kUsefulViews, static_cast<uint32_t>(draws.between(0.2, 0.6) * scene.scene.views));
    uint32_t most = views_faced(scene, best);
    for (int attempt = 0; attempt < 16 && most < enough; ++attempt) {
        const ExampleShape::Point other = shape.point(draws);
        if (const uint32_t faced = views_faced(scene, other); faced > most) {
            most = faced;
            best = other;
        }
    }
    return best;
}

glm::dvec3 tilted(Draws& draws, glm::dvec3 normal, double most_degrees) {
    // A point of a disk, evenly distributed: small errors are rarer than middling ones.
    const double radius = std::tan(glm::radians(most_degrees)) * std::sqrt(draws.between(0, 1));
    const glm::dvec3 across = glm::normalize(glm::cross(normal, on_sphere(draws)));
    return glm::normalize(normal + radius * across);
}

void draw_voxels(uint64_t seed, uint64_t index, const ExampleShape& shape, ExampleScene& result) {
    Draws draws(seed, "example voxels", index);
    const Draws shadows(seed, "example shadows", index);
    const double texture = chance(draws, 0.25) ? draws.between(0.1, 0.6) : 0;
    for (gpu::ExampleVoxel& voxel : result.voxels) {
        const ExampleShape::Point at = draw_point(draws, shape, result);
        const double factor = 1 + texture * draws.between(-1, 1);
        const bool foreign = chance(draws, 0.05);
        voxel.point_m = glm::vec4(glm::vec3(at.point_m), factor);
        voxel.normal = glm::vec4(glm::vec3(at.normal), 0);
        voxel.stored_normal = glm::vec4(glm::vec3(tilted(draws, at.normal, result.normal_error_degrees)), 0);
        voxel.material = static_cast<uint32_t>(1 + draws.below(gpu::kExampleMaterials - 1));
        if (!foreign) voxel.material = 0;
        voxel.shadow = shadow_at(shadows, result, shape.reach_m(), at.point_m);
    }
}

}  // namespace

gpu::WardMaterial draw_example_material(uint64_t seed, uint64_t index, uint32_t which) {
    Draws draws(seed, "example material", index * gpu::kExampleMaterials + which);
    glm::dvec3 kd = draw_kd(draws);
    const bool matte = chance(draws, 0.1), tinted = chance(draws, 0.3);
    glm::dvec3 ks(0.5 * std::pow(draws.between(0, 1), 3));
    const glm::dvec3 tint = three(draws, 0.3, 1);
    if (tinted) ks *= tint / std::max({tint.x, tint.y, tint.z});
    if (matte) ks = glm::dvec3(0);
    const double alpha = 0.03 + 0.47 * std::pow(draws.between(0, 1), 1.5);
    const glm::dvec3 sum = kd + ks;
    const double excess = std::max(1.0, std::max({sum.x, sum.y, sum.z}) / kMostAlbedo);
    return {glm::vec4(glm::vec3(kd / excess), 1), glm::vec4(glm::vec3(ks / excess), static_cast<float>(alpha))};
}

ExampleScene draw_example_scene(uint64_t seed, uint64_t index) {
    Draws draws(seed, "example scene", index);
    ExampleScene result;
    const ExampleShape shape(draws);
    const bool environment = chance(draws, 0.5), lamp_too = chance(draws, 0.3);
    result.scene.windows = environment ? static_cast<uint32_t>(1 + draws.below(6)) : 0;
    result.scene.lamps = environment ? (lamp_too ? 1 : 0) : static_cast<uint32_t>(1 + draws.below(6));
    result.scene.read = static_cast<float>(draws.between(0, 0.005));
    result.scene.shot = static_cast<float>(1 / (1000 * std::exp(draws.between(0, std::log(10.0)))));
    result.normal_error_degrees = static_cast<float>(draws.between(0, 6));
    if (environment) draw_environment(Draws(seed, "example environment", index), result);
    draw_lamps(Draws(seed, "example lamps", index), shape, result);
    draw_views(Draws(seed, "example views", index), shape, result);
    for (uint32_t i = 0; i < gpu::kExampleMaterials; ++i) result.materials[i] = draw_example_material(seed, index, i);
    draw_voxels(seed, index, shape, result);
    result.scene.sky.w = static_cast<float>(draws.between(0.5, 1.2));
    result.scene.ground.w = static_cast<float>(0.5 * draws.between(0, 1) * draws.between(0, 1));
    return result;
}

}  // namespace patina::scenes
