#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "export/rewrite_glb.h"
#include "tools/program/outcome.h"

namespace patina::tools {

/// What is written of a scene.
enum class SceneFormat { kGlb, kPly, kPoints, kObj, kUsdz, kLights, kHtml };

/// A file to write.
struct SceneOutput {
    SceneFormat format;
    std::filesystem::path file;
};

/// What the ending of a name asks for: .glb, .ply, .obj, .usdz, .exr, .html. Throws Error for another.
SceneFormat format_by_ending(const std::filesystem::path& file);

/// A finished scene, and what to write of it.
struct ExportSceneOptions {
    std::filesystem::path source;  ///< a run's folder, or a scene.glb
    std::vector<SceneOutput> outputs;
    GlbChanges changes;                ///< of the scene before it is written
    std::optional<glm::dvec3> from_m;  ///< where lights are seen from, in glTF's axes; empty: amid the surface
    bool lods = false;                 ///< levels of detail beside each GLB
    bool quiet = false;
};

/// Coarser levels of a GLB, each in a file of its own: with down to a quarter of the triangles of the one before, as
/// far as collapse() gets, and texture pages of half its resolution.
inline constexpr uint32_t kLods = 2;

/// The file of a level from 1 on, beside that of the GLB: room_lod1.glb beside room.glb.
std::filesystem::path lod_file(const std::filesystem::path& glb, uint32_t level);

/// Writes a scene's files, each whole or not at all. Throws Error where the scene cannot be read or a file written.
Outcome export_scene(const ExportSceneOptions& options);

/// The scene.glb of a run's folder, or the file itself. Throws Error where there is none.
std::filesystem::path scene_at(const std::filesystem::path& source);

}  // namespace patina::tools
