#include "tests/cli/run_folder.h"

// What `patina info` tells of a scene.

namespace patina::testing::info_test {
namespace {

using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Info : public RunFolderTest {};

TEST_F(Info, OfABuiltInSceneIsToldWithoutRenderingIt) {
    const Outcome outcome = patina({"info", "synthetic:cubes"}, {{"VK_DRIVER_FILES", "/nonexistent"}});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("sequence      cubes (synthetic)\n"), HasSubstr("frames        120 "),
                                   HasSubstr("time          3.97 s at 30 frames/s\n"),
                                   HasSubstr("depth camera  512 x 424, fx 365 "), HasSubstr("registered to depth\n")));
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("objects       13, "), HasSubstr("light         intensity "),
                                   HasSubstr("lighting      60 frames, exposed 0.0")));
}

TEST_F(Info, OfASceneFileCountsWhatItHolds) {
    write_text(beside("a.json"), R"({
        "name": "a\u001b[31mb",
        "objects": [{"name": "floor", "material": {"kd": 0.5, "ks": 0.04, "alpha": 0.1},
                     "parts": [{"rectangle": {"size": [4, 4]}}]}],
        "lights": [{"position": [1, -2, 0.5], "intensity": [8, 7, 6]}],
        "environment": {"uniform": {"radiance": [1, 2, 3]}},
        "color_camera": {"camera": {"width": 64, "height": 48, "fx": 50, "fy": 50, "cx": 31.5, "cy": 23.5},
                         "color_from_depth": [1, 0, 0, 0.05, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
        "path": {"orbit": {"target": [0, 0, 0], "distance": 2, "elevation_degrees": 30}},
        "recording": {"noise": "kinect2", "pose_noise": {"translation": 0.01, "rotation_degrees": 0.1}}})");
    const Outcome outcome = patina({"info", "synthetic:" + beside("a.json").string()});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out,
                AllOf(HasSubstr("sequence      a\\x1b[31mb (synthetic)\n"), HasSubstr("colour camera 64 x 48, fx 50 "),
                      HasSubstr("50.0 mm from the depth"), HasSubstr("noise         of depth, colour, poses\n")));
    EXPECT_THAT(outcome.out,
                AllOf(HasSubstr("objects       1, 0 of them textured, 0 triangles"),
                      HasSubstr("light         intensity 8.000 7.000 6.000 at 1.000 -2.000 0.500 m, a"),
                      HasSubstr("environment   mean radiance 1.000 2.000 3.000\n"), HasSubstr("lighting      none")));
}

}  // namespace
}  // namespace patina::testing::info_test
