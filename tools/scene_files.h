#pragma once

#include <string>
#include <vector>

#include "passes/model/lights.h"
#include "passes/surface/mesh.h"
#include "passes/surface/mesh_reflectance.h"
#include "sensor/truth.h"
#include "tools/export/output_folder.h"
#include "tools/export/run_record.h"
#include "tools/export/write_glb.h"

namespace patina::tools {

/// What a run found out about the scene, for its files: scene.glb, and with reflectance materials.json and lights.json.
class SceneFiles {
  public:
    /// `reflectance` is empty where the run has none; `names`: of segments by label.
    SceneFiles(MeshReflectance reflectance, const std::vector<PointLight>& lights, glm::vec3 ambient,
               std::vector<std::string> names);

    /// Writes the files. `mesh` is the one whose reflectance this holds. Throws Error as write_glb() does.
    GlbSummary write(OutputFolder& folder, const Mesh& mesh, const GlbInfo& info) const;

    /// Adds lights and segments to the run's record.
    void tell(RunRecord& record) const;

  private:
    MeshReflectance reflectance_;
    std::vector<sensor::PointLight> lights_;
    glm::dvec3 ambient_;
    std::vector<std::string> names_;
};

}  // namespace patina::tools
