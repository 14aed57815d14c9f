#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina {

/// The string attribute of a run's frames/NNNNNN.exr that holds the id which `run.json` has as "id". A run's id is made
/// of what it was given and of what it wrote, so that runs that did the same have the same, and others another.
inline constexpr const char* kRunIdAttribute = "patina.run";

/// One float channel of a picture in memory, which must outlive the list that names it.
struct ExrChannel {
    std::string name;  ///< as in the file, "rgb.R"
    Extent2D extent;
    const float* first = nullptr;  ///< row by row from the top left pixel
    size_t step = 1;               ///< floats from one pixel to the next
};

/// The channels of one picture, under names the OpenEXR way: a scalar is `name`; a vector is `name` with .R .G .B for
/// colours or .X .Y .Z for directions.
ExrChannel scalar_channel(const std::string& name, const Image<float>& image);
std::vector<ExrChannel> rgb_channels(const std::string& name, const Image<glm::vec3>& image);
std::vector<ExrChannel> xyz_channels(const std::string& name, const Image<glm::vec3>& image);

/// Writes one multi-channel OpenEXR: float32, ZIP compressed. The file lists channels by name, whatever order they are
/// given in. The same pixels give the same bytes. `run_id` is that of the run in whose folder the file will be, see
/// tools/report/run_id.h; empty: the file has none. Throws Error for no channel, an empty picture, extents that differ,
/// a name given twice, or a disk that refuses.
void write_exr(const std::filesystem::path& path, std::span<const ExrChannel> channels, const std::string& run_id = {});

/// What one colour camera sees, of a run's model or of the truth; all pictures have one extent. Groups that are empty
/// are left out of the file.
struct FrameDump {
    Image<glm::vec3> rgb;     ///< linear; of a model with reflectance: as kd, ks and alpha give it
    Image<float> depth_m;     ///< along the camera's z axis; 0 where nothing was hit
    Image<glm::vec3> normal;  ///< world, unit length; zero where nothing was hit
    Image<float> valid;       ///< 1 where something was hit, else 0

    Image<glm::vec3> kd{};           ///< diffuse albedo
    Image<glm::vec3> ks{};           ///< specular albedo
    Image<float> alpha{};            ///< roughness
    Image<glm::vec3> kd_segment{};   ///< diffuse albedo of the whole segment: before refinement
    Image<glm::vec3> rgb_segment{};  ///< rgb as kd_segment gives it
    Image<glm::vec3> kd_shown{};     ///< what a user is shown as kd: with detail restored from the fused colour
    Image<glm::vec3> rgb_shown{};    ///< and as rgb: likewise, and the fused colour where nothing else is known
    Image<float> label{};            ///< segment or object, a whole number; 0 = none
    Image<float> visibility{};  ///< of the lamps' light, the part that shadows leave; 0 where none shines, -1 unknown

    /// What a user is shown, where that is not rgb and kd themselves.
    const Image<glm::vec3>& shown_rgb() const { return rgb_shown.empty() ? rgb : rgb_shown; }
    const Image<glm::vec3>& shown_kd() const { return kd_shown.empty() ? kd : kd_shown; }
};

/// The channels of a frame: rgb.R rgb.G rgb.B depth normal.X normal.Y normal.Z valid, and those of kd, ks, alpha,
/// kd_segment, rgb_segment, kd_shown, rgb_shown, label and visibility that are not empty.
std::vector<ExrChannel> channels_of(const FrameDump& frame);

}  // namespace patina
