#include <sstream>

#include "engine/core/printable.h"
#include "sensor/files/text_file.h"
#include "sensor/inspect.h"
#include "sensor/report_lines.h"

namespace patina::sensor {
namespace {

constexpr size_t kListedSkips = 10;

std::string percent(double share) { return fixed(100 * share, 1) + " %"; }

std::string color_line(const ColorStatistics& color) {
    const int digits = color.linear ? 4 : 1;
    return text("mean ", fixed(color.mean.r, digits), " ", fixed(color.mean.g, digits), " ",
                fixed(color.mean.b, digits),
                color.linear ? " (linear)" : text(" of 255, ", percent(color.clipped_share), " clipped"));
}

std::string depth_line(const DepthStatistics& depth) {
    return text("median ", fixed(depth.median_m, 3), " m, 5 % below ", fixed(depth.p5_m, 3), " m, 95 % below ",
                fixed(depth.p95_m, 3), " m, ", percent(depth.valid_share), " valid");
}

std::string pose_line(const SequenceReport& report) {
    const PoseStatistics& poses = report.poses;
    if (poses.frames == 0) return "none";
    return text(poses.frames, " of ", report.usable_frames, " frames, path ", fixed(poses.path_length_m, 2),
                " m, largest step ", fixed(1000 * poses.translation_m.value, 1), " mm and ",
                fixed(poses.rotation_deg.value, 2), " degrees, worst rotation defect ", poses.worst_defect);
}

}  // namespace

std::string format_report(const SequenceReport& report) {
    const SequenceInfo& info = report.info;
    std::ostringstream out;
    const auto line = [&](const char* label, const std::string& value) { out << label << printable(value) << "\n"; };
    line("sequence      ", text(info.name, " (", info.format, ")"));
    line("frames        ",
         text(info.frames.value_or(report.usable_frames + static_cast<uint32_t>(report.skipped.size())), ", ",
              report.usable_frames, " usable, ", report.skipped.size(), " skipped"));
    line("time          ", text(fixed(report.duration_s, 2), " s at ", info.fps, " frames/s"));
    line("colour camera ", camera_line(info.color));
    line("              ", offset_line(info.color_from_depth));
    line("depth camera  ", camera_line(info.depth));
    line("              ", depth_units_line(info.metres_per_unit, info.max_metres));
    line("colour        ", color_line(report.color));
    line("depth         ", depth_line(report.depth));
    line("poses         ", pose_line(report));
    for (size_t i = 0; i < std::min(report.skipped.size(), kListedSkips); ++i) {
        line("skipped       ", text("frame ", report.skipped[i].index, ": ", report.skipped[i].reason));
    }
    if (report.skipped.size() > kListedSkips) {
        line("skipped       ", text("and ", report.skipped.size() - kListedSkips, " more"));
    }
    for (const std::string& warning : report.warnings) line("warning       ", warning);
    return out.str();
}

}  // namespace patina::sensor
