#include "tests/reference/scenes/gather_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "tests/reference/lighting/lamp_emission.h"
#include "tests/reference/scenes/scene_shapes.h"
#include "tests/reference/shading/ward.h"

namespace patina::reference {
namespace {

using std::numbers::pi;

struct Point {
    glm::dvec3 position_m, normal, to_viewer;
    const sensor::Material* material;
};

class World {
  public:
    explicit World(const scenes::SyntheticScene& scene) : scene_(scene) {
        for (const scenes::SceneObject& object : scene.objects)
            for (const scenes::Part& part : object.parts)
                for (const Primitive& surface : surfaces_of(part)) surfaces_.push_back({surface, &object.material});
    }

    /// Camera rays do not see surfaces behind lamps.
    std::optional<Point> first_hit(glm::dvec3 origin_m, glm::dvec3 direction, bool lamps_block) const {
        double least_m = INFINITY;
        const Owned* hit = nullptr;
        for (const Owned& owned : surfaces_) {
            const auto distance_m = intersect(owned.surface, origin_m, direction);
            if (distance_m && *distance_m < least_m) least_m = *distance_m, hit = &owned;
        }
        for (const Light& light : scene_.lights) {
            if (!lamps_block || light.radius_m == 0) continue;
            const Ball ball{scenes::placed(light.position_m, {0, 1, 0}, 0), light.radius_m};
            const auto distance_m = intersect(ball, origin_m, direction);
            if (distance_m && *distance_m < least_m) return std::nullopt;
        }
        if (!hit) return std::nullopt;
        const glm::dvec3 position_m = origin_m + least_m * direction;
        const Spot spot = spot_at(hit->surface, position_m, origin_m);
        const glm::dvec3 normal = glm::dot(spot.geometric, direction) > 0 ? -spot.geometric : spot.geometric;
        return Point{position_m + 1e-9 * normal, normal, -direction, hit->material};
    }

    /// One sample of what leaves `at` towards its viewer, reflected at most `bounces` + 1 times.
    glm::dvec3 sample(const Point& at, int bounces) {
        glm::dvec3 sum(0);
        for (const Light& light : scene_.lights) sum += sample_lamp(at, light);
        const glm::dvec3 d = uniform_direction();
        const glm::dvec3 to_light = glm::dot(d, at.normal) < 0 ? -d : d;  // of density 1 / (2 pi)
        const auto next = first_hit(at.position_m, to_light, false);
        const glm::dvec3 arriving = !next         ? far_radiance(to_light)
                                    : bounces > 0 ? sample(*next, bounces - 1)
                                                  : glm::dvec3(0);
        return sum + reflected(at, to_light) * arriving * (2 * pi);
    }

  private:
    struct Owned {
        Primitive surface;
        const sensor::Material* material;
    };

    static glm::dvec3 reflected(const Point& at, glm::dvec3 to_light) {
        const sensor::Material& m = *at.material;
        return ward({*m.kd, m.ks, m.alpha}, at.normal, to_light, at.to_viewer) *
               std::max(0.0, glm::dot(at.normal, to_light));
    }

    glm::dvec3 uniform_direction() {
        const double z = 2 * number_(random_) - 1, phi = 2 * pi * number_(random_);
        return {std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z};
    }

    /// From a point drawn uniformly on the sphere: radiance * area * cosine there / distance^2.
    glm::dvec3 sample_lamp(const Point& at, const Light& light) {
        const glm::dvec3 outward = uniform_direction();
        const glm::dvec3 offset_m = light.position_m + light.radius_m * outward - at.position_m;
        const double r = glm::length(offset_m);
        const glm::dvec3 to_light = offset_m / r;
        glm::dvec3 irradiance = emitted(light.intensity, light.axis, to_light) / (r * r);
        if (light.radius_m > 0) irradiance *= 4 * std::max(0.0, -glm::dot(outward, to_light));
        const auto blocking = first_hit(at.position_m, to_light, false);
        if (blocking && glm::distance(blocking->position_m, at.position_m) < r) return glm::dvec3(0);
        return reflected(at, to_light) * irradiance;
    }

    glm::dvec3 far_radiance(glm::dvec3 d) const {
        if (!scene_.environment) return glm::dvec3(0);
        const Image<glm::vec3>& picture = *scene_.environment->radiance;
        const auto index = [](double share, uint32_t size) {
            return std::min(size - 1, static_cast<uint32_t>(share * size));
        };
        return glm::dvec3(picture.at(index(std::atan2(d.x, d.z) / (2 * pi) + 0.5, picture.extent().width),
                                     index(std::acos(-d.y) / pi, picture.extent().height)));
    }

    const scenes::SyntheticScene& scene_;
    std::vector<Owned> surfaces_;
    std::mt19937_64 random_{1};
    std::uniform_real_distribution<double> number_{0, 1};
};

}  // namespace

Image<Estimate> gather_light(const scenes::SyntheticScene& scene, const Intrinsics& camera,
                             const RigidTransform& world_from_camera, uint32_t samples) {
    World world(scene);
    Image<Estimate> image(camera.extent);
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            const glm::dvec3 ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
            const glm::dvec3 direction = glm::normalize(glm::dmat3(world_from_camera) * ray);
            const auto seen = world.first_hit(glm::dvec3(world_from_camera[3]), direction, true);
            if (!seen) continue;
            glm::dvec3 sum(0), squares(0);
            for (uint32_t i = 0; i < samples; ++i) {
                const glm::dvec3 sample = world.sample(*seen, 1);
                sum += sample, squares += sample * sample;
            }
            const glm::dvec3 mean = sum / double(samples);
            image.at(x, y) = {mean, glm::sqrt((squares / double(samples) - mean * mean) / double(samples))};
        }
    }
    return image;
}

}  // namespace patina::reference
