#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "export/gltf_material.h"
#include "export/page_picture.h"
#include "patina/image.h"
#include "patina/lighting.h"

namespace patina {

/// What a segment's surface reflects, as scene.glb has it.
struct PartMaterial {
    std::string name;                ///< of the segment
    uint32_t label = 0;              ///< of the segment, 0 for none
    GltfMaterial gltf;               ///< the nearest glTF material
    bool has_reflectance = false;    ///< false: base colours are the recording's, with its light
    bool observed = false;           ///< the gloss is more than a guess
    std::optional<WardGloss> gloss;  ///< exact; empty: there is not even a guess

    /// Diffuse albedo over base colour. 0 of metals, whose diffuse part is next to nothing.
    float kd_over_base() const {
        if (!has_reflectance) return 1;
        return gltf.metal ? 0 : kd_of(gltf, glm::vec3(1)).r;
    }
};

/// A piece of a scene's surface with one material that lies in one page of the texture, or in none.
struct ScenePart {
    static constexpr uint32_t kNoPage = UINT32_MAX;

    size_t material = 0;  ///< of SceneParts::materials
    uint32_t page = kNoPage;
    std::vector<glm::vec3> positions_m;  ///< in glTF's axes: y is up, the floor at 0
    std::vector<glm::vec3> normals;      ///< unit length
    std::vector<glm::vec3> base;         ///< by vertex, linear base colour; empty where the part lies in a page
    std::vector<glm::vec2> places;       ///< by vertex, 0 to 1 from the page's top left corner; empty without a page
    std::vector<std::array<uint32_t, 3>> triangles;
};

/// A finished scene as its scene.glb holds it: what other formats are written from.
struct SceneParts {
    std::string name;
    std::vector<PartMaterial> materials;
    std::vector<ScenePart> parts;
    std::vector<EncodedPicture> pages;  ///< of the texture: base colours, sRGB
    std::vector<Light> lights;          ///< in glTF's axes; intensity in linear pixel values times square metre
    double candela_per_intensity = 1;
    std::vector<AreaLight> windows;  ///< in glTF's axes
    glm::dvec3 ambient{0};           ///< as Lighting::ambient; no glTF holds it
    /// The picture of light from afar that the file names; empty: it names none. read_environment() reads it.
    std::string environment_file;
    double luminance_per_pixel_value = 1;          ///< of that picture (GlbEnvironment)
    glm::dquat environment_from_gltf{1, 0, 0, 0};  ///< the picture's axes from glTF's
    Image<glm::vec3> environment;                  ///< radiance, linear pixel values; empty: not read, or none

    /// cd/m^2 of the linear pixel value 1, of windows: lamps and light from afar have one scale.
    double luminance_per_radiance() const { return lights.empty() ? luminance_per_pixel_value : candela_per_intensity; }
    uint64_t triangles() const;
    uint64_t vertices() const;
};

/// Reads the scene.glb of a run. Throws Error, naming the file, where it is missing, damaged, or not Patina's.
SceneParts read_scene_parts(const std::filesystem::path& file);

/// Reads the environment that stands in a folder, where the scene names one and it is there. Throws Error where it is
/// damaged.
void read_environment(SceneParts& scene, const std::filesystem::path& folder);

/// The surface's colours by vertex: base colours, of parts in a page those of the texel there.
std::vector<std::vector<glm::vec3>> base_colors(const SceneParts& scene);

/// The lowest and highest corner of the box around all parts; both zero without a vertex.
std::array<glm::vec3, 2> bounds_of(const SceneParts& scene);

}  // namespace patina
