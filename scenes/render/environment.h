#pragma once

#include <filesystem>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina::scenes {

// Environments are latitude-longitude pictures of radiance as scene.h describes them. A direction's azimuth is 0 at +z
// and grows towards +x; its elevation is above the horizon.

/// The same light from everywhere.
struct UniformEnvironment {
    glm::vec3 radiance{1};
};

/// A clear sky above plain ground, and a sun.
struct SkyEnvironment {
    glm::vec3 zenith{0.25f, 0.45f, 0.9f};
    glm::vec3 horizon{0.8f, 0.85f, 0.9f};
    glm::vec3 ground{0.2f, 0.18f, 0.15f};
    glm::vec3 sun_irradiance{3.0f, 2.8f, 2.4f};  ///< on a surface that faces the sun
    float sun_azimuth_rad = 0.8f;
    float sun_elevation_rad = 0.9f;
    float sun_radius_rad = 0.03f;  ///< of its disc; at least two texels
};

/// A soft box: a bright rectangle whose sides run along azimuth and elevation, seen from the origin.
struct SoftBox {
    float azimuth_rad = 0;
    float elevation_rad = 0.6f;
    glm::vec2 half_size_rad{0.3f, 0.2f};
    glm::vec3 radiance{10};
};

/// A dark room with soft boxes.
struct StudioEnvironment {
    glm::vec3 walls{0.05f};
    std::vector<SoftBox> boxes;
};

/// The unit direction in the world of a place in an environment's picture, in pixels from its top left corner.
glm::vec3 direction_of(glm::vec2 place_px, Extent2D extent);

/// The mean radiance over all directions.
glm::vec3 mean_radiance(const Image<glm::vec3>& environment);

/// Draws an environment; extents twice as wide as high are usual. The sun's disc takes the pixels whose centres it
/// covers (the nearest one, if none), with the radiance that makes its irradiance exact.
Image<glm::vec3> draw_environment(const UniformEnvironment& uniform, Extent2D extent);
Image<glm::vec3> draw_environment(const SkyEnvironment& sky, Extent2D extent);
Image<glm::vec3> draw_environment(const StudioEnvironment& studio, Extent2D extent);

/// Reads an environment from a Radiance (.hdr) or OpenEXR (.exr) file, as it is. Throws Error when the file is missing,
/// damaged, of another kind, or holds a value that is negative or not finite.
Image<glm::vec3> read_environment(const std::filesystem::path& file);

}  // namespace patina::scenes
