#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace patina {

/// A picture of a report.
struct ReportPicture {
    std::string caption;
    std::string png;  ///< the bytes of a PNG file
};

/// The parts that Patina's reports are made of. "html" says that a parameter is markup and used as it is; all other
/// text is escaped.

/// A whole page: one file that needs no other and no network, in light and dark themes and on paper. `style` is CSS
/// after the common rules; it may use their variables --ground, --text, --quiet, --line, --bar, --range, --warn.
std::string report_page(std::string_view title, std::string_view body_html, std::string_view style = {});

/// A headed section, or nothing where there is nothing to show.
std::string report_section(std::string_view title, std::string_view content_html);

/// A list of facts, each a name above its value.
std::string report_fact(std::string_view name, std::string_view value_html);
std::string report_facts(std::string_view facts_html);

/// A table that scrolls by itself where the window is too narrow. `head_html` is a row of <th>.
std::string report_table(std::string_view head_html, std::string_view rows_html, std::string_view foot_html = {});

/// Warnings, set off from the rest; nothing where there are none.
std::string report_warnings(std::span<const std::string> warnings);

/// Embedded pictures with their captions.
std::string report_figures(std::span<const ReportPicture> pictures);

/// A count with thin spaces between groups of three digits, as markup.
std::string grouped(uint64_t value);

}  // namespace patina
