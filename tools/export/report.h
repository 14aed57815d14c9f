#pragma once

#include <span>
#include <string>

#include "tools/export/run_record.h"

namespace patina {

/// A picture of the report.
struct ReportPicture {
    std::string caption;
    std::string png;  ///< the bytes of a PNG file
};

/// The text of report.html: what a person wants to know of a run, in one file that needs no other and no network. Reads
/// in light and dark themes and on paper. `pictures` may be empty.
std::string report_html(const RunRecord& record, std::span<const ReportPicture> pictures);

}  // namespace patina
