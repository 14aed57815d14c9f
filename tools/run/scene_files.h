#pragma once

#include <optional>
#include <string>

#include "export/scene_files.h"
#include "patina/scene.h"
#include "tools/report/output_folder.h"
#include "tools/report/report.h"
#include "tools/report/run_summary.h"

namespace patina::tools {

/// A run's scene and its files: scene.glb, and with reflectance materials.json and lights.json. Lights are in the
/// recording's world in lights.json, in the scene's coordinates in scene.glb.
class SceneFiles {
  public:
    /// The scene has no surface: it comes in pieces.
    SceneFiles(Scene scene, const SceneFileOptions& options) : scene_(std::move(scene)), options_(options) {
        options_.environment = kEnvironmentFile;
    }

    /// How fine the texture of scene.glb is to be; empty: it has none.
    void set_texture(const std::optional<TextureOptions>& texture) { options_.texture = texture; }
    const std::vector<SegmentReflectance>& segments() const { return scene_.reflectance.segments; }

    /// Writes materials.json and lights.json, where there are any. Throws Error where the disk refuses.
    void write_lists(OutputFolder& folder) const;
    /// Writes scene.glb, and environment.exr where light arrives from afar; `version`: of Patina. Throws Error as
    /// write_scene_glb() does.
    GlbSummary write_glb(OutputFolder& folder, const GivePieces& pieces, const std::string& version,
                         const BakeTexture& bake);
    /// Writes tiles/ (TileWriter), placed as scene.glb is.
    GlbSummary write_tiles(OutputFolder& folder, const GivePieces& pieces, const std::string& version);

    /// What a report shows of the scene.glb that was written: its surface, and the camera's way. Empty where there is
    /// none. Throws Error where it cannot be read back.
    std::optional<ReportScene> report_scene(const OutputFolder& folder) const;

    /// Adds lights, segments and the place of what was written to the run's summary.
    void add_to(RunSummary& summary) const;

  private:
    Scene scene_;
    SceneFileOptions options_;
    std::optional<GlbInfo> info_;  ///< of what was written; empty where nothing was
};

}  // namespace patina::tools
