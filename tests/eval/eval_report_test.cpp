#include "tools/eval/eval_report.h"

#include <limits>
#include <regex>

#include <gmock/gmock.h>

#include "tests/eval/made_up_evaluation.h"

namespace patina::eval::eval_report_test {
namespace {

using test::full_evaluation;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::vector<ErrorFigure>& figures() {
    static const ColorScale kScale{"scale", "0", "0.2 <mm>"};
    static const std::vector<ErrorFigure> kFigures{{120, {{"kd refined", "true", "run", "error", kScale, kScale}}}};
    return kFigures;
}

std::string report(const Evaluation& evaluation = full_evaluation()) { return eval_report_html(evaluation, figures()); }

size_t count_of(const std::string& text, const std::string& part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

/// The elements that are open at the end, after what was closed in the wrong order; empty for a well-formed page.
std::vector<std::string> unbalanced(const std::string& html) {
    static const std::regex kTag("<(/?)([a-z0-9]+)(?:\"[^\"]*\"|'[^']*'|[^'\">])*?(/?)>");
    static const std::set<std::string> kVoid = {"meta", "img"};
    std::vector<std::string> open;
    for (std::sregex_iterator at(html.begin(), html.end(), kTag), end; at != end; ++at) {
        const std::string name = (*at)[2];
        if (kVoid.contains(name) || (*at)[3] == "/") continue;
        if ((*at)[1] != "/") {
            open.push_back(name);
        } else if (!open.empty() && open.back() == name) {
            open.pop_back();
        } else {
            open.push_back("/" + name);
            return open;
        }
    }
    return open;
}

TEST(EvalReport, HasScoresPlotsAndPictures) {
    const std::string html = report();
    EXPECT_THAT(html, HasSubstr("<th>kd refined</th><td class='number'>0.0300</td>"));
    EXPECT_THAT(html, HasSubstr("<p>Scores over filled pixels whose surface was seen in at least 5 frames, 95.3% of"));
    EXPECT_THAT(html, HasSubstr("Depth error</td><td>1.50 mm median"));
    EXPECT_THAT(html, HasSubstr("true light 2</td>"));
    EXPECT_THAT(html, HasSubstr("93.8%"));
    EXPECT_EQ(count_of(html, "<svg class='plot"), 4u * 8u);
    EXPECT_THAT(html, HasSubstr("<h3>Frame 120</h3>"));
    EXPECT_THAT(html,
                HasSubstr("alt=\"kd refined, absolute error, frame 120\" src=\"data:image/png;base64,ZXJyb3I=\""));
    EXPECT_THAT(html, HasSubstr("<span>&ge; 0.2 &lt;mm&gt;</span>"));
    EXPECT_THAT(html, HasSubstr("the run has no value"));
}

TEST(EvalReport, IsWellFormed) {
    EXPECT_THAT(unbalanced("<p>a<b></p></b>"), Not(IsEmpty()));
    for (const Evaluation& evaluation :
         {full_evaluation(), full_evaluation(30, 3), test::geometry_only(), Evaluation()}) {
        EXPECT_THAT(unbalanced(report(evaluation)), IsEmpty());
    }
}

TEST(EvalReport, NeedsNoOtherFileAndNoNetwork) {
    const std::string html = report();
    EXPECT_GT(count_of(html, "src="), 5u);
    EXPECT_EQ(count_of(html, "src="), count_of(html, "src=\"data:image/png;base64,"));
    for (const char* outside : {"http:", "https:", "href=", "url(", "@import", "<script", "<link"}) {
        EXPECT_THAT(html, Not(HasSubstr(outside)));
    }
}

TEST(EvalReport, SuitsDarkThemesAndPaper) {
    const std::string html = report();
    EXPECT_EQ(count_of(html, "@media (prefers-color-scheme: dark)"), 2u);  // the page's, and that of the plots
    EXPECT_THAT(html, HasSubstr("@media print"));
}

TEST(EvalReport, EscapesNames) {
    const std::string html = report();
    EXPECT_THAT(html, Not(HasSubstr("<script")));
    EXPECT_THAT(html, Not(HasSubstr("<b>run</b>")));
    EXPECT_THAT(html, HasSubstr("S2 yellow &lt;script&gt; figure"));
    EXPECT_THAT(html, HasSubstr("<title>Evaluation of out/&lt;b&gt;run&lt;/b&gt; &middot; Patina</title>"));
}

TEST(EvalReport, ManyObjectsHaveALineEach) {
    const std::string html = report(full_evaluation(30, 3));
    EXPECT_THAT(html, HasSubstr("<th>S30 chair 29</th><td class='number'>0.3000</td>"));
    EXPECT_THAT(html, HasSubstr("<div class='scores turned' style='--columns: 8'>"));
}

TEST(EvalReport, SaysWhatTheRunDidNotWrite) {
    const std::string html = report(test::geometry_only());
    EXPECT_THAT(html, HasSubstr("<li>The run&#39;s frames hold no kd, kd refined, ks, alpha and RGB.</li>"));
    EXPECT_THAT(html, Not(HasSubstr("<h2>Lights</h2>")));
    EXPECT_THAT(html, Not(HasSubstr("Specular albedo")));
    EXPECT_EQ(count_of(html, "<svg class='plot"), 4u * 2u);
}

TEST(EvalReport, KindsOfPixelsHaveTablesOfTheirOwn) {
    for (const char* heading :
         {"<h2>Averages, of all frames and of the last tenth</h2>", "<h2>Scores per object</h2>",
          "<h2>Scores per object, filled pixels</h2>", "<h2>Scores per object, where it was seen often</h2>"})
        EXPECT_THAT(report(), HasSubstr(heading));
    Evaluation all = full_evaluation();
    all.seen_frames = 1;
    EXPECT_THAT(report(all), Not(HasSubstr("where it was seen often")));
}

TEST(EvalReport, ShowsNothingThatIsNoNumber) {
    Evaluation evaluation = full_evaluation();
    evaluation.object_means[Quantity::kKd]->mean.all.psnr_db = std::numeric_limits<double>::infinity();
    const std::string html = report(evaluation);
    EXPECT_THAT(html, HasSubstr(">inf</td>"));
    EXPECT_THAT(html, Not(HasSubstr(">nan")));
    EXPECT_THAT(html, Not(HasSubstr("nan ")));
}

}  // namespace
}  // namespace patina::eval::eval_report_test
