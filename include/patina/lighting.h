#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace patina {

/// A lamp: the radiance that arrives at distance r is intensity / r^2, in the sequence's linear pixel values. A lamp
/// with an axis is flat, as a panel in a ceiling: its intensity falls with the cosine of the angle to the axis
/// (Lambert), and nothing goes behind it.
struct Light {
    glm::dvec3 position_m{0};  ///< world
    glm::dvec3 intensity{0};   ///< RGB, linear pixel value * m^2; along the axis if there is one
    double radius_m = 0;       ///< of the sphere-shaped lamp that it stands for; 0: a point, or unknown
    glm::dvec3 axis{0};        ///< unit length, to where it shines; 0: it shines alike in all directions, as a sun must

    bool operator==(const Light&) const = default;
};

/// Whether it has an axis.
inline bool is_flat(const Light& light) { return light.axis != glm::dvec3(0); }

/// What a lamp sends towards a point of the world; a flat one nothing to one that it stands in.
inline glm::dvec3 intensity_towards(const Light& light, glm::dvec3 point_m) {
    if (!is_flat(light)) return light.intensity;
    const glm::dvec3 way_m = point_m - light.position_m;
    const double distance_m = glm::length(way_m);
    return distance_m > 0 ? light.intensity * (std::max(glm::dot(light.axis, way_m), 0.0) / distance_m) : glm::dvec3(0);
}

/// A lamp in another world.
inline Light moved(Light light, const glm::dmat4& to_from) {
    light.position_m = glm::dvec3(to_from * glm::dvec4(light.position_m, 1));
    if (is_flat(light)) light.axis = glm::normalize(glm::dmat3(to_from) * light.axis);
    return light;
}

/// A window as a rectangle that shines into the room, as a frosted one would: alike from all of it, and by the cosine
/// to its normal. It is for other programs: a session takes what pictures show of windows, by direction.
struct AreaLight {
    glm::dvec3 center_m{0};               ///< world
    glm::dvec3 half_u_m{0}, half_v_m{0};  ///< from the centre to the middles of two sides; it shines to half_u x half_v
    glm::dvec3 radiance{0};               ///< RGB, linear pixel value
    bool clipped = false;                 ///< pictures show a part of it clipped: its radiance is at least this

    bool operator==(const AreaLight&) const = default;
};

/// The side that it shines to, unit length.
inline glm::dvec3 normal_of(const AreaLight& light) {
    return glm::normalize(glm::cross(light.half_u_m, light.half_v_m));
}

/// From this far from the origin on a lamp is a sun: its place tells a direction. Recordings that begin farther than 1
/// km away are moved to the origin, so that their lamps are none. In a reconstruction whose surfaces light each other a
/// sun shines in through what the sky was seen in, such as windows; what was never seen, such as a ceiling, keeps it
/// out.
inline constexpr double kSunsFrom_m = 5000;
inline bool is_sun(const Light& light) { return glm::length(light.position_m) >= kSunsFrom_m; }

/// What lights a room: lamps, windows, and light that arrives everywhere alike.
struct Lighting {
    std::vector<Light> lights;  ///< at most 64
    glm::dvec3 ambient{0};      ///< irradiance over pi that every surface receives, linear pixel value
    std::string found_by =
        "given";  ///< "given", "file", "lighting sequence", "main sequence", "surroundings" or "none"
    std::vector<AreaLight> windows{};  ///< that a session saw; those of its input it leaves aside

    bool empty() const { return lights.empty() && windows.empty() && ambient == glm::dvec3(0); }
};

/// Reads lights.json of the sequence format. Throws Error when the file is missing or no JSON, a member is missing or
/// no finite number, an intensity, a radiance or a radius is below 0, an axis is 0 0 0 or a sun's, or a window
/// has no area.
Lighting read_lighting(const std::filesystem::path& file);

/// Writes lights.json of the sequence format. Throws Error when the file cannot be written.
void write_lighting(const std::filesystem::path& file, const Lighting& lighting);

}  // namespace patina
