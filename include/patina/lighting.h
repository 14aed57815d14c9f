#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace patina {

/// A lamp: the radiance that arrives at distance r is intensity / r^2, in the sequence's linear pixel values.
struct Light {
    glm::dvec3 position_m{0};  ///< world
    glm::dvec3 intensity{0};   ///< RGB, linear pixel value * m^2
    double radius_m = 0;       ///< of the sphere-shaped lamp that it stands for; 0: a point, or unknown

    bool operator==(const Light&) const = default;
};

/// From this far from the origin on a lamp is a sun: its place tells a direction. Recordings that begin farther than 1
/// km away are moved to the origin, so that their lamps are none. In a reconstruction whose surfaces light each other a
/// sun shines in through what the sky was seen in, such as windows; what was never seen, such as a ceiling, keeps it
/// out.
inline constexpr double kSunsFrom_m = 5000;
inline bool is_sun(const Light& light) { return glm::length(light.position_m) >= kSunsFrom_m; }

/// What lights a room: lamps, and light that arrives everywhere alike.
struct Lighting {
    std::vector<Light> lights;  ///< at most 64
    glm::dvec3 ambient{0};      ///< irradiance over pi that every surface receives, linear pixel value
    std::string found_by =
        "given";  ///< "given", "file", "lighting sequence", "main sequence", "surroundings" or "none"

    bool empty() const { return lights.empty() && ambient == glm::dvec3(0); }
};

/// Reads lights.json of the sequence format. Throws Error when the file is missing or no JSON, a member is missing or
/// no finite number, or an intensity or a radius is below 0.
Lighting read_lighting(const std::filesystem::path& file);

/// Writes lights.json of the sequence format. Throws Error when the file cannot be written.
void write_lighting(const std::filesystem::path& file, const Lighting& lighting);

}  // namespace patina
