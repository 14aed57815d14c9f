#pragma once

#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "export/scene_parts.h"
#include "tools/report/comparison.h"
#include "tools/report/report_page.h"
#include "tools/report/run_summary.h"

namespace patina {

/// What a report shows of a finished scene.
struct ReportScene {
    SceneParts parts;
    std::vector<glm::dvec3> path_m;  ///< positions of the camera in glTF's axes, in the order of frames
};

/// The text of report.html: what a person wants to know of a run, in one file that needs no other and no network. First
/// a verdict, then the scene to turn, its materials, a plan; tables are folded away below. Reads in light and dark
/// themes, on a phone and on paper. `pictures` and `pairs` may be empty, `scene` null.
std::string report_html(const RunSummary& summary, std::span<const ReportPicture> pictures,
                        const ReportScene* scene = nullptr, std::span<const PicturePair> pairs = {});

}  // namespace patina
