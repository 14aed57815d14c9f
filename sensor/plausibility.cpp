#include "sensor/plausibility.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "sensor/files/text_file.h"
#include "sensor/recentred_source.h"

namespace patina::sensor {
namespace {

constexpr double kNearestMedian_m = 0.2, kFarthestMedian_m = 10;  // what depth cameras see of rooms and objects
constexpr double kTypicalMedian_m = 1.5;                          // what a suggested scale aims at
constexpr double kNarrowestView_deg = 20, kWidestView_deg = 120;
constexpr double kFarPrincipalPoint = 0.2;  // of the picture's size, from its centre
constexpr double kNonSquarePixels = 0.05;
constexpr double kImprecisePose = 1e-3;  // twice what poses printed with four digits show
constexpr double kJump_m = 0.5, kJump_deg = 30;

using Warnings = std::vector<std::string>;

void check_scale(const SequenceReport& report, Warnings& warnings) {
    if (report.sampled_frames == 0) return;
    if (report.depth.valid_share == 0) warnings.push_back("no depth picture has a valid reading");
    if (auto implausible = implausible_scale(report)) warnings.push_back(*std::move(implausible));
}

void check_view(const char* name, glm::dvec2 view_deg, Warnings& warnings) {
    const auto [narrow, wide] = std::minmax(view_deg.x, view_deg.y);
    if (narrow < kNarrowestView_deg || wide > kWidestView_deg) {
        warnings.push_back(text("the ", name, " camera's field of view is ", fixed(view_deg.x, 1), " x ",
                                fixed(view_deg.y, 1), " degrees, outside ", kNarrowestView_deg, " to ",
                                kWidestView_deg));
    }
}

void check_intrinsics(const char* name, const Intrinsics& camera, Warnings& warnings) {
    const auto [width, height] = camera.extent;
    const glm::dvec2 centre(0.5 * (width - 1.0), 0.5 * (height - 1.0));
    if (std::abs(camera.cx - centre.x) > kFarPrincipalPoint * width ||
        std::abs(camera.cy - centre.y) > kFarPrincipalPoint * height) {
        warnings.push_back(text("the ", name, " camera's principal point is (", camera.cx, ", ", camera.cy,
                                "), far from the picture's centre (", centre.x, ", ", centre.y, ")"));
    }
    if (std::abs(camera.fx / camera.fy - 1) > kNonSquarePixels) {
        warnings.push_back(
            text("the ", name, " camera's pixels are not square: fx is ", camera.fx, ", fy is ", camera.fy));
    }
}

void check_poses(const SequenceReport& report, Warnings& warnings) {
    const PoseStatistics& poses = report.poses;
    if (report.info.has_poses && poses.frames < report.usable_frames) {
        warnings.push_back(
            text(report.usable_frames - poses.frames, " of ", report.usable_frames, " usable frames have no pose"));
    }
    if (poses.convention) warnings.push_back(*poses.convention);
    if (const glm::dvec3 offset_m = world_offset_m(poses.first_m); offset_m != glm::dvec3(0)) {
        warnings.push_back(text("the first camera is ", fixed(glm::length(poses.first_m) / 1000, 1),
                                " km from the world's origin; a run moves its world by (", fixed(offset_m.x, 0), ", ",
                                fixed(offset_m.y, 0), ", ", fixed(offset_m.z, 0), ") m"));
    }
    if (poses.worst_defect > kImprecisePose) {
        warnings.push_back(
            text("rotations were repaired that are off by up to ", poses.worst_defect, ", more than ", kImprecisePose));
    }
    if (poses.translation_m.value > kJump_m) {
        warnings.push_back(text("the camera jumps by ", fixed(poses.translation_m.value, 2), " m at frame ",
                                poses.translation_m.frame, ", more than ", kJump_m, " m"));
    }
    if (poses.rotation_deg.value > kJump_deg) {
        warnings.push_back(text("the camera turns by ", fixed(poses.rotation_deg.value, 1), " degrees at frame ",
                                poses.rotation_deg.frame, ", more than ", kJump_deg));
    }
}

void check_occurrences(const Occurrences& seen, const char* what, const SequenceReport& report, Warnings& warnings) {
    if (seen.count == 0) return;
    warnings.push_back(
        text(what, " in ", seen.count, " of ", report.usable_frames, " frames, first in frame ", seen.first_frame));
}

}  // namespace

std::optional<std::string> implausible_scale(const SequenceReport& report) {
    const double median_m = report.depth.median_m, metres_per_unit = report.info.metres_per_unit;
    if (report.sampled_frames == 0 || report.depth.valid_share == 0) return std::nullopt;
    if (median_m >= kNearestMedian_m && median_m <= kFarthestMedian_m) return std::nullopt;
    const double fitting = metres_per_unit * std::pow(10, std::round(std::log10(kTypicalMedian_m / median_m)));
    const std::string outside = text("the median depth is ", median_m, " m, outside ", kNearestMedian_m, " to ",
                                     kFarthestMedian_m, " m; if the scale is wrong, ");
    if (report.info.format == "patina-sequence")
        return text(outside, "metres_per_unit may be ", fitting, " instead of ", metres_per_unit, " in sequence.json");
    return text(outside, "the unit of depth may be ", fitting, " m, but the format ", report.info.format,
                " fixes it at ", metres_per_unit, " m; in the native format sequence.json names it");
}

std::vector<std::string> implausibilities(const SequenceReport& report) {
    Warnings warnings;
    if (report.usable_frames == 0) warnings.push_back("no frame is usable");
    check_scale(report, warnings);
    check_view("colour", report.color_view_deg, warnings);
    check_view("depth", report.depth_view_deg, warnings);
    check_intrinsics("colour", report.info.color, warnings);
    check_intrinsics("depth", report.info.depth, warnings);
    check_poses(report, warnings);
    check_occurrences(report.backward_timestamps, "the timestamp is not later than the one before", report, warnings);
    check_occurrences(report.repeated_color, "colour repeats the picture before", report, warnings);
    check_occurrences(report.repeated_depth, "depth repeats the picture before", report, warnings);
    return warnings;
}

}  // namespace patina::sensor
