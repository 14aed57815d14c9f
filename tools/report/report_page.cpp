#include "tools/report/report_page.h"

#include <fmt/format.h>

#include "export/html.h"

namespace patina {
namespace {

constexpr std::string_view kPageStyle = R"css(
:root { --ground: #ffffff; --text: #1d2126; --quiet: #5d6670; --line: #d9dde2; --bar: #2f6fb5; --range: #a9c5e3; --warn: #9a4d00; --warn-ground: #fff4e3; }
@media (prefers-color-scheme: dark) {
  :root { --ground: #16191d; --text: #e3e6ea; --quiet: #98a2ad; --line: #333a42; --bar: #6aa9ea; --range: #34506d; --warn: #ffbe73; --warn-ground: #33260f; }
}
@media print {
  :root { --ground: #ffffff; --text: #000000; --quiet: #444444; --line: #bbbbbb; --bar: #2f6fb5; --range: #a9c5e3; --warn: #000000; --warn-ground: #ffffff; }
  body { max-width: none; padding: 0; }
  figure, tr, dl > div { break-inside: avoid; }
  h2 { break-after: avoid; }
  svg { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 72rem; padding: 1.5rem; background: var(--ground); color: var(--text); font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; margin: 2.2rem 0 .6rem; border-bottom: 1px solid var(--line); padding-bottom: .2rem; }
p.quiet, figcaption { color: var(--quiet); }
p.quiet { margin: .3rem 0 0; }
dl { display: grid; grid-template-columns: repeat(auto-fill, minmax(13rem, 1fr)); gap: .8rem 1.5rem; margin: 1.4rem 0 0; }
dt { color: var(--quiet); font-size: .85rem; }
dt::first-letter { text-transform: uppercase; }
dd { margin: 0; font-weight: 600; overflow-wrap: anywhere; }
figure { margin: 0 0 1rem; }
figure img { display: block; width: 100%; height: auto; border-radius: 4px; }
figcaption { font-size: .85rem; margin-top: .25rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .8rem .25rem 0; text-align: left; border-bottom: 1px solid var(--line); vertical-align: middle; }
th { color: var(--quiet); font-weight: 400; font-size: .85rem; }
.number { text-align: right; white-space: nowrap; }
td.bar { width: 35%; min-width: 8rem; padding-right: 0; }
td.bar svg { display: block; width: 100%; height: .8rem; }
rect.value { fill: var(--bar); }
rect.range { fill: var(--range); }
tfoot td { border-bottom: 0; font-weight: 600; }
.warnings { background: var(--warn-ground); color: var(--warn); border-left: 4px solid var(--warn); padding: .6rem 1rem .6rem 2rem; margin: 0; }
pre { overflow-x: auto; font-size: .85rem; border: 1px solid var(--line); border-radius: 4px; padding: .8rem; margin: 0; }
)css";

}  // namespace

std::string report_page(std::string_view title, std::string_view body_html, std::string_view style) {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{} &middot; Patina</title>\n"
        "<style>{}{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
        html_escaped(title), kPageStyle, style, body_html);
}

std::string report_section(std::string_view title, std::string_view content_html) {
    if (content_html.empty()) return {};
    return fmt::format("<h2>{}</h2>\n{}\n", html_escaped(title), content_html);
}

std::string report_fact(std::string_view name, std::string_view value_html) {
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", html_escaped(name), value_html);
}

std::string report_facts(std::string_view facts_html) { return fmt::format("<dl>\n{}</dl>\n", facts_html); }

std::string report_table(std::string_view head_html, std::string_view rows_html, std::string_view foot_html) {
    return fmt::format("<div class='scroll'><table>\n<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody>\n{}</table></div>",
                       head_html, rows_html, foot_html);
}

std::string report_warnings(std::span<const std::string> warnings) {
    if (warnings.empty()) return {};
    std::string html = "<ul class='warnings'>\n";
    for (const std::string& warning : warnings) html += "<li>" + html_escaped(warning) + "</li>\n";
    return html + "</ul>";
}

std::string report_figures(std::span<const ReportPicture> pictures) {
    std::string html;
    for (const ReportPicture& picture : pictures) {
        const std::string caption = html_escaped(picture.caption);
        html += fmt::format(
            "<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n", caption,
            base64(picture.png), caption);
    }
    return html;
}

std::string grouped(uint64_t value) {
    std::string digits = fmt::format("{}", value);
    for (size_t end = digits.size(); end > 3; end -= 3) digits.insert(end - 3, "&#8239;");
    return digits;
}

}  // namespace patina
