#include "tools/report/verdict.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "export/gltf_material.h"

namespace patina {

namespace {

constexpr uint32_t kLeastVoxels = 10;
constexpr double kLeastShare = 1e-3;  // of the observed voxels
constexpr double kEnoughFrames = 0.9, kEnoughTexels = 0.85, kGoodScore_db = 25;

uint64_t total_of(const RunSummary& summary, std::string_view name) {
    const auto found = std::ranges::find(summary.totals, name, [](const auto& total) { return total.first; });
    return found == summary.totals.end() ? 0 : found->second;
}

double share_of(double part, double whole) { return whole > 0 ? part / whole : 0; }

void judge_frames(const RunSummary& summary, Verdict& verdict) {
    const uint64_t frames = summary.sequence.frames.value_or(summary.frames.read);
    const uint64_t due = frames - std::min(frames, summary.frames.repeated + summary.frames.undone);
    if (due == 0) return;
    const std::string used = fmt::format("{} of {} frames were used", summary.frames.used, due);
    if (share_of(static_cast<double>(summary.frames.used), static_cast<double>(due)) >= kEnoughFrames) {
        verdict.good.push_back(used + ".");
    } else {
        verdict.unknown.push_back(used + ": what the others show is missing.");
    }
}

void judge_tracking(const RunSummary& summary, Verdict& verdict) {
    if (summary.tracking.empty()) return;
    const auto lost = std::ranges::count_if(
        summary.tracking, [](const TrackedFrame& frame) { return frame.report.state == TrackingState::kLost; });
    if (lost == 0) {
        verdict.good.push_back("The camera was tracked in every frame.");
    } else {
        verdict.unknown.push_back(fmt::format(
            "The camera was lost in {} of {} frames: move more slowly there, and keep edges and corners in sight.",
            lost, summary.tracking.size()));
    }
}

void judge_texture(const RunSummary& summary, Verdict& verdict) {
    const auto seen = static_cast<double>(total_of(summary, "texels that a picture showed"));
    const auto filled = static_cast<double>(total_of(summary, "texels that no picture showed"));
    if (seen + filled == 0) return;
    const double share = seen / (seen + filled);
    const std::string sentence = fmt::format("{:.0f} % of the surface has its colour from pictures", 100 * share);
    if (share >= kEnoughTexels) {
        verdict.good.push_back(sentence + ".");
    } else {
        verdict.unknown.push_back(sentence + "; the rest is filled in from around: let the camera see it.");
    }
}

/// Segments that are large enough for a person to see an object in them.
std::vector<SegmentReflectance> objects_of(const RunSummary& summary) {
    uint64_t voxels = 0;
    for (const SegmentSummary& segment : summary.segments) voxels += segment.reflectance.voxels;
    std::vector<SegmentReflectance> objects;
    for (const SegmentSummary& segment : summary.segments) {
        const double share = share_of(segment.reflectance.voxels, static_cast<double>(voxels));
        if (segment.reflectance.voxels >= kLeastVoxels && share >= kLeastShare) objects.push_back(segment.reflectance);
    }
    return objects;
}

void judge_albedo(const std::vector<SegmentReflectance>& objects, Verdict& verdict) {
    const auto missing = std::ranges::count_if(objects, [](const SegmentReflectance& object) { return !object.kd; });
    if (missing > 0) {
        verdict.unknown.push_back(
            fmt::format("The diffuse albedo of {} of {} objects was not observed: stay on them longer, or come nearer.",
                        missing, objects.size()));
    } else if (!objects.empty()) {
        verdict.good.push_back(fmt::format("The diffuse albedo of all {} objects is known.", objects.size()));
    }
}

/// Without lamps there is none to observe, which judge_lamps() says.
void judge_gloss(const std::vector<SegmentReflectance>& objects, Verdict& verdict) {
    const auto observed = static_cast<size_t>(std::ranges::count_if(objects, gloss_is_observed));
    if (observed > 0)
        verdict.good.push_back(fmt::format("Gloss was observed on {} of {} objects.", observed, objects.size()));
    if (observed < objects.size()) {
        verdict.unknown.push_back(
            fmt::format("Gloss of {} of {} objects was not observed: walk round them, so that a lamp mirrors in them.",
                        objects.size() - observed, objects.size()));
    }
}

void judge_lamps(const RunSummary& summary, Verdict& verdict) {
    if (!summary.lamps.empty()) {
        verdict.good.push_back(summary.lamps.size() == 1 ? "One lamp is known."
                                                         : fmt::format("{} lamps are known.", summary.lamps.size()));
    }
    if (!summary.materials_missing.empty()) {
        verdict.unknown.push_back(summary.materials_missing);
    } else if (summary.lamps.empty() && !summary.segments.empty()) {
        verdict.unknown.push_back("No lamp is known, so that no gloss could be observed: give lights, or record them.");
    }
}

void judge_held_out(const RunSummary& summary, Verdict& verdict) {
    if (!summary.held_out || summary.held_out->pictures == 0) return;
    const PictureScore& score = summary.held_out->reflectance.value_or(summary.held_out->mean_color);
    const std::string sentence = fmt::format("Pictures that were held out are predicted with {:.1f} dB (median of {})",
                                             score.psnr_srgb_db, summary.held_out->pictures);
    if (score.psnr_srgb_db >= kGoodScore_db) {
        verdict.good.push_back(sentence + ".");
    } else {
        verdict.unknown.push_back(fmt::format("{}; {:.0f} dB are good.", sentence, kGoodScore_db));
    }
}

}  // namespace

bool gloss_is_observed(const SegmentReflectance& segment) { return segment.gloss && is_observed(*segment.gloss); }

Verdict verdict_of(const RunSummary& summary) {
    const std::vector<SegmentReflectance> objects = objects_of(summary);
    Verdict verdict;
    judge_frames(summary, verdict);
    judge_tracking(summary, verdict);
    judge_texture(summary, verdict);
    judge_lamps(summary, verdict);
    judge_albedo(objects, verdict);
    if (!summary.lamps.empty()) judge_gloss(objects, verdict);
    judge_held_out(summary, verdict);
    return verdict;
}

}  // namespace patina
