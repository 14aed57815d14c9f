#include "tools/report/swatches.h"

#include <gmock/gmock.h>

#include "tests/export/small_scene.h"
#include "tests/export/temporary_folder.h"
#include "tools/report/plan.h"

namespace patina::swatches_test {
namespace {

using testing::HasSubstr;

const Lighting kFront{{{{0, 0, 2}, {4, 4, 4}, 0}}, {}};

SegmentReflectance matt_of(float kd, uint32_t voxels = 1) {
    SegmentReflectance matt;
    matt.kd = glm::vec3(kd);
    matt.voxels = voxels;
    return matt;
}

TEST(Swatch, WhiteFacingTheLampIsAsBrightAsTheExposureSays) {
    const Drawing drawing = swatch(matt_of(1), kFront, 33);
    EXPECT_NEAR(drawing.at(16, 16).g, 231, 2);  // 0.8 as sRGB
    EXPECT_NEAR(drawing.at(2, 16).g, 174, 2);   // 0.53 of it, the cosine there
}

TEST(Swatch, AHighlightIsWhereTheLampMirrors) {
    const SegmentReflectance glossy{.kd = glm::vec3(0.1f), .gloss = WardGloss{glm::vec3(0.05f), 0.1f, 0.9f}};
    const Lighting side{{{{2, 0, 2}, {4, 4, 4}, 0}}, {}};  // mirrors at 22.5 degrees: sin is 0.38
    const Drawing drawing = swatch(glossy, side, 101);
    EXPECT_EQ(drawing.at(50 + 19, 50).g, 255);
    EXPECT_LT(drawing.at(50 - 19, 50).g, 120);
}

TEST(Swatch, GlossThatWasNotObservedIsNotShown) {
    const SegmentReflectance guess{.kd = glm::vec3(0.1f), .gloss = WardGloss{glm::vec3(0.5f), 0.1f, 0.1f}};
    const SegmentReflectance matt = matt_of(0.1f);
    EXPECT_EQ(swatch(guess, kFront, 21).pixels(), swatch(matt, kFront, 21).pixels());
}

TEST(Swatch, WithoutLampsASphereIsStillRound) {
    const Drawing drawing = swatch(matt_of(0.5f), {{}, glm::dvec3(1.5)}, 33);
    EXPECT_GT(drawing.at(10, 10).g, drawing.at(26, 26).g + 30);
}

TEST(Swatch, TheLargestComeFirst) {
    const std::vector<SegmentSummary> segments{{1, "<small>", matt_of(0.5f, 10)}, {2, "large", matt_of(0.5f, 100)}};
    const std::string html = swatch_grid(segments, kFront, glm::dvec3(0));
    EXPECT_LT(html.find("<b>large</b>"), html.find("<b>&lt;small&gt;</b>"));
    EXPECT_THAT(html, HasSubstr("gloss not observed"));
    EXPECT_EQ(swatch_grid({}, kFront, glm::dvec3(0)), "");
    const std::vector<SegmentSummary> unknown{{1, "unknown", {}}};
    EXPECT_EQ(swatch_grid(unknown, kFront, glm::dvec3(0)), "");
}

TEST(Plan, ShowsLampsAndTheCamerasWay) {
    SceneParts scene;
    scene.materials.resize(1);
    ScenePart& floor = scene.parts.emplace_back();
    floor.positions_m = {{0, 0, 0}, {2, 0, 0}, {0, 0, 1}, {2, 0, 1}};
    floor.normals.assign(4, glm::vec3(0, 1, 0));
    floor.base.assign(4, glm::vec3(0.5f));
    floor.triangles = {{0, 2, 1}, {1, 2, 3}};
    scene.lights = {{{1, 2, 0.5}, {1, 1, 1}, 0}};
    const std::vector<glm::dvec3> path{{0, 1, 0}, {2, 1, 1}};
    const std::string svg = plan_svg(scene, path);
    // 2.2 m, with margins of 0.1 m, are 640 pixels.
    EXPECT_THAT(svg, HasSubstr("viewBox='0 0 640 370'"));
    EXPECT_THAT(svg, HasSubstr("points='29.1,29.1 610.9,320.0 '"));
    EXPECT_THAT(svg, HasSubstr("cx='320.0' cy='174.5'"));
    EXPECT_EQ(plan_svg({}, path), "");
}

}  // namespace
}  // namespace patina::swatches_test
