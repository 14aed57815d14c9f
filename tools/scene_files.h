#pragma once

#include <string>
#include <vector>

#include "passes/surface/mesh.h"
#include "passes/surface/mesh_reflectance.h"
#include "sensor/truth.h"
#include "tools/export/output_folder.h"
#include "tools/export/run_record.h"
#include "tools/export/write_glb.h"
#include "tools/lights.h"

namespace patina::tools {

/// What a run found out about the scene, for its files: scene.glb, and with reflectance materials.json and lights.json.
/// Lights are in the recording's world in lights.json, in the scene's coordinates in scene.glb.
class SceneFiles {
  public:
    /// `reflectance` is empty where the run has none; `names`: of segments by label.
    SceneFiles(MeshReflectance reflectance, const Illumination& illumination, std::vector<std::string> names);

    /// Writes the files. `mesh` is the one whose reflectance this holds. Throws Error as write_glb() does.
    GlbSummary write(OutputFolder& folder, const Mesh& mesh, const GlbInfo& info) const;

    /// Adds lights and segments to the run's record.
    void tell(RunRecord& record) const;

  private:
    std::vector<sensor::PointLight> world_lights() const;

    MeshReflectance reflectance_;
    std::vector<sensor::PointLight> lights_;  ///< in the scene's coordinates
    glm::dvec3 world_offset_m_, ambient_;
    std::vector<std::string> names_;
};

}  // namespace patina::tools
