#include "tools/report/live_summary.h"

#include <algorithm>

#include <fmt/format.h>

#include "export/html.h"
#include "tools/report/report_page.h"

namespace patina {

namespace {

using Json = nlohmann::ordered_json;

Json latency_json(const LatencySummary& latency) {
    return {{"frames", latency.frames},
            {"median_ms", latency.median_ms},
            {"p95_ms", latency.p95_ms},
            {"max_ms", latency.max_ms}};
}

std::string latency_row(const char* name, const LatencySummary& latency) {
    return fmt::format(
        "<tr><td>{}</td><td class='number'>{}</td><td class='number'>{:.1f}</td><td class='number'>{:.1f}</td>"
        "<td class='number'>{:.1f}</td></tr>\n",
        name, grouped(latency.frames), latency.median_ms, latency.p95_ms, latency.max_ms);
}

}  // namespace

LatencySummary summarised(std::vector<float> latencies_s) {
    if (latencies_s.empty()) return {};
    std::sort(latencies_s.begin(), latencies_s.end());
    const size_t count = latencies_s.size();
    const auto ms = [&](size_t place) { return 1000.0 * static_cast<double>(latencies_s[place]); };
    return {count, ms(count / 2), ms((count * 95 + 99) / 100 - 1), ms(count - 1)};
}

Json live_json(const LiveSummary& live) {
    Json json{{"captured", live.captured},
              {"dropped", live.dropped},
              {"damaged", live.damaged},
              {"lost", live.lost},
              {"seconds", live.seconds},
              {"exposure_to_pose", latency_json(live.pose)},
              {"exposure_to_picture", latency_json(live.picture)}};
    for (const BesideSummary& beside : live.recordings) {
        json["recordings"].push_back({{"file", beside.file},
                                      {"frames", beside.frames},
                                      {"dropped", beside.dropped},
                                      {"bytes", beside.bytes},
                                      {"most_queued_bytes", beside.most_queued_bytes}});
    }
    return json;
}

std::string live_table(const LiveSummary& live) {
    std::string facts = report_fact("Frames captured", grouped(live.captured));
    facts += report_fact("Frames dropped, newer ones were there", grouped(live.dropped));
    if (live.lost > 0) facts += report_fact("Frames lost on the way from the camera", grouped(live.lost));
    facts +=
        report_fact("Frames a second",
                    fmt::format("{:.1f}", live.seconds > 0 ? static_cast<double>(live.captured) / live.seconds : 0.0));
    for (const BesideSummary& beside : live.recordings) {
        facts += report_fact("Recorded to", html_escaped(beside.file));
        facts += report_fact("Frames that the disk did not keep pace with", grouped(beside.dropped));
    }
    return report_facts(facts) +
           report_table(
               "<th>From exposure to</th><th class='number'>Frames</th><th class='number'>Median, ms</th>"
               "<th class='number'>95 %, ms</th><th class='number'>Max, ms</th>",
               latency_row("pose", live.pose) + latency_row("picture", live.picture), "");
}

}  // namespace patina
