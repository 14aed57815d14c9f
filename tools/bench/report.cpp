#include "tools/bench/report.h"

namespace patina::bench {

nlohmann::ordered_json to_json(const Distribution& d) {
    return {{"count", d.count}, {"min", d.min}, {"median", d.median}, {"p90", d.p90}};
}

Report::Report(const vulkan::DeviceCaps& caps) {
    print("{}, {}\n", caps.name, caps.driver);
    json = {{"device", caps.name}, {"driver", caps.driver}};
}

void Report::table(const std::string& title, const std::vector<Row>& rows) {
    print("{:<36} {:>10} {:>10} {:>10}\n", title, "min", "median", "90 %");
    for (const auto& [name, ms] : rows) {
        print("{:<36} {:>10.4f} {:>10.4f} {:>10.4f}\n", name, ms.min, ms.median, ms.p90);
        json["ms"][name] = to_json(ms);
    }
}

void Report::difference(const std::string& name, const Distribution& with, const Distribution& without) {
    const float ms = (with.median - without.median) / 2;
    print("{:<36} {:>10.4f} ms on two cores, from the medians' difference\n", name, ms);
    json["two_cores_ms"][name] = ms;
}

}  // namespace patina::bench
