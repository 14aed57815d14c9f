#include "export/scene_parts.h"

#include <set>

#include <gmock/gmock.h>

#include "export/fewer_triangles.h"
#include "export/glb_model.h"
#include "export/page_picture.h"
#include "export/rewrite_glb.h"
#include "tests/export/small_scene.h"
#include "tests/export/temporary_folder.h"
#include "tests/export/test_meshes.h"
#include "tests/export/throws.h"

// A scene.glb that is read back, and written again with changes.

namespace patina::scene_parts_test {
namespace {

using test::bytes_of;
using test::TemporaryFolder;
using test::throws_error_with;

constexpr glm::vec3 kTexel(0.25f, 0.5f, 0.125f);

void expect_near(glm::dvec3 a, glm::dvec3 b, double most) {
    EXPECT_LT(glm::distance(a, b), most) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(SceneParts, ReadsBackWhatWasWritten) {
    const TemporaryFolder folder;
    test::write_small_glb(folder / "scene.glb");
    const SceneParts scene = read_scene_parts(folder / "scene.glb");
    EXPECT_EQ(scene.name, "small");
    EXPECT_EQ(scene.triangles(), 3u);
    EXPECT_EQ(scene.vertices(), 7u);
    ASSERT_EQ(scene.parts.size(), 2u);
    ASSERT_EQ(scene.pages.size(), 1u);
    // y is turned up, and the floor at y = 1 is 0.
    expect_near(glm::dvec3(scene.parts[0].positions_m[3]), {1, 0, -1}, 1e-6);
    expect_near(glm::dvec3(scene.parts[0].normals[3]), {0, 0, 1}, 1e-6);
    EXPECT_EQ(scene.parts[0].page, 0u);
    const PartMaterial& wall = scene.materials[scene.parts[0].material];
    EXPECT_EQ(wall.name, "wall 1");
    EXPECT_EQ(wall.label, 1u);
    EXPECT_TRUE(wall.observed);
    ASSERT_TRUE(wall.gloss);
    expect_near(glm::dvec3(wall.gloss->ks), {0.2, 0.2, 0.1}, 1e-6);
    EXPECT_FLOAT_EQ(wall.gloss->alpha, 0.25f);
    const PartMaterial& guess = scene.materials[scene.parts[1].material];
    EXPECT_FALSE(guess.observed);
    ASSERT_TRUE(guess.gloss);
    EXPECT_FLOAT_EQ(guess.gloss->alpha, 0.3f);
    ASSERT_EQ(scene.lights.size(), 1u);
    expect_near(scene.lights[0].position_m, {0.5, 3, -1}, 1e-9);
    expect_near(scene.lights[0].intensity, {3, 6, 3}, 1e-9);
    EXPECT_EQ(scene.lights[0].radius_m, 0.05);
    EXPECT_EQ(scene.candela_per_intensity, test::kCandela);
    ASSERT_EQ(scene.windows.size(), 1u);
    expect_near(scene.windows[0].center_m, {0.5, 1, -2}, 1e-9);
    expect_near(scene.windows[0].half_u_m, {-0.4, 0, 0}, 1e-9);
    expect_near(scene.windows[0].half_v_m, {0, 0.3, 0}, 1e-9);
    expect_near(scene.windows[0].radiance, test::kSmallWindow.radiance, 1e-9);
    EXPECT_TRUE(scene.windows[0].clipped);
}

TEST(SceneParts, AFlatLampReadsBackWithItsAxis) {
    Light flat = test::kSmallLamp;
    flat.axis = {0, 0.6, 0.8};
    const SceneParts scene = test::small_scene(flat);
    ASSERT_EQ(scene.lights.size(), 1u);
    expect_near(scene.lights[0].position_m, {0.5, 3, -1}, 1e-9);
    expect_near(scene.lights[0].axis, {0, -0.6, -0.8}, 1e-9);
    expect_near(scene.lights[0].intensity, {3, 6, 3}, 1e-9);
    EXPECT_EQ(test::small_scene().lights.at(0).axis, glm::dvec3(0));
}

TEST(SceneParts, AlbedoOfThePageIsThatOfTheSegment) {
    const TemporaryFolder folder;
    test::write_small_glb(folder / "scene.glb", kTexel);
    const SceneParts scene = read_scene_parts(folder / "scene.glb");
    const glm::vec3 base = base_colors(scene)[0][0];
    // A page has 8 bits.
    expect_near(glm::dvec3(scene.materials[scene.parts[0].material].kd_over_base() * base), glm::dvec3(kTexel), 5e-3);
}

TEST(SceneParts, NoOtherFileIsTakenForAScene) {
    const TemporaryFolder folder;
    test::write_small_glb(folder / "scene.glb");
    const std::string whole = bytes_of(folder / "scene.glb");
    const auto written = [&](const std::string& bytes) {
        std::ofstream(folder / "a.glb", std::ios::binary) << bytes;
        return [&] { read_scene_parts(folder / "a.glb"); };
    };
    EXPECT_THAT(written("no glTF at all, but some text"), throws_error_with("is no GLB file"));
    EXPECT_THAT(written(whole.substr(0, 100)), throws_error_with("is truncated"));
    EXPECT_THAT(written(whole.substr(0, whole.size() - 400)), throws_error_with("a.glb"));
    std::string foreign = whole;
    foreign.replace(foreign.find("Patina 1.2.3"), 6, "Blende");
    EXPECT_THAT(written(foreign), throws_error_with("was not written by Patina but by 'Blende 1.2.3'"));
    EXPECT_THAT([&] { read_scene_parts(folder / "none.glb"); }, throws_error_with("does not exist"));
}

TEST(FewerTriangles, PartsStillMeet) {
    // Two sheets that meet in a wavy border, each with its own vertices there.
    const Mesh sheet = test::wavy_sheet(30, 30);
    std::vector<PartSurface> parts(2, {sheet.positions_m, sheet.triangles});
    for (glm::vec3& position_m : parts[1].positions_m) position_m.y = -position_m.y;
    const auto kept = collapse(parts, 0.2);
    ASSERT_EQ(kept.size(), 2u);
    const size_t left = parts[0].triangles.size() + parts[1].triangles.size();
    EXPECT_LT(left, 4 * sheet.triangles.size() * 2 / 10);
    EXPECT_GT(left, sheet.triangles.size() / 10);
    std::array<std::set<std::pair<float, float>>, 2> border;
    for (size_t i = 0; i < 2; ++i) {
        for (const auto& triangle : parts[i].triangles)
            for (const uint32_t vertex : triangle) ASSERT_LT(vertex, kept[i].size());
        for (const uint32_t vertex : kept[i]) {
            const glm::vec3 at = parts[i].positions_m[vertex];
            if (at.y == 0) border[i].emplace(at.x, at.z);
        }
    }
    EXPECT_EQ(border[0], border[1]);
    EXPECT_LT(border[0].size(), 30u) << "the border is simplified too";
    EXPECT_GE(border[0].size(), 2u);
}

TEST(FewerTriangles, NoPartVanishes) {
    const Mesh sheet = test::wavy_sheet(30, 30);
    std::vector<PartSurface> parts{{sheet.positions_m, sheet.triangles},
                                   {{{5, 5, 5}, {5.001f, 5, 5}, {5, 5.001f, 5}}, {{0, 1, 2}}}};
    collapse(parts, 0.01);
    EXPECT_GE(parts[0].triangles.size(), 1u);
    EXPECT_EQ(parts[1].triangles.size(), 1u);
}

class RewriteGlb : public testing::Test {
  protected:
    RewriteGlb() {
        const Mesh sheet = test::wavy_sheet(30, 30);
        write_glb(folder_ / "sheet.glb", {sheet}, {.version = "1.2.3", .name = "sheet"});
        test::write_small_glb(folder_ / "small.glb");
    }

    SceneParts changed(const char* name, const GlbChanges& changes) {
        rewrite_glb(folder_ / name, folder_ / "new.glb", changes);
        return read_scene_parts(folder_ / "new.glb");
    }

    const TemporaryFolder folder_;
};

TEST_F(RewriteGlb, WithoutChangesAllStays) {
    const SceneParts before = read_scene_parts(folder_ / "small.glb"), after = changed("small.glb", {});
    ASSERT_EQ(after.parts.size(), before.parts.size());
    for (size_t i = 0; i < after.parts.size(); ++i) {
        EXPECT_EQ(after.parts[i].positions_m, before.parts[i].positions_m);
        EXPECT_EQ(after.parts[i].places, before.parts[i].places);
        EXPECT_EQ(after.parts[i].triangles, before.parts[i].triangles);
    }
    EXPECT_EQ(after.pages[0].bytes, before.pages[0].bytes);
    EXPECT_EQ(after.lights, before.lights);
    EXPECT_EQ(after.materials[0].gloss->ks, before.materials[0].gloss->ks);
}

TEST_F(RewriteGlb, TheNormalMapStaysWithTheTexture) {
    changed("small.glb", {});
    const tinygltf::Model before = read_glb(folder_ / "small.glb"), after = read_glb(folder_ / "new.glb");
    ASSERT_EQ(after.images.size(), 2u);
    EXPECT_EQ(after.images[1].image, before.images[1].image);
    EXPECT_EQ(after.materials[0].normalTexture.index, before.materials[0].normalTexture.index);
    const auto tangents_in = [](const tinygltf::Model& model) {
        const std::filesystem::path file = "a.glb";
        return GlbArrays(file, model).quads(attribute_of(model.meshes.at(0).primitives.at(0), "TANGENT"));
    };
    EXPECT_EQ(tangents_in(after), tangents_in(before));
    EXPECT_THAT(tangents_in(after), testing::Each(glm::vec4(1, 0, 0, 1)));
    changed("small.glb", {.without_texture = true});
    const tinygltf::Model plain = read_glb(folder_ / "new.glb");
    EXPECT_TRUE(plain.images.empty());
    EXPECT_EQ(plain.materials.at(0).normalTexture.index, -1);
    EXPECT_EQ(attribute_of(plain.meshes.at(0).primitives.at(0), "TANGENT"), -1);
}

TEST_F(RewriteGlb, WithoutTextureVerticesHaveItsColours) {
    const SceneParts after = changed("small.glb", {.without_texture = true});
    EXPECT_TRUE(after.pages.empty());
    const float scale = after.materials[after.parts[0].material].kd_over_base();
    for (const glm::vec3 base : after.parts[0].base) expect_near(glm::dvec3(scale * base), glm::dvec3(kTexel), 5e-3);
}

TEST_F(RewriteGlb, PagesOfHalfTheResolution) {
    const SceneParts before = read_scene_parts(folder_ / "small.glb"), after = changed("small.glb", {.halvings = 2});
    EXPECT_EQ(after.parts[0].places, before.parts[0].places);
    ASSERT_EQ(after.pages.size(), 1u);
    EXPECT_EQ(decoded(after.pages[0]).extent(), (Extent2D{32, 32})) << "as small as pages become";
    EXPECT_EQ(decoded(after.pages[0]).at(3, 3), decoded(before.pages[0]).at(3, 3));
    EXPECT_EQ(read_glb(folder_ / "new.glb").images[0].extras.Get("texel_m").GetNumberAsDouble(), 0.004);
}

TEST_F(RewriteGlb, FewerTriangles) {
    EXPECT_EQ(triangles_in(folder_ / "sheet.glb"), 2u * 29 * 29);
    const SceneParts after = changed("sheet.glb", {.triangles = 700});
    EXPECT_LE(after.triangles(), 750u);
    EXPECT_GE(after.triangles(), 400u);
    EXPECT_THAT([&] { changed("sheet.glb", {.triangles = 5000}); },
                throws_error_with("has 1682 triangles, fewer than the 5000 that are asked for"));
}

TEST_F(RewriteGlb, UpIsWhereItIsSaidToBe) {
    const SceneParts after = changed("sheet.glb", {.up = glm::dvec3(1, 0, 0)});
    const auto [low, high] = bounds_of(after);
    EXPECT_NEAR(high.y - low.y, 0.29, 1e-4);  // the sheet is 29 cm long in x
    EXPECT_NEAR(low.y, 0, 0.02);
}

}  // namespace
}  // namespace patina::scene_parts_test
