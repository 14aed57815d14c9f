#include "tools/report/comparison.h"

#include <fmt/format.h>

#include "export/html.h"

namespace patina {

namespace {

// The slider lies over the whole picture and is not seen itself: where the pictures meet is. Its thumb has no width, so
// that the border is where the pointer is. A finger that moves up or down still scrolls the page.
constexpr std::string_view kComparisonStyle = R"css(
.pairs > input { position: absolute; opacity: 0; }
.pairs > label { display: inline-block; margin: 0 .4rem .6rem 0; padding: .1rem .7rem; border: 1px solid var(--line); border-radius: 1rem; color: var(--quiet); font-size: .85rem; cursor: pointer; }
.pairs > input:checked + label { color: var(--text); border-color: var(--bar); font-weight: 600; }
.pairs > input:focus-visible + label { outline: 2px solid var(--bar); outline-offset: 1px; }
.pairs figure { display: none; }
.pair { --at: 50%; position: relative; overflow: hidden; border-radius: 4px; max-height: 80vh; margin: 0 auto; }
.pair img { position: absolute; inset: 0; width: 100%; height: 100%; border-radius: 0; }
.pair .recorded { clip-path: inset(0 calc(100% - var(--at)) 0 0); }
.pair i { position: absolute; top: 0; bottom: 0; left: var(--at); width: 2px; margin-left: -1px; background: #ffffff; box-shadow: 0 0 3px #000000; }
.pair i::after { content: "\2194"; position: absolute; top: 50%; left: 50%; width: 2rem; height: 2rem; margin: -1rem; border-radius: 50%; background: #ffffff; color: #1d2126; box-shadow: 0 0 4px #000000; font: 700 1.1rem/2rem system-ui, sans-serif; text-align: center; }
.pair b { position: absolute; bottom: .5rem; padding: 0 .5rem; border-radius: 3px; background: rgba(0, 0, 0, .6); color: #ffffff; font-size: .8rem; font-weight: 400; }
.pair b:first-of-type { left: .5rem; }
.pair b:last-of-type { right: .5rem; }
.pair input { position: absolute; inset: 0; width: 100%; height: 100%; margin: 0; opacity: 0; cursor: ew-resize; touch-action: pan-y; -webkit-appearance: none; appearance: none; }
.pair input::-webkit-slider-thumb { -webkit-appearance: none; width: 1px; height: 100%; }
.pair input::-moz-range-thumb { width: 1px; height: 100%; border: 0; }
.pair:focus-within { outline: 3px solid var(--bar); outline-offset: 2px; }
)css";

std::string jpeg_url(const std::string& bytes) { return "data:image/jpeg;base64," + base64(bytes); }

std::string choice_html(size_t i, const PicturePair& pair) {
    return fmt::format("<input type='radio' name='pair' id='pair{}'{}><label for='pair{}'>{}</label>\n", i,
                       i == 0 ? " checked" : "", i, html_escaped(pair.caption));
}

std::string pair_html(const PicturePair& pair) {
    const std::string caption = html_escaped(pair.caption);
    const double proportion = static_cast<double>(pair.extent.width) / pair.extent.height;
    return fmt::format(
        "<figure><div class='pair' style='aspect-ratio: {:.4f}; max-width: calc(80vh * {:.4f})'>"
        "<img alt=\"{}: re-rendering\" src=\"{}\"><img class='recorded' alt=\"{}: recorded\" src=\"{}\">"
        "<i aria-hidden='true'></i><b aria-hidden='true'>recorded</b><b aria-hidden='true'>re-rendering</b>"
        "<input type='range' min='0' max='100' value='50' autocomplete='off' aria-label=\"{}: share of the recorded "
        "picture\" "
        "oninput=\"this.parentNode.style.setProperty('--at', this.value + '%')\"></div></figure>\n",
        proportion, proportion, caption, jpeg_url(pair.rendered), caption, jpeg_url(pair.recorded), caption);
}

}  // namespace

std::string comparison_html(std::span<const PicturePair> pairs) {
    if (pairs.empty()) return {};
    std::string html = "<div class='pairs' role='radiogroup' aria-label='Frame'>\n";
    for (size_t i = 0; i < pairs.size(); ++i) html += choice_html(i, pairs[i]);
    for (const PicturePair& pair : pairs) html += pair_html(pair);
    html += "<style>";
    for (size_t i = 0; i < pairs.size(); ++i) {
        html += fmt::format("#pair{}:checked ~ figure:nth-of-type({}){}", i, i + 1, i + 1 < pairs.size() ? ", " : "");
    }
    return html + " { display: block; }</style></div>\n";
}

std::string comparison_style() { return std::string(kComparisonStyle); }

}  // namespace patina
