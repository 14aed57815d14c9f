#include "reconstruction/session/shortfalls.h"

#include <algorithm>

#include <fmt/format.h>

namespace patina {

namespace {

constexpr double kLeastFramesUsed = 0.9;

/// Of the frames that had their turn: a run that ended before its time says so itself.
std::string unused_frames(const sensor::Ledger& ledger) {
    const size_t tried = ledger.used() + ledger.skipped().size();
    if (ledger.used() >= kLeastFramesUsed * static_cast<double>(tried)) return "";
    return fmt::format("only {} of {} frames were used; the first was left out because: {}", ledger.used(), tried,
                       ledger.skipped().front().reason);
}

}  // namespace

std::string lost_for_good(const std::vector<TrackedFrame>& tracked) {
    if (tracked.empty() || tracked.back().report.state != TrackingState::kLost) return "";
    const auto found = std::find_if(tracked.rbegin(), tracked.rend(), [](const TrackedFrame& frame) {
        return frame.report.state == TrackingState::kTracking;
    });
    const TrackedFrame& first = *found.base();
    const auto count = found - tracked.rbegin();
    return fmt::format("tracking was lost at frame {} and not found again: {}; the last {} left out", first.index,
                       first.report.reason, count == 1 ? "frame is" : fmt::format("{} frames are", count));
}

std::vector<std::string> refusals(SessionCore& session) {
    std::vector<std::string> list;
    Pipeline& pipeline = session.pipeline();
    for (const PoolState& pool : session.pools()) {
        if (!pool.is_full()) continue;
        list.push_back(full_pool_warning(pool) +
                       (pool.limit == PoolLimit::kSetting ? fmt::format("; raise {}", pool.setting) : ""));
    }
    if (const uint32_t refused = pipeline.counters().map.refused_samples; refused > 0)
        list.push_back(fmt::format("the voxel table was full: {} ray samples were left out", refused));
    return list;
}

std::vector<std::string> shortfalls_of(SessionCore& session) {
    std::vector<std::string> list = refusals(session);
    if (std::string lost = lost_for_good(session.tracked()); !lost.empty()) list.push_back(std::move(lost));
    if (std::string unused = unused_frames(session.ledger()); !unused.empty()) list.push_back(std::move(unused));
    if (!session.checkpoint_problem().empty()) list.push_back(session.checkpoint_problem());
    list.insert(list.end(), session.shortfalls().begin(), session.shortfalls().end());
    return list;
}

std::vector<std::string> warnings(SessionCore& session) {
    std::vector<std::string> list = session.warnings();
    const gpu::MapCounters counters = session.pipeline().counters().map;
    if (counters.outside_samples > 0) {
        list.push_back(
            fmt::format("{} ray samples lay outside the volume that block keys can express around the first camera",
                        counters.outside_samples));
    }
    return list;
}

}  // namespace patina
