#include "tests/reference/lighting/find_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace patina::reference {
namespace {

constexpr size_t kSeeds = 256;
constexpr int kShifts = 12;

struct Shining {
    glm::dvec3 bearing, radiance;
    std::optional<glm::dvec3> point_m;
    double range_m, angle_sr;
    bool at_border;

    double mass() const { return angle_sr * glm::dot(radiance, {0.2126, 0.7152, 0.0722}); }
    glm::dvec3 place() const { return point_m.value_or(bearing); }
};

struct Mode {
    glm::dvec3 place{0};
    double mass = 0;
    bool has_depth = false;
    double angle_sr = 0;
    double reach = 0;  ///< radius of the kernel
};

std::vector<Shining> shining_pixels(const Image<glm::vec3>& color, const Image<float>& depth_m,
                                    const Intrinsics& camera, const RigidTransform& world_from_camera,
                                    const LightFinding& settings) {
    std::vector<Shining> list;
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            const glm::dvec3 value(color.at(x, y));
            if (glm::dot(value, {0.2126, 0.7152, 0.0722}) < settings.threshold) continue;
            const glm::dvec3 ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
            const double cosine = 1 / glm::length(ray), z_m = depth_m.at(x, y);
            Shining s;
            s.bearing = glm::dmat3(world_from_camera) * ray * cosine;
            s.radiance = value * settings.radiance_scale;
            s.range_m = z_m / cosine;
            if (z_m > 0) s.point_m = glm::dvec3(world_from_camera[3]) + s.range_m * s.bearing;
            s.angle_sr = std::pow(cosine, 3) / (camera.fx * camera.fy);
            s.at_border = x == 0 || y == 0 || x + 1 == camera.extent.width || y + 1 == camera.extent.height;
            list.push_back(s);
        }
    }
    return list;
}

double bandwidth(const LightFinding& settings, bool has_depth) {
    return has_depth ? settings.bandwidth_m : settings.bandwidth_chord;
}

bool counts_for(const Shining& s, const Mode& mode) {
    return s.point_m.has_value() == mode.has_depth && glm::distance(s.place(), mode.place) <= mode.reach;
}

Mode shifted(const std::vector<Shining>& list, glm::dvec3 from, bool has_depth, double reach) {
    Mode mode{from, 0, has_depth, 0, reach};
    for (int i = 0; i < kShifts; ++i) {
        glm::dvec3 sum(0);
        double mass = 0;
        for (const Shining& s : list) {
            if (!counts_for(s, mode)) continue;
            sum += s.place() * s.mass();
            mass += s.mass();
        }
        mode.place = sum / mass;
        mode.mass = mass;
    }
    for (const Shining& s : list)
        if (counts_for(s, mode)) mode.angle_sr += s.angle_sr;
    if (!mode.has_depth) mode.place = glm::normalize(mode.place);
    return mode;
}

/// Whether each of the kernel's outer rings, as the camera sees them, holds a twentieth of what is in the kernel, half
/// as bright as its mean at least.
bool reaches_beyond(const std::vector<Shining>& list, const Mode& mode, glm::dvec3 camera_m) {
    const glm::dvec3 sight = mode.has_depth ? glm::normalize(mode.place - camera_m) : mode.place;
    double outer = mode.reach;
    for (int ring = 0; ring < 4; ++ring, outer *= 0.8) {
        double ring_sr = 0;
        for (const Shining& s : list) {
            const glm::dvec3 offset = s.place() - mode.place;
            const double across = glm::length(glm::cross(offset, sight));
            const bool bright = s.mass() / s.angle_sr >= 0.5 * mode.mass / mode.angle_sr;
            if (counts_for(s, mode) && bright && across > 0.8 * outer && across <= outer) ring_sr += s.angle_sr;
        }
        if (ring_sr <= 0.05 * mode.angle_sr) return false;
    }
    return true;
}

/// With a kernel that holds the whole lamp.
Mode grown(const std::vector<Shining>& list, const Mode& mode, glm::dvec3 camera_m) {
    Mode larger = mode;
    for (int i = 0; i <= 6; ++i) {
        if (!reaches_beyond(list, larger, camera_m)) return larger;
        larger = shifted(list, larger.place, mode.has_depth, larger.reach * 1.25);
    }
    return mode;
}

/// Half the opening angle of the cone of that solid angle.
double cone_half_angle(double solid_angle_sr) { return std::acos(1 - solid_angle_sr / (2 * std::numbers::pi)); }

/// Whether two modes' discs touch, to a pixel, seen from the camera.
bool overlap(const Mode& a, const Mode& b, glm::dvec3 camera_m, double pixel) {
    const auto bearing = [&](const Mode& m) { return m.has_depth ? glm::normalize(m.place - camera_m) : m.place; };
    const double reach = std::sin(cone_half_angle(a.angle_sr)) + std::sin(cone_half_angle(b.angle_sr)) + pixel;
    return glm::distance(bearing(a), bearing(b)) <= reach;
}

std::vector<Mode> modes_of(const std::vector<Shining>& list, glm::dvec3 camera_m, double pixel,
                           const LightFinding& settings) {
    std::vector<Mode> all, kept;
    const size_t seeds = std::min(list.size(), kSeeds);
    for (size_t i = 0; i < seeds; ++i) {
        const Shining& seed = list[i * list.size() / seeds];
        const bool has_depth = seed.point_m.has_value();
        all.push_back(shifted(list, seed.place(), has_depth, bandwidth(settings, has_depth)));
    }
    std::stable_sort(all.begin(), all.end(), [](const Mode& a, const Mode& b) { return a.mass > b.mass; });
    for (const Mode& mode : all) {
        const bool known = std::any_of(kept.begin(), kept.end(), [&](const Mode& k) {
            const bool near = k.has_depth == mode.has_depth && glm::distance(k.place, mode.place) <= mode.reach;
            return near || overlap(k, mode, camera_m, pixel);
        });
        if (!known) kept.push_back(mode);
    }
    std::vector<Mode> apart;
    for (const Mode& mode : kept) {
        const Mode whole = grown(list, mode, camera_m);
        const bool covered = std::any_of(apart.begin(), apart.end(), [&](const Mode& a) {
            return a.has_depth == whole.has_depth && glm::distance(a.place, whole.place) <= a.reach;
        });
        if (!covered) apart.push_back(whole);
    }
    return apart;
}

Sighting measured(const std::vector<Shining>& list, const std::vector<Mode>& modes, const Mode& mode,
                  glm::dvec3 camera_m) {
    const glm::dvec3 toward = mode.has_depth ? glm::normalize(mode.place - camera_m) : mode.place;
    const double reach = mode.has_depth ? mode.reach / glm::distance(mode.place, camera_m) : mode.reach;
    const auto near = [&](const Shining& s, const Mode& m) {
        return m.has_depth && s.point_m && glm::distance(*s.point_m, m.place) <= m.reach;
    };
    Sighting out;
    out.has_depth = mode.has_depth;
    out.whole = true;
    glm::dvec3 light(0), pull(0);
    double pixels_sr = 0;
    for (const Shining& s : list) {
        const bool another =
            !near(s, mode) && std::any_of(modes.begin(), modes.end(), [&](const Mode& m) { return near(s, m); });
        if (glm::distance(s.bearing, toward) > reach || another) continue;
        light += s.radiance * s.angle_sr;
        pixels_sr += s.angle_sr;
        pull += s.bearing * s.mass();
        out.whole = out.whole && !s.at_border;
    }
    out.bearing = glm::normalize(pull);

    const double core_chord = 0.5 * std::sqrt(pixels_sr / std::numbers::pi);
    glm::dvec3 core(0);
    double core_sr = 0, range_m = 0, range_sr = 0;
    for (const Shining& s : list) {
        if (glm::distance(s.bearing, out.bearing) > core_chord) continue;
        core += s.radiance * s.angle_sr;
        core_sr += s.angle_sr;
        if (!near(s, mode)) continue;
        range_m += s.range_m * s.angle_sr;
        range_sr += s.angle_sr;
    }
    const glm::dvec3 luminance(0.2126, 0.7152, 0.0722);
    out.solid_angle_sr = glm::dot(light, luminance) / (glm::dot(core, luminance) / core_sr);
    if (!mode.has_depth) {
        out.intensity = light;
        return out;
    }
    // The surface of a sphere, averaged over the inner half of its disc, lies this much before its centre.
    const double bulge = 2.0 / 3 * (1 - std::pow(0.75, 1.5)) / 0.25;
    const double sine = std::sin(cone_half_angle(out.solid_angle_sr));
    const double distance_m = range_m / range_sr / (1 - bulge * sine);
    out.radius_m = distance_m * sine;
    out.center_m = camera_m + distance_m * out.bearing;
    out.intensity = light / out.solid_angle_sr * std::numbers::pi * out.radius_m * out.radius_m;
    return out;
}

}  // namespace

std::vector<Sighting> find_lights(const Image<glm::vec3>& color, const Image<float>& depth_m, const Intrinsics& camera,
                                  const RigidTransform& world_from_camera, const LightFinding& settings) {
    const std::vector<Shining> list = shining_pixels(color, depth_m, camera, world_from_camera, settings);
    const glm::dvec3 camera_m(world_from_camera[3]);
    const std::vector<Mode> modes = modes_of(list, camera_m, 1 / camera.fx, settings);
    std::vector<Sighting> sightings;
    for (const Mode& mode : modes) sightings.push_back(measured(list, modes, mode, camera_m));
    return sightings;
}

}  // namespace patina::reference
