#pragma once

#include <string>

#include "tools/report/run_summary.h"

namespace patina {

/// Parts of report.html for those who want all of it: tables, as markup. Each is empty where there is nothing to show.
std::string facts_list(const RunSummary& summary);
std::string pass_table(const std::vector<PassTime>& passes);
std::string memory_table(const std::vector<MemorySummary>& pools);
std::string light_table(const std::vector<Light>& lights);
std::string segment_table(const std::vector<SegmentSummary>& segments);
std::string skipped_table(const std::vector<Skipped>& skipped);
std::string settings_text(const nlohmann::ordered_json& settings);

}  // namespace patina
