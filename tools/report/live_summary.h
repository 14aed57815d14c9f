#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace patina {

/// How long after its exposure something of a frame was there, over all frames that have it.
struct LatencySummary {
    size_t frames = 0;
    double median_ms = 0, p95_ms = 0, max_ms = 0;
};

/// The summary of latencies in seconds; all zero where there are none.
LatencySummary summarised(std::vector<float> latencies_s);

/// What a recording beside a live run holds.
struct BesideSummary {
    std::string file;
    uint64_t frames = 0;   ///< given to it, those that it notes as skipped included
    uint64_t dropped = 0;  ///< the disk did not keep pace
    uint64_t bytes = 0;    ///< of payloads
    uint64_t most_queued_bytes = 0;
};

/// How a live run kept pace with its source: captured is used, skipped and dropped, and those that came after the end.
struct LiveSummary {
    uint64_t captured = 0, dropped = 0, damaged = 0;
    uint64_t lost = 0;                        ///< not among the captured ones (sensor/live/live_source.h)
    double seconds = 0;                       ///< from the first frame to the last
    LatencySummary pose;                      ///< of the frames that were fused
    LatencySummary picture;                   ///< of those that the model was rendered for
    std::vector<BesideSummary> recordings{};  ///< beside it, in the order in which they began
};

/// For run.json.
nlohmann::ordered_json live_json(const LiveSummary& live);

/// For report.html: a table.
std::string live_table(const LiveSummary& live);

}  // namespace patina
