#pragma once

#include <span>
#include <string>

#include "tools/report/report_page.h"
#include "tools/report/run_summary.h"

namespace patina {

/// The text of report.html: what a person wants to know of a run, in one file that needs no other and no network. Reads
/// in light and dark themes and on paper. `pictures` may be empty.
std::string report_html(const RunSummary& summary, std::span<const ReportPicture> pictures);

}  // namespace patina
