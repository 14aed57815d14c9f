#include <fstream>

#include <gmock/gmock.h>

#include "export/page_picture.h"
#include "tests/export/browser.h"
#include "tests/export/full_summary.h"
#include "tests/export/small_scene.h"
#include "tools/report/report.h"

// The report as a browser shows it, where Chromium is installed.

namespace patina::report_browser_test {
namespace {

using testing::HasSubstr;

// What goes wrong in the report, its view included: a frame of its own, whose text the report holds.
constexpr std::string_view kListen =
    "<script>window.failures = []; addEventListener('error', e => "
    "failures.push(e.message));</script>";

// Opens the report as wide as a phone in a light theme, and as wide as a screen in a dark one, and says in its title
// what is wrong with it.
constexpr std::string_view kLook = R"js(<!DOCTYPE html><html><body>
<iframe id="phone" src="report.html" width="390" height="844" style="color-scheme: light"></iframe>
<iframe id="screen" src="report.html" width="1280" height="900" style="color-scheme: dark"></iframe>
<script>
const wrong = [];
const expect = (what, holds) => { if (!holds) wrong.push(what); };
const brightness = (color) => color.match(/\d+/g).slice(0, 3).reduce((sum, c) => sum + +c, 0);
const pause = (ms) => new Promise((r) => setTimeout(r, ms));
function look(id) {
    const inside = document.getElementById(id).contentWindow, page = inside.document;
    expect(id + ' script: ' + inside.failures, inside.failures.length === 0);
    expect(id + ' is too wide', page.documentElement.scrollWidth <= inside.innerWidth);
    expect(id + ' shows no text', page.body.innerText.length > 300);
    for (const image of page.images) expect(id + ' picture ' + image.alt, image.naturalWidth > 0);
    const slider = page.querySelector('.pair input');
    slider.value = 20;
    slider.dispatchEvent(new inside.Event('input'));
    const border = parseFloat(inside.getComputedStyle(page.querySelector('.pair i')).left);
    expect(id + ' slider at ' + border, Math.abs(border - 0.2 * slider.parentNode.clientWidth) < 1);
    const reached = [...page.querySelectorAll('a, button, input, summary, iframe')].every((e) => e.tabIndex >= 0);
    expect(id + ' has what no key reaches', reached);
    return brightness(inside.getComputedStyle(page.body).backgroundColor);
}
(async () => {
    await pause(2000);
    const light = look('phone'), dark = look('screen');
    expect('themes ' + light + ' ' + dark, light > 600 && dark < 200);
    document.title = wrong.length ? 'WRONG ' + wrong.join('; ') : 'RIGHT';
})();
</script></body></html>)js";

TEST(ReportInABrowser, ReadsOnAPhoneInTheDarkAndByKeys) {
    if (!test::has_browser()) GTEST_SKIP() << "Chromium is not installed";
    const test::TemporaryFolder folder;
    const Image<SrgbPixel> picture({64, 48}, SrgbPixel(90, 120, 60));
    const EncodedPicture encoded = encoded_as_jpeg(picture, 85);
    const std::string jpeg(encoded.bytes.begin(), encoded.bytes.end());
    const std::vector<PicturePair> pairs = {{"frame 10", {64, 48}, jpeg, jpeg}};
    const ReportScene scene{test::small_scene(), {{0, 1, 2}, {0.5, 1, 2}}};
    std::string html = report_html(test::full_summary(), {}, &scene, pairs);
    html.insert(html.find("<style>"), kListen);
    std::ofstream(folder / "report.html") << html;
    EXPECT_THAT(test::browser_dom(folder, std::string(kLook)), HasSubstr("<title>RIGHT</title>"));
}

}  // namespace
}  // namespace patina::report_browser_test
