#include "tools/report/report.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "export/html.h"
#include "tests/export/full_summary.h"
#include "tests/export/small_scene.h"
#include "tests/export/temporary_folder.h"

namespace patina::report_test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string report() {
    const std::vector<ReportPicture> pictures = {{"frame 12 & \"more\"", std::string("\x89PNG\0", 5)}};
    return report_html(test::full_summary(), pictures);
}

size_t count_of(const std::string& text, const std::string& part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST(Html, EscapesWhatHasAMeaning) {
    EXPECT_EQ(html_escaped("<b class=\"x\">'&amp;'</b>"), "&lt;b class=&quot;x&quot;&gt;&#39;&amp;amp;&#39;&lt;/b&gt;");
    EXPECT_EQ(html_escaped("K\xc3\xbc"
                           "che 5 mm"),
              "K\xc3\xbc"
              "che 5 mm");
}

// The vectors of RFC 4648, section 10, and bytes above 127.
TEST(Html, Base64FollowsTheRfc) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64(std::string_view("\xff\xfe\x00", 3)), "//4A");
}

TEST(Report, SaysWhatTheRunDid) {
    const std::string html = report();
    EXPECT_THAT(html, HasSubstr("<title>red &lt;kitchen&gt; &middot; Patina</title>"));
    EXPECT_THAT(html, HasSubstr("298 of 300"));
    EXPECT_THAT(html, HasSubstr("1&#8239;234&#8239;567"));
    EXPECT_THAT(html, HasSubstr("61.25 s"));
    EXPECT_THAT(html, HasSubstr("12 block requests were refused"));
    EXPECT_THAT(html, HasSubstr("fusion.integrate</td>"));
    EXPECT_THAT(html, HasSubstr("24.125"));
    EXPECT_THAT(html, HasSubstr("30.125"));  // the sum of the medians
    EXPECT_THAT(html, HasSubstr("128.0 MiB"));
    EXPECT_THAT(html, HasSubstr("frame-000017.color.png is truncated"));
    EXPECT_THAT(html, HasSubstr("&quot;voxel_mm&quot;: 5"));
}

TEST(Report, NamesTheDetailAndCountsFramesThatRepeat) {
    RunSummary summary = test::full_summary();
    summary.detail = {{"level", "fine"}, {"because", "the depth is < 1 m"}};
    summary.frames.used = 281;
    summary.frames.repeated = 17;
    const std::string html = report_html(summary, {});
    EXPECT_THAT(html, HasSubstr("fine, since the depth is &lt; 1 m"));
    EXPECT_THAT(html, HasSubstr("Frames that repeat the one before</dt><dd>17"));
    EXPECT_THAT(html, HasSubstr("281 of 283 frames were used."));
    const auto json = nlohmann::json::parse(run_json(summary));
    EXPECT_EQ(json["detail"]["level"], "fine");
    EXPECT_EQ(json["frames"]["repeated"], 17);
    EXPECT_THAT(html, Not(HasSubstr("undone")));
    summary.frames.undone = 23;
    EXPECT_THAT(report_html(summary, {}), HasSubstr("Frames undone</dt><dd>23"));
}

TEST(Report, WhatIsIncompleteComesFirst) {
    RunSummary summary = test::full_summary();
    EXPECT_THAT(report_html(summary, {}), Not(HasSubstr("Incomplete")));
    summary.finished = false;
    summary.ended = "interrupted after 12 of 60 frames";
    summary.shortfalls = {"the pool <was> full"};
    summary.materials_missing = "no lights & no lamps";
    const std::string html = report_html(summary, {});
    EXPECT_LT(html.find("interrupted after 12"), html.find("Frames used"));
    EXPECT_LT(html.find("the pool &lt;was&gt; full"), html.find("Frames used"));
    EXPECT_THAT(html, HasSubstr("no lights &amp; no lamps"));
}

TEST(Report, ListsLightsAndMaterials) {
    RunSummary summary = test::full_summary();
    summary.lamps = {{{1, -2.5, 3}, {4, 5, 6}, 0.05}};
    summary.segments = {{3, "<floor>", {glm::vec3(0.25f), WardGloss{glm::vec3(0.125f), 0.2f}, 1234, 5, 0.5f}}};
    const std::string html = report_html(summary, {});
    for (const char* part : {"Lights", "1.000 -2.500 3.000", "4.000 5.000 6.000", "5.0</td>", "Table of materials",
                             "&lt;floor&gt;", "0.250 0.250 0.250", "0.125 0.125 0.125", "0.200", "1&#8239;234"}) {
        EXPECT_THAT(html, HasSubstr(part));
    }
    EXPECT_THAT(report(), Not(HasSubstr("Table of materials")));
}

TEST(Report, WhatIsNotKnownSaysSo) {
    RunSummary summary = test::full_summary();
    summary.segments = {{3, "vase", {{}, WardGloss{glm::vec3(0.0432f), 0.2f, 0.1f}, 1234, 5, 0.5f}}};
    const std::string html = report_html(summary, {});
    EXPECT_EQ(count_of(html, "<td class='number'>not observed</td>"), 3u);  // kd, ks and alpha
    EXPECT_THAT(html, Not(HasSubstr("0.043")));
}

TEST(Report, ShowsTheSceneWithoutANetwork) {
    const test::TemporaryFolder folder;
    test::write_small_glb(folder / "scene.glb");
    RunSummary summary = test::full_summary();
    summary.segments = {{1, "wall 1", {glm::vec3(0.5f), WardGloss{glm::vec3(0.2f), 0.2f, 0.9f}, 1234, 5, 0.5f}}};
    const ReportScene scene{read_scene_parts(folder / "scene.glb"), {{0.2, 1, 0.5}, {0.4, 1, 0.5}}};
    const std::string html = report_html(summary, {}, &scene);
    EXPECT_EQ(count_of(html, "<iframe"), 1u);
    EXPECT_THAT(html, HasSubstr("srcdoc=\"&lt;!DOCTYPE html&gt;"));
    EXPECT_THAT(html, HasSubstr("<b>wall 1</b>ks 0.20, alpha 0.20"));
    EXPECT_THAT(html, HasSubstr("<svg class='plan'"));
    EXPECT_THAT(html, HasSubstr("lamp 1, 3.00 m above the floor"));
    for (const char* outside : {"http:", "https:", "url(", "@import", "<script", "<link"})
        EXPECT_THAT(html, Not(HasSubstr(outside)));
}

TEST(Report, TheVerdictComesBeforeEverythingElse) {
    const std::string html = report();
    EXPECT_LT(html.find("298 of 300 frames were used."), html.find("<h2>"));
    EXPECT_LT(html.find("<details>"), html.find("GPU time per pass"));
}

TEST(Report, LinesDoNotBreakWithinOptions) {
    RunSummary summary = test::full_summary();
    summary.materials_missing = "no lamp is known: give <lights> (--lights FILE, --lighting self)";
    EXPECT_THAT(report_html(summary, {}),
                HasSubstr("&lt;lights&gt; (<code>--lights</code> FILE, <code>--lighting</code> self)"));
}

TEST(Report, BarsAreInProportion) {
    // The longest median, 24.125 ms, takes half the width; fusion.integrate's 4.75 ms the corresponding part.
    EXPECT_THAT(report(), HasSubstr("width='50.00' height='6'"));
    EXPECT_THAT(report(), HasSubstr("width='9.84' height='6'"));
    EXPECT_THAT(report(), HasSubstr("width='27.99' height='6'"));  // 18342 of 65536 voxel blocks
}

TEST(Report, EscapesWhatItIsTold) {
    const std::string html = report();
    EXPECT_THAT(html, Not(HasSubstr("<kitchen>")));
    EXPECT_THAT(html, Not(HasSubstr("<NaN>")));
    EXPECT_THAT(html, HasSubstr("alt=\"frame 12 &amp; &quot;more&quot;\""));
    EXPECT_THAT(html, HasSubstr("a &lt; b &amp; \\&quot;c\\&quot;"));
}

TEST(Report, NeedsNoOtherFileAndNoNetwork) {
    const std::string html = report();
    EXPECT_THAT(html, HasSubstr("src=\"data:image/png;base64,iVBORwA=\""));
    EXPECT_EQ(count_of(html, "src="), 1u);
    for (const char* outside : {"http:", "https:", "href=", "url(", "@import", "<script", "<link"}) {
        EXPECT_THAT(html, Not(HasSubstr(outside)));
    }
}

TEST(Report, LaysRecordedPicturesOverTheirRendering) {
    const std::vector<PicturePair> pairs = {{"frame <3>", {80, 60}, "recorded", "rendered"},
                                            {"frame 9", {60, 80}, "recorded", "rendered"}};
    const std::string html = report_html(test::full_summary(), {}, nullptr, pairs);
    EXPECT_EQ(count_of(html, "<input type='range'"), 2u);
    EXPECT_EQ(count_of(html, "<input type='radio'"), 2u);
    EXPECT_EQ(count_of(html, " checked>"), 1u) << "one shows";
    EXPECT_EQ(count_of(html, "data:image/jpeg;base64," + base64("recorded")), 2u);
    EXPECT_EQ(count_of(html, "data:image/jpeg;base64," + base64("rendered")), 2u);
    EXPECT_THAT(html, HasSubstr("aria-label=\"frame &lt;3&gt;: share of the recorded picture\""));
    EXPECT_THAT(html, HasSubstr("aspect-ratio: 1.3333"));
    EXPECT_THAT(html, HasSubstr("#pair1:checked ~ figure:nth-of-type(2)"));
    for (const char* outside : {"http:", "https:", "url(", "@import", "<script", "<link"})
        EXPECT_THAT(html, Not(HasSubstr(outside)));
    EXPECT_THAT(report(), Not(HasSubstr("re-rendering"))) << "where there is no pair";
}

TEST(Report, SuitsDarkThemesAndPaper) {
    EXPECT_THAT(report(), HasSubstr("@media (prefers-color-scheme: dark)"));
    EXPECT_THAT(report(), HasSubstr("@media print"));
}

TEST(Report, LeavesOutWhatThereIsNot) {
    const std::string html = report_html({}, {});
    for (const char* absent :
         {"Warnings", "Pictures", "GPU time", "Device memory", "Skipped frames", "<h2>Settings", "refused"}) {
        EXPECT_THAT(html, Not(HasSubstr(absent)));
    }
    EXPECT_THAT(html, HasSubstr("0 of 0"));
    EXPECT_THAT(html, Not(HasSubstr("repeat the one")));
    EXPECT_THAT(html, Not(HasSubstr("<dt>Detail")));
}

}  // namespace
}  // namespace patina::report_test
