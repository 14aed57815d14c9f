#include <cmath>

#include <gmock/gmock.h>

#include "export/viewer/quantise.h"
#include "export/viewer/write_viewer.h"
#include "tests/export/browser.h"
#include "tests/export/small_scene.h"
#include "tests/export/temporary_folder.h"
#include "tests/export/throws.h"

// The viewer in one HTML file: what it holds, and where Chromium is installed, what it shows.

namespace patina::viewer_test {
namespace {

using test::small_scene;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

/// A square of so many vertices along an edge, in one page of noise, which JPEG cannot make small.
SceneParts noisy_scene(uint32_t edge, uint32_t texels) {
    SceneParts scene;
    scene.materials.resize(1);
    ScenePart& part = scene.parts.emplace_back();
    part.page = 0;
    for (uint32_t y = 0; y < edge; ++y) {
        for (uint32_t x = 0; x < edge; ++x) {
            const glm::vec2 at(static_cast<float>(x) / static_cast<float>(edge),
                               static_cast<float>(y) / static_cast<float>(edge));
            part.positions_m.emplace_back(at, 0.1f * std::sin(9 * at.x));
            part.normals.emplace_back(0, 0, 1);
            part.places.push_back(at);
        }
    }
    for (uint32_t y = 0; y + 1 < edge; ++y) {
        for (uint32_t x = 0; x + 1 < edge; ++x) {
            const uint32_t i = y * edge + x;
            part.triangles.push_back({i, i + 1, i + edge});
            part.triangles.push_back({i + 1, i + edge + 1, i + edge});
        }
    }
    Image<SrgbPixel> page({texels, texels});
    uint32_t state = 1;
    for (SrgbPixel& pixel : page.pixels()) {
        state = state * 1664525u + 1013904223u;
        pixel = SrgbPixel(state >> 24, state >> 16 & 255, state >> 8 & 255);
    }
    scene.pages.push_back(encoded_as_jpeg(page, 85));
    return scene;
}

glm::vec3 unfolded(const std::array<int16_t, 2>& code) {
    glm::vec3 n(code[0] / 32767.0f, code[1] / 32767.0f, 0);
    n.z = 1 - std::abs(n.x) - std::abs(n.y);
    if (n.z < 0) {
        const glm::vec2 folded = 1.0f - glm::abs(glm::vec2(n.y, n.x));
        n.x = n.x < 0 ? -folded.x : folded.x;
        n.y = n.y < 0 ? -folded.y : folded.y;
    }
    return glm::normalize(n);
}

TEST(Quantise, PositionsAndNormalsStayWithinAStep) {
    SceneParts scene;
    scene.materials.resize(3);
    ScenePart& part = scene.parts.emplace_back();
    part.material = 2;
    for (int i = 0; i < 2000; ++i) {
        const float a = 0.37f * static_cast<float>(i), b = 0.11f * static_cast<float>(i);
        const glm::vec3 normal(std::cos(a) * std::cos(b), std::sin(b), std::sin(a) * std::cos(b));
        part.positions_m.push_back(glm::vec3(3, 2, 8) * normal + 5.0f);
        part.normals.push_back(normal);
        part.base.emplace_back(0.5f, 0.25f, 1.0f);
    }
    const auto [low, high] = bounds_of(scene);
    const std::vector<ViewerGroup> groups = quantised(scene);
    ASSERT_EQ(groups.size(), 1u);
    ASSERT_EQ(groups[0].vertices.size(), 2000u);
    for (size_t i = 0; i < 2000; ++i) {
        const ViewerVertex& vertex = groups[0].vertices[i];
        const glm::vec3 at =
            low + glm::vec3(vertex.position[0], vertex.position[1], vertex.position[2]) / 65535.0f * (high - low);
        const glm::vec3 off = glm::abs(at - part.positions_m[i]) / (high - low);
        EXPECT_LE(std::max({off.x, off.y, off.z}), 0.51f / 65535);
        EXPECT_LT(glm::distance(unfolded(vertex.normal), part.normals[i]), 1e-4f);  // 0.006 degrees
        EXPECT_EQ(vertex.material, 2);
        EXPECT_EQ(vertex.look[0] >> 8, 188);  // 0.5 as sRGB
        EXPECT_EQ(vertex.look[1] >> 8, 255);
    }
}

TEST(Viewer, NeedsNoOtherFileAndNoNetwork) {
    const std::string html = viewer_html(small_scene());
    for (const char* outside : {"http:", "https:", "href=", "src=\"", "@import", "<link", "fetch(", "url("})
        EXPECT_THAT(html, Not(HasSubstr(outside)));
    EXPECT_THAT(html, Not(HasSubstr("{{")));
}

TEST(Viewer, HoldsTheBrdfOfThePasses) {
    const std::string html = viewer_html(small_scene());
    EXPECT_THAT(html, HasSubstr("vec3 ward_point_light(vec3 kd, vec3 ks, float alpha"));
    EXPECT_THAT(html, Not(HasSubstr("#include")));
}

TEST(Viewer, SaysWhatIsKnownOfMaterials) {
    const std::string html = viewer_html(small_scene());
    EXPECT_THAT(html, HasSubstr(R"("name":"wall 1","label":1)"));
    EXPECT_THAT(html, HasSubstr(R"("observed":false)"));
    EXPECT_THAT(html,
                HasSubstr(R"("lights":[{"position":[0.5,3.0,-1.0],"intensity":[3.0,6.0,3.0],"axis":[0.0,0.0,0.0]}])"));
    EXPECT_THAT(html, HasSubstr("prefers-color-scheme: dark"));
}

TEST(Viewer, NamesCannotEndAScript) {
    SceneParts scene = small_scene();
    scene.name = "<b>";
    scene.materials[0].name = "</script><script>alert(1)</script>";
    const std::string html = viewer_html(scene);
    EXPECT_THAT(html, Not(HasSubstr("</script><script>alert")));
    EXPECT_THAT(html, HasSubstr("<title>&lt;b&gt;"));
}

TEST(Viewer, StaysWithinItsSize) {
    const SceneParts scene = noisy_scene(200, 2048);
    EXPECT_LE(viewer_html(scene, {.most_bytes = 1'000'000}).size(), 1'000'000u);
    EXPECT_GT(viewer_html(scene).size(), 2'000'000u) << "nothing had to go";
    EXPECT_THAT([&] { viewer_html(scene, {.most_bytes = 60'000}); }, test::throws_error_with("--triangles"));
}

/// A browser's picture of a page is more than its ground: the view compiles its shaders and draws.
TEST(Viewer, ABrowserShowsIt) {
    if (!test::has_browser()) GTEST_SKIP() << "Chromium is not installed";
    const TemporaryFolder folder;
    std::string html = viewer_html(small_scene());
    // The page says what it drew and heard, where a test can read it.
    const std::string probe = R"js(<script>(async () => {
        for (let i = 0; i < 100 && !groups.length; ++i) await new Promise((r) => setTimeout(r, 50));
        await new Promise((r) => setTimeout(r, 200));
        const yaw = camera.yaw;
        for (const key of ['4', 'ArrowLeft']) document.body.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true}));
        const heard = mode === 3 && camera.yaw !== yaw;
        draw(4);
        const all = new Uint8Array(4 * canvas.width * canvas.height);
        gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, all);
        let drawn = 0;
        for (let i = 3; i < all.length; i += 4) drawn += all[i] > 0;
        document.title = (drawn > 1000 ? 'DRAWN' : 'EMPTY') + (heard ? ' HEARD' : ' DEAF');
    })();</script>)js";
    html.insert(html.find("</body>"), probe);
    EXPECT_THAT(test::browser_dom(folder, html), HasSubstr("<title>DRAWN HEARD</title>"));
}

}  // namespace
}  // namespace patina::viewer_test
