#include "tools/report/tracking_summary.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "export/html.h"
#include "tools/report/report_page.h"

namespace patina {

namespace {

using Json = nlohmann::ordered_json;

/// Six digits say all there is to say, and keep the file readable.
double rounded(double value) { return std::isfinite(value) ? std::stod(fmt::format("{:.6g}", value)) : value; }

Json frame_json(const TrackedFrame& frame) {
    const TrackingReport& report = frame.report;
    Json json{{"index", frame.index},
              {"state", name_of(report.state)},
              {"share", rounded(report.share)},
              {"sigmas", rounded(report.sigmas)},
              {"shade_error", rounded(report.shade_error)},
              {"least_eigenvalue", rounded(report.least_eigenvalue)},
              {"motion_m", rounded(report.motion_m)},
              {"motion_degrees", rounded(report.motion_degrees)}};
    if (!report.reason.empty()) json["reason"] = report.reason;
    return json;
}

}  // namespace

nlohmann::ordered_json tracking_json(const std::vector<TrackedFrame>& frames) {
    Json json = Json::object();
    for (const TrackingState state : {TrackingState::kTracking, TrackingState::kWeak, TrackingState::kLost}) {
        json[name_of(state)] = std::count_if(frames.begin(), frames.end(),
                                             [&](const TrackedFrame& frame) { return frame.report.state == state; });
    }
    json["frames"] = Json::array();
    for (const TrackedFrame& frame : frames) json["frames"].push_back(frame_json(frame));
    return json;
}

std::vector<TrackingStretch> stretches_of(const std::vector<TrackedFrame>& frames) {
    std::vector<TrackingStretch> stretches;
    for (const TrackedFrame& frame : frames) {
        if (!stretches.empty() && stretches.back().state == frame.report.state) {
            stretches.back().last = frame.index;
        } else {
            stretches.push_back({frame.index, frame.index, frame.report.state, frame.report.reason});
        }
    }
    return stretches;
}

std::string tracking_table(const std::vector<TrackedFrame>& frames) {
    std::string rows;
    for (const TrackingStretch& stretch : stretches_of(frames)) {
        rows += fmt::format("<tr><td class='number'>{}</td><td class='number'>{}</td><td>{}</td><td>{}</td></tr>\n",
                            stretch.first, stretch.last, name_of(stretch.state), html_escaped(stretch.reason));
    }
    if (rows.empty()) return {};
    return report_table(
        "<th class='number'>From frame</th><th class='number'>To frame</th><th>State</th><th>Reason, of the first</th>",
        rows);
}

}  // namespace patina
