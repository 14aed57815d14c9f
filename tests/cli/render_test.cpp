#include "tools/render/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <span>

#include "export/write_exr.h"
#include "sensor/files/picture_file.h"
#include "sensor/truth.h"
#include "tests/cli/run_folder.h"
#include "tools/render/orbit.h"

// Views of a reconstruction as a user asks for them, and the poses of an orbit.

namespace patina::testing::render_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Render : public RunFolderTest {
  protected:
    /// Renders views of two frames of a scene, small.
    void render_cubes(const fs::path& to, std::vector<std::string> more) {
        std::vector<std::string> arguments{"render",   small_cubes(), "--frames", "2",     "--extent", "64x48",
                                           "--detail", "coarse",      "--quiet",  "--out", to.string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = patina(arguments);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(outcome.out + outcome.err, "");
    }

    /// The line by which `patina render SEQUENCE --out beside("views")` with these arguments fails; nothing is left.
    std::string complaint(std::vector<std::string> more, int exit_code = 1) {
        std::vector<std::string> arguments{"render", sequence().string(), "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const std::string message = expect_failure(patina(arguments), exit_code);
        for (const auto& entry : fs::directory_iterator(beside(".")))
            EXPECT_THAT(entry.path().filename().string(), ::testing::Not(HasSubstr("partial")));
        EXPECT_FALSE(fs::exists(beside("views")));
        return message;
    }

    static Image<SrgbPixel> read(const fs::path& file) {
        return std::get<Image<SrgbPixel>>(sensor::read_color(file, {64, 48}));
    }

    static double brightness(const Image<SrgbPixel>& picture) {
        double sum = 0;
        for (const SrgbPixel& pixel : picture.pixels()) sum += pixel.r + pixel.g + pixel.b;
        return sum / (3.0 * static_cast<double>(picture.pixels().size()));
    }

    fs::path lights(double strength) const {
        const fs::path file = beside("lights" + std::to_string(strength) + ".json");
        sensor::write_lights(file, std::vector<Light>{{{0, -1.5, 0}, glm::dvec3(strength)}});
        return file;
    }

    /// Of one radiance, from all sides or from those of the picture's right half.
    std::string environment(const char* name, float radiance, bool half = false) const {
        const fs::path file = beside(name);
        constexpr Extent2D kExtent{64, 32};
        Image<glm::vec3> picture(kExtent, glm::vec3(radiance));
        for (uint32_t y = 0; half && y < kExtent.height; ++y) {
            for (uint32_t x = 0; x < kExtent.width / 2; ++x) picture.at(x, y) = glm::vec3(0);
        }
        std::vector<ExrChannel> channels;
        for (int c = 0; c < 3; ++c)
            channels.push_back({std::string(1, "RGB"[c]), kExtent, &picture.pixels().front()[c], 3});
        write_exr(file, channels);
        return file.string();
    }
};

TEST_F(Render, RecordedPosesOrbitAndVideo) {
    render_cubes(beside("recorded"), {"--lighting", "none"});
    EXPECT_EQ(files_in(beside("recorded")).size(), 2u);
    EXPECT_EQ(read(beside("recorded") / "000001.png").extent(), (Extent2D{64, 48}));

    render_cubes(beside("orbit"),
                 {"--lighting", "none", "--orbit", "5", "--orbit-seconds", "2", "--video", beside("orbit.avi")});
    EXPECT_EQ(files_in(beside("orbit")).size(), 5u);
    EXPECT_GT(fs::file_size(beside("orbit.avi")), 1000u);
}

TEST_F(Render, PosesOfAFileAreThoseOfASequence) {
    run_quietly(small_cubes(),
                {"--frames", "2", "--lighting", "none", "--detail", "coarse", "--texture", "off", "--no-map"});
    render_cubes(beside("recorded"), {"--lighting", "none"});
    render_cubes(beside("given"), {"--lighting", "none", "--poses", out() / "trajectory.txt"});
    const auto recorded = read(beside("recorded") / "000001.png"), given = read(beside("given") / "000001.png");
    size_t same = 0;
    for (size_t i = 0; i < given.pixels().size(); ++i) same += given.pixels()[i] == recorded.pixels()[i];
    EXPECT_GT(same, given.pixels().size() * 9 / 10) << "the file's poses have six decimals";
}

TEST_F(Render, OtherLightsLightTheSameAlbedo) {
    const fs::path own = lights(8), dim = lights(2);
    render_cubes(beside("own"), {"--lights", own});
    render_cubes(beside("dim"), {"--lights", own, "--relight", dim});
    render_cubes(beside("same"), {"--lights", own, "--relight", own});
    render_cubes(beside("exposed"), {"--lights", own, "--relight", dim, "--exposure", "4"});
    render_cubes(beside("kd"), {"--lights", own, "--relight", own, "--show", "kd"});
    render_cubes(beside("kd_dim"), {"--lights", own, "--relight", dim, "--show", "kd"});
    const fs::path bright = beside("bright.json");
    sensor::write_lights(bright, std::vector<Light>{{{0, -1.5, 0}, glm::dvec3(2)}}, glm::dvec3(0.5));
    render_cubes(beside("bright"), {"--lights", own, "--relight", bright});
    const auto picture = [&](const char* name) { return read(beside(name) / "000000.png"); };
    EXPECT_LT(brightness(picture("dim")), 0.8 * brightness(picture("own")));
    EXPECT_GT(brightness(picture("bright")), brightness(picture("dim")) + 10) << "ambient light";
    EXPECT_NEAR(brightness(picture("exposed")), brightness(picture("same")), 2);
    EXPECT_EQ(picture("kd").pixels(), picture("kd_dim").pixels()) << "albedo does not change with the lights of a view";
}

TEST_F(Render, AnEnvironmentLightsWhatNothingIsInFrontOf) {
    const fs::path own = lights(8);
    const std::string whole = environment("whole.exr", 0.3f), half = environment("half.exr", 0.3f, true);
    const auto picture = [&](const char* name, std::vector<std::string> more) {
        more.insert(more.end(), {"--lights", own});
        render_cubes(beside(name), more);
        return read(beside(name) / "000000.png");
    };
    const Image<SrgbPixel> all_around = picture("whole", {"--relight", whole});
    const Image<SrgbPixel> one_half = picture("half", {"--relight", half});
    const Image<SrgbPixel> turned = picture("turned", {"--relight", half, "--relight-turn", "180"});
    EXPECT_GT(brightness(picture("both", {"--relight", whole, "--relight", own})), brightness(all_around) + 10);
    EXPECT_GT(brightness(all_around), brightness(one_half) + 10);
    EXPECT_GT(brightness(all_around), brightness(turned) + 10);
    EXPECT_NE(one_half.pixels(), turned.pixels());
}

TEST_F(Render, ShowsWhatARunWouldHaveHad) {
    // The scene has a lighting sequence of its own, in which run finds the lights.
    render_cubes(beside("kd"), {"--show", "kd"});
    const auto grey_share = [](const Image<SrgbPixel>& picture) {
        size_t grey = 0;
        for (const SrgbPixel& pixel : picture.pixels()) grey += pixel.r == pixel.g && pixel.g == pixel.b;
        return static_cast<double>(grey) / static_cast<double>(picture.pixels().size());
    };
    EXPECT_LT(grey_share(read(beside("kd") / "000001.png")), 0.9) << "albedo, not emptiness";
    // Segments need no lights.
    render_cubes(beside("labels"), {"--lighting", "none", "--show", "labels"});
    std::set<std::array<uint8_t, 3>> colours;
    const Image<SrgbPixel> labels = read(beside("labels") / "000001.png");
    for (const SrgbPixel& pixel : labels.pixels()) colours.insert({pixel.r, pixel.g, pixel.b});
    EXPECT_GT(colours.size(), 5u);
}

TEST_F(Render, BadInputIsOneSentenceAndLeavesNothing) {
    const std::string views = beside("views");
    EXPECT_THAT(complaint({}), HasSubstr("give --out FOLDER or --video FILE"));
    EXPECT_THAT(complaint({"--out", views, "--orbit", "3", "--poses", "x"}, 2), HasSubstr("--orbit"));
    EXPECT_THAT(complaint({"--out", views, "--orbit", "0"}, 2), HasSubstr("--orbit"));
    EXPECT_THAT(complaint({"--out", views, "--orbit-seconds", "3"}, 2), HasSubstr("--orbit"));
    EXPECT_THAT(complaint({"--out", views, "--extent", "0x3"}, 2), HasSubstr("WIDTHxHEIGHT"));
    EXPECT_THAT(complaint({"--out", views, "--exposure", "-1"}, 2), HasSubstr("--exposure"));
    EXPECT_THAT(complaint({"--out", views, "--show", "beauty"}, 2), HasSubstr("beauty"));
    EXPECT_THAT(complaint({"--out", views, "--show", "kd", "--lighting", "none"}),
                AllOf(HasSubstr("--show kd needs lights: give lights "), HasSubstr("(--lights FILE, ")));
    EXPECT_THAT(expect_failure(patina({"render", beside("nowhere"), "--out", views, "--show", "kd"})),
                HasSubstr("nowhere does not exist"))
        << "not that lights are missing";
    EXPECT_THAT(complaint({"--out", views, "--relight", lights(1), "--lighting", "none"}),
                HasSubstr("--relight needs lights: give"));
    const std::string sky = environment("sky.exr", 1), wrong = environment("wrong.exr", -1);
    EXPECT_THAT(complaint({"--out", views, "--lights", lights(1), "--relight", sky, "--relight", sky}),
                HasSubstr("a second environment"));
    EXPECT_THAT(complaint({"--out", views, "--lights", lights(1), "--relight", wrong}),
                AllOf(HasSubstr("wrong.exr"), HasSubstr("-1")));
    EXPECT_THAT(complaint({"--out", views, "--relight-turn", "5"}, 2), HasSubstr("--relight"));
    EXPECT_THAT(complaint({"--out", views, "--relight", lights(1), "--relight-turn", "5"}),
                HasSubstr("--relight names none"));
    sensor::write_lights(beside("many.json"), std::vector<Light>(40, Light{{0, -1.5, 0}, glm::dvec3(1)}));
    EXPECT_THAT(complaint({"--out", views, "--relight", beside("many.json"), "--relight", beside("many.json")}),
                AllOf(HasSubstr("80 lamps"), HasSubstr("64")));
    EXPECT_THAT(complaint({"--out", views, "--show", "labels", "--labels", "off"}), HasSubstr("--labels is off"));
    EXPECT_THAT(complaint({"--out", views, "--poses", beside("none.txt")}), HasSubstr("none.txt"));
    write_text(beside("poses.txt"), "0 0 0 0 0 0 0 1\n1 nan 0 0 0 0 0 1\n");
    EXPECT_THAT(complaint({"--out", views, "--poses", beside("poses.txt")}), HasSubstr("poses.txt:2"));
    EXPECT_THAT(complaint({"--video", beside("a.gif")}), HasSubstr("must be a .avi or a .mp4"));
    EXPECT_THAT(complaint({"--out", views, "--video", beside("none") / "a.avi"}), HasSubstr("there is no folder"));
    fs::create_directory(beside("mine"));
    write_text(beside("mine/a.png"), "my own picture");
    EXPECT_THAT(expect_failure(patina({"render", sequence(), "--out", beside("mine")})), HasSubstr("is not empty"));
}

RigidTransform looking(glm::dvec3 from, glm::dvec3 at) {
    const glm::dvec3 z = glm::normalize(at - from), x = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), z));
    return {glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(from, 1)};
}

/// Cameras that look at a centre from 2 m away and 1 m above it; world y points down.
std::vector<RigidTransform> cameras_around(glm::dvec3 center, std::span<const double> degrees) {
    std::vector<RigidTransform> cameras;
    for (const double side : degrees) {
        const double angle = side * std::numbers::pi / 180;
        cameras.push_back(looking(center + glm::dvec3(2 * std::sin(angle), -1, -2 * std::cos(angle)), center));
    }
    return cameras;
}

/// From which side a pose looks at the centre, in degrees.
double side_of(const RigidTransform& pose, glm::dvec3 center) {
    const glm::dvec3 offset = glm::dvec3(pose[3]) - center;
    return std::atan2(offset.x, -offset.z) * 180 / std::numbers::pi;
}

TEST(Orbit, GoesAroundLevelAtTheCamerasDistanceAndHeight) {
    const glm::dvec3 center(0.5, 0.25, 3);
    const auto recorded = cameras_around(center, std::array{0.0, 80.0, 160.0, 240.0, 300.0});
    const auto poses = tools::orbit_poses(recorded, center, 8);
    ASSERT_EQ(poses.size(), 8u);
    for (size_t i = 0; i < 8; ++i) {
        const glm::dvec3 offset = glm::dvec3(poses[i][3]) - center;
        EXPECT_NEAR(glm::length(offset), std::sqrt(5.0), 1e-6) << i;
        EXPECT_NEAR(offset.y, -1, 0.1) << i << ": level but for what uneven sides cannot tell";
        EXPECT_LT(rotation_defect(poses[i]), 1e-12);
        EXPECT_NEAR(glm::dot(glm::dvec3(poses[i][2]), glm::normalize(-offset)), 1, 1e-12) << "looks at the centre";
        EXPECT_GT(poses[i][1].y, 0.8) << "y down";
    }
    EXPECT_LT(glm::distance(glm::dvec3(poses[0][3]), glm::dvec3(recorded[0][3])), 0.1) << "begins at the first camera";
    EXPECT_GT(glm::distance(glm::dvec3(poses[0][3]), glm::dvec3(poses[4][3])), 3.9) << "and is opposite half way";
}

TEST(Orbit, KeepsToTheSidesThatCamerasLookedFrom) {
    const glm::dvec3 center(0.5, 0.25, 3);
    auto recorded = cameras_around(center, std::array{-40.0, -20.0, 0.0, 20.0, 40.0});
    // One that looks away from the centre shows nothing of it.
    recorded.push_back(looking(center + glm::dvec3(0, -1, 2), center + glm::dvec3(0, -1, 4)));
    const auto poses = tools::orbit_poses(recorded, center, 40);
    std::vector<double> sides;
    for (const RigidTransform& pose : poses) sides.push_back(side_of(pose, center));
    const auto [low, high] = std::ranges::minmax(sides);
    EXPECT_NEAR(low, -50, 2);
    EXPECT_NEAR(high, 50, 2);
    EXPECT_NEAR(sides[0], -40, 2) << "begins at the first camera";
    EXPECT_NEAR(sides[39], sides[0], 10) << "and ends where it began";
    for (size_t i = 1; i < sides.size(); ++i) EXPECT_LT(std::abs(sides[i] - sides[i - 1]), 10) << i;
}

TEST(Orbit, OneSideIsSwungAboutBothWaysAcrossTheSeamOfAngles) {
    const glm::dvec3 center(0.5, 0.25, 3);
    const auto recorded = cameras_around(center, std::array{0.0});
    for (const RigidTransform& pose : tools::orbit_poses(recorded, center, 12))
        EXPECT_LT(std::abs(side_of(pose, center)), 12) << "10, and what one camera cannot tell of up";
    // The first of these is at -170 of the angles that are counted from it.
    const auto behind = cameras_around(center, std::array{0.0, 60.0, 120.0, 170.0, 190.0});
    for (const RigidTransform& pose : tools::orbit_poses(behind, center, 24)) {
        const double side = side_of(pose, center);
        EXPECT_TRUE(side > -11 || side < -159) << side;
    }
}

TEST(Orbit, OneCameraIsEnoughAndContradictingOnesAreToldOff) {
    const RigidTransform camera(1.0);
    EXPECT_EQ(tools::orbit_poses(std::vector{camera}, {0, 0, 2}, 3).size(), 3u);
    RigidTransform upside_down(1.0);
    upside_down[0].x = upside_down[1].y = -1;
    EXPECT_THROW(tools::orbit_poses(std::vector{camera, upside_down}, {0, 0, 2}, 3), Error);
    // Straight above the centre.
    const auto close = tools::orbit_poses(std::vector{camera}, {0, 0, 0}, 2);
    EXPECT_NEAR(glm::length(glm::dvec3(close[0][3])), tools::kLeastOrbit_m, 1e-9);
}

TEST(Orbit, TheCentreIsTheMedianByCoordinate) {
    EXPECT_EQ(tools::median_point(std::vector<glm::vec3>{{1, 5, 3}, {2, 4, 1}, {900, -900, 2}}), glm::dvec3(2, 4, 2));
}

}  // namespace
}  // namespace patina::testing::render_test
