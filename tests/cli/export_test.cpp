#include "export/scene_parts.h"
#include "tests/cli/run_folder.h"

// A finished scene in other formats, as a user asks for them.

namespace patina::testing::export_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Export : public RunFolderTest {
  protected:
    void run_into(const fs::path& folder, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"run", sequence(), "--out", folder, "--set", "map.voxel_m=0.02", "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = patina(arguments);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    }

    /// Must succeed and print nothing.
    void export_quietly(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"export", "--quiet"});
        const Outcome outcome = patina(arguments);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(outcome.out + outcome.err, "");
    }

    std::string file(const std::string& name) const { return beside(name).string(); }
};

TEST_F(Export, EndingsChooseTheFormat) {
    run_into(out());
    export_quietly({out(), file("a.ply"), file("a.obj"), file("a.usdz"), file("a.glb"), "--html", file("b"), "--points",
                    file("points.ply"), "--lods"});
    EXPECT_THAT(read_text(beside("a.ply")), StartsWith("ply\nformat binary_little_endian"));
    EXPECT_THAT(read_text(beside("a.obj")), HasSubstr("mtllib a.mtl"));
    EXPECT_THAT(read_text(beside("a.mtl")), HasSubstr("newmtl"));
    EXPECT_THAT(read_text(beside("a.usdz")), HasSubstr("#usda 1.0"));
    EXPECT_THAT(read_text(beside("b")), AllOf(StartsWith("<!DOCTYPE html>"), HasSubstr("ward_point_light")));
    EXPECT_LT(read_text(beside("points.ply")).size(), read_text(beside("a.ply")).size());
    EXPECT_EQ(read_text(beside("a.glb")), read_text(out() / "scene.glb"));
    EXPECT_LT(read_text(beside("a_lod1.glb")).size(), read_text(beside("a.glb")).size());
    EXPECT_LT(read_text(beside("a_lod2.glb")).size(), read_text(beside("a_lod1.glb")).size());
    for (const auto& entry : fs::directory_iterator(beside(".")))
        EXPECT_THAT(entry.path().filename().string(), ::testing::Not(HasSubstr("partial")));
}

TEST_F(Export, WhatNeedsTheMapSaysSo) {
    run_into(out(), {"--no-map"});
    const auto complaint = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments{"export", out(), file("a.glb")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const std::string message = expect_failure(patina(arguments));
        EXPECT_FALSE(fs::exists(beside("a.glb")));
        return message;
    };
    EXPECT_THAT(complaint({"--texture", "1"}), StartsWith("--texture needs the map of the run, and '"));
    EXPECT_THAT(complaint({"--triangles", "0"}), StartsWith("--triangles 0 needs the map"));
    EXPECT_THAT(complaint({"--surface-error", "3"}), StartsWith("--surface-error needs the map"));
    EXPECT_THAT(expect_failure(patina({"export", out(), file("a.fbx")})),
                HasSubstr("ends in '.fbx', which is no format"));
    EXPECT_THAT(expect_failure(patina({"export", beside("none"), file("a.glb")})), HasSubstr("is no finished scene"));
    run_into(beside("dark"), {"--lighting", "none", "--texture", "off", "--no-map"});
    EXPECT_THAT(expect_failure(patina({"export", beside("dark"), file("a.exr")})), HasSubstr("has no lights"));
    EXPECT_THAT(expect_failure(patina({"export", out()}), 2), HasSubstr("a file to write"));
    EXPECT_THAT(expect_failure(patina({"export", out(), file("a.ply"), "--lods"}), 2), HasSubstr("a .glb to write"));
}

TEST_F(Export, AMapGivesWhatARunWithTheseChoicesWould) {
    run_into(out());
    const std::string before = read_text(out() / "map.sqlite");
    run_into(beside("other"), {"--texture", "off", "--up", "0,0,1"});
    export_quietly({out() / "map.sqlite", file("a.glb"), "--texture", "off", "--up", "0,0,1"});
    EXPECT_TRUE(read_text(beside("a.glb")) == read_text(beside("other/scene.glb")));
    EXPECT_TRUE(read_text(out() / "map.sqlite") == before) << "the map is only read";
}

TEST_F(Export, AFolderIsTurnedUpright) {
    run_into(out());
    run_into(beside("other"), {"--up", "0,0,1"});
    export_quietly({out(), file("a.glb"), "--up", "0,0,1"});
    const auto turned = bounds_of(read_scene_parts(beside("a.glb")));
    const auto expected = bounds_of(read_scene_parts(beside("other/scene.glb")));
    EXPECT_GT(glm::distance(turned[1], bounds_of(read_scene_parts(out() / "scene.glb"))[1]), 0.1f);
    // The floor is found on what was written, not on what it was made from.
    for (size_t i = 0; i < 2; ++i) EXPECT_LT(glm::distance(turned[i], expected[i]), 0.05f);
}

}  // namespace
}  // namespace patina::testing::export_test
