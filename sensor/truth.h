#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/lighting.h"

namespace patina::sensor {

/// A Ward material (paper, Eq. 2-4).
struct Material {
    uint32_t id = 0;
    std::string name;
    std::optional<glm::dvec3> kd;  ///< RGB albedo; empty where it varies over the surface
    glm::dvec3 ks{0};              ///< RGB albedo
    double alpha = 1;              ///< roughness, in (0, 1]
};

/// Write lights.json and materials.json of the sequence format. `ambient`, the irradiance over pi that every surface
/// receives from all around (linear pixel value), is written where it is not 0, and `windows` as "area" where there are
/// any. Throw Error when the file cannot be written.
void write_lights(const std::filesystem::path& file, std::span<const Light> lights, glm::dvec3 ambient = glm::dvec3(0),
                  std::span<const AreaLight> windows = {});
void write_materials(const std::filesystem::path& file, std::span<const Material> materials);

/// Read what write_lights and write_materials write. Throw Error when the file is missing or no JSON, a
/// member is missing, no finite number, or outside what it may be: an intensity, a radiance or a radius below 0, an
/// axis of 0 or of a sun, a window without area, an id of 0 or another material's, kd or ks outside 0 .. 1, alpha
/// outside (0, 1].
std::vector<Light> read_lights(const std::filesystem::path& file);
glm::dvec3 read_ambient(const std::filesystem::path& file);              ///< 0 where the file has none
std::vector<AreaLight> read_windows(const std::filesystem::path& file);  ///< none where the file has no "area"
std::vector<Material> read_materials(const std::filesystem::path& file);

}  // namespace patina::sensor
