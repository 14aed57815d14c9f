#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "patina/image.h"
#include "tools/program/outcome.h"
#include "tools/program/sequence_options.h"

namespace patina::tools {

/// What a rendered picture shows of the surface.
enum class Show {
    kRgb,      ///< the re-rendering; without reflectance the fused colours
    kKd,       ///< diffuse albedo
    kNormals,  ///< world normals
    kLabels    ///< segments
};

/// What `patina render` was asked to do.
struct RenderOptions : SequenceOptions {
    std::filesystem::path out;       ///< folder for NNNNNN.png; empty: none
    std::filesystem::path video;     ///< .avi or .mp4; empty: none
    uint32_t orbit = 0;              ///< views once around the model; 0: no orbit
    double orbit_seconds = 0;        ///< how long the video takes for them; 0: at the sequence's rate
    std::filesystem::path poses;     ///< trajectory.txt of the views, like a sequence's; empty: the recorded poses
    std::optional<Extent2D> extent;  ///< of the pictures; empty: the colour camera's
    /// lights.json, or an environment as .hdr or .exr, of the views; empty: the light of the reconstruction
    std::vector<std::filesystem::path> relight{};
    double relight_turn_deg = 0;  ///< of that environment about up
    Show show = Show::kRgb;
    float exposure = 1;  ///< what radiance is multiplied with
};

/// Reconstructs a sequence and renders views of it, as pictures (8-bit sRGB, clipped) and as a video; both appear whole
/// or not at all. Lens distortion is left out. Returns what the reconstruction falls short of. Throws Error for
/// whatever stops it, Interrupted when the user does.
Outcome render(const RenderOptions& options);

}  // namespace patina::tools
