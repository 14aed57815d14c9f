// The viewer as a user meets it: off screen, and in a window on a display without a screen.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <set>

#include "sensor/files/picture_file.h"
#include "sensor/recording/container.h"
#include "sensor/truth.h"
#include "tests/cli/run_folder.h"

namespace patina::testing::viewer_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr Extent2D kExtent{96, 64};
constexpr const char* kLayers[] = {"color",   "rerendering", "kd",         "ks",      "alpha",
                                   "normals", "segments",    "confidence", "coverage"};

bool installed(const std::string& program) { return shell("command -v " + program + " > /dev/null") == 0; }

class Viewer : public RunFolderTest {
  protected:
    /// A run of a built-in scene.
    void run_cubes(std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"run",       small_cubes(), "--frames", "4",        "--out", out(),
                                           "--texture", "off",         "--quiet",  "--detail", "coarse"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = patina(arguments);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    }

    Outcome view(const fs::path& to, std::vector<std::string> more) {
        std::vector<std::string> arguments{"view", out(), "--offscreen", to, "--extent", "96x64"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return patina(arguments);
    }

    static Image<SrgbPixel> read(const fs::path& file) {
        return std::get<Image<SrgbPixel>>(sensor::read_color(file, kExtent));
    }

    static size_t distinct(const Image<SrgbPixel>& picture) {
        std::set<std::array<uint8_t, 3>> colors;
        for (const SrgbPixel& pixel : picture.pixels()) colors.insert({pixel.r, pixel.g, pixel.b});
        return colors.size();
    }

    static bool has_display() { return installed("Xvfb") && installed("xdotool"); }

    /// Runs a command of the program in a window on a display of its own, whose number Xvfb chooses; then `script`, in
    /// which $window is it, and has been drawn; then closes it as a user would. Returns the exit code.
    int in_window(const std::string& command, const std::string& script) const {
        return shell("cd " + beside(".").string() + R"sh(
        exec 3> display
        Xvfb -displayfd 3 -fbdir . -screen 0 1024x768x24 -nolisten tcp 2> /dev/null & server=$!
        for i in $(seq 100); do [ -s display ] && break; sleep 0.1; done
        export DISPLAY=:$(cat display)
        screen() { cksum < Xvfb_screen0; }
        # Waits until the screen is not as it was before. What a user does within one frame is taken as one.
        changed() { for k in $(seq 200); do [ "$(screen)" != "$before" ] && break; sleep 0.1; done; }
        does() { before=$(screen); "$@"; changed; }
        # Waits until the screen rests.
        settle() {
            rests=0
            while [ $rests -lt 3 ]; do
                before=$(screen); sleep 0.3
                [ "$(screen)" = "$before" ] && rests=$((rests + 1)) || rests=0
            done
        }
        before=$(screen)
        $PATINA )sh" +
                     command +
                     R"sh( > said 2> complaint & viewer=$!
        window=$(timeout 120 xdotool search --sync --onlyvisible --name '^patina' | head -n 1)
        # Until the window has the focus, keys are lost.
        for i in $(seq 100); do
            xdotool windowfocus $window 2> /dev/null
            [ $(xdotool getwindowfocus) = $window ] && break
            sleep 0.2
        done
        changed)sh" + script +
                     R"(
        xdotool key ctrl+q
        wait $viewer; ended=$?
        kill $server; wait $server 2> /dev/null
        exit $ended)");
    }

    void expect_no_viewer_is_one_sentence(const Outcome& outcome) {
        EXPECT_THAT(expect_failure(outcome), HasSubstr("this patina has no viewer"));
    }

    /// Whether this program was built without one.
    static bool absent() {
        const Outcome outcome = patina({"view", "/nowhere", "--offscreen", "/nowhere/x.png"});
        return outcome.err.find("this patina has no viewer") != std::string::npos;
    }
};

TEST_F(Viewer, EveryLayerOfAMapIsAPictureOfItsOwnAndTheSameEachTime) {
    if (absent()) GTEST_SKIP() << "built without libglfw3-dev or libimgui-dev";
    run_cubes({"--labels", "truth", "--materials", "truth"});  // known from the first frame on
    std::vector<std::vector<SrgbPixel>> pictures;
    for (const char* layer : kLayers) {
        const fs::path file = beside(std::string(layer) + ".png"), again = beside("again.png");
        const Outcome outcome = view(file, {"--layer", layer, "--no-panels"});
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_THAT(outcome.out, HasSubstr(std::string("1 frames; layer ") + layer));
        ASSERT_EQ(view(again, {"--layer", layer, "--no-panels", "--quiet"}).exit_code, 0);
        EXPECT_EQ(read(file).pixels(), read(again).pixels()) << layer;
        EXPECT_GT(distinct(read(file)), 3u) << layer << " is not blank";
        pictures.push_back(read(file).pixels());
        for (size_t i = 0; i + 1 < pictures.size(); ++i)
            EXPECT_NE(pictures[i], pictures.back()) << kLayers[i] << " and " << layer;
    }
    // With panels over it.
    ASSERT_EQ(view(beside("panels.png"), {"--layer", "color"}).exit_code, 0);
    EXPECT_NE(read(beside("panels.png")).pixels(), pictures.front());
    // Around the model, as numbered pictures.
    ASSERT_EQ(view(beside("orbit-##.png"), {"--orbit", "3", "--no-panels"}).exit_code, 0);
    EXPECT_NE(read(beside("orbit-00.png")).pixels(), read(beside("orbit-02.png")).pixels());
    EXPECT_FALSE(fs::exists(beside("orbit-03.png")));
}

TEST_F(Viewer, ARunDrawsItsSceneWhileItGrowsAndItsResultIsTheSame) {
    if (absent()) GTEST_SKIP() << "built without libglfw3-dev or libimgui-dev";
    const std::vector<std::string> run{"run", small_cubes(), "--frames", "3",      "--lighting", "none", "--texture",
                                       "off", "--no-map",    "--detail", "coarse", "--quiet",    "--out"};
    std::vector<std::string> plain = run, drawn = run;
    plain.push_back(beside("plain"));
    drawn.insert(drawn.end(), {beside("drawn"), "--offscreen", beside("frame-#.png"), "--window-extent", "96x64",
                               "--no-panels", "--layer", "normals"});
    ASSERT_EQ(patina(plain).exit_code, 0);
    const Outcome outcome = patina(drawn);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    for (int i = 0; i < 3; ++i) EXPECT_GT(distinct(read(beside("frame-" + std::to_string(i) + ".png"))), 3u) << i;
    EXPECT_NE(read(beside("frame-0.png")).pixels(), read(beside("frame-2.png")).pixels());
    EXPECT_EQ(files_in(beside("plain")).at("scene.glb"), files_in(beside("drawn")).at("scene.glb"));
}

TEST_F(Viewer, BadInputIsOneSentence) {
    if (absent()) return expect_no_viewer_is_one_sentence(view(beside("x.png"), {}));
    EXPECT_THAT(expect_failure(view(beside("x.png"), {})), HasSubstr("does not exist"));
    fs::create_directory(out());
    EXPECT_THAT(expect_failure(view(beside("x.png"), {})), HasSubstr("--no-map"));
    EXPECT_THAT(expect_failure(view(beside("x.png"), {"--layer", "colour"}), 2), HasSubstr("color"));
    EXPECT_FALSE(fs::exists(beside("x.png")));
    const Outcome no_display =
        patina({"run", sequence(), "--out", out(), "--window", "--quiet"}, {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}});
    EXPECT_THAT(expect_failure(no_display), HasSubstr("--offscreen"));
    const Outcome other = patina({"run", sequence(), "--out", out(), "--offscreen", beside("x.gif"), "--quiet"});
    EXPECT_THAT(expect_failure(other), HasSubstr("must be a .png, an .mp4 or an .avi"));
}

/// A wall 1 m before the camera, which is not turned, and a lamp between the two.
TEST_F(Viewer, AWindowTakesKeysAndTheMouse) {
    if (absent()) GTEST_SKIP() << "built without libglfw3-dev or libimgui-dev";
    if (!has_display()) GTEST_SKIP() << "Xvfb or xdotool is not installed";
    const fs::path lamp = beside("lamp.json");
    // The window's picture has a focal length of 462 pixels; its middle is where the camera looks to.
    sensor::write_lights(lamp, std::vector<Light>{{{-80 * 0.6 / 462, -80 * 0.6 / 462, 0.6}, glm::dvec3(1)}});
    run_quietly(sequence(), {"--frames", "1", "--lights", lamp, "--texture", "off", "--detail", "coarse"});
    // 760 pixels leave 180 between the panels. The surface that is clicked becomes the point that the camera turns
    // around, 2 m before it; a turn by 75 pixels is one of 30 degrees.
    const int exit_code = in_window("view " + out().string() + " --layer color --extent 760x400", R"(
        at() { xdotool mousemove --window $window $1 $2; sleep 0.1; }
        at 300 120; does xdotool mousedown 1  # the lamp is marked
        at 300 150; settle; does xdotool mouseup 1
        at 380 200; does xdotool click 1  # the answer is a mark, and a panel
        does xdotool key f
        xdotool mousedown 2; at 415 200; at 455 200; settle; xdotool mouseup 2
        xdotool key e
        for i in $(seq 100); do [ -e out-export-1/scene.glb ] && break; sleep 0.2; done)");
    EXPECT_EQ(exit_code, 0) << files_in(beside("."))["complaint"];
    const std::string said = files_in(beside("."))["said"];
    EXPECT_THAT(said, HasSubstr("layer rerendering")) << "the lamp was dragged";
    EXPECT_TRUE(fs::exists(beside("out-export-1") / "scene.glb"));
    double x = 0, y = 0, z = 0;
    ASSERT_EQ(
        std::sscanf(said.c_str() + std::min(said.find(", from "), said.size()), ", from %lf, %lf, %lf", &x, &y, &z), 3)
        << said;
    constexpr double kWall_m = 1.013, kTurn = std::numbers::pi / 6, kTolerance_m = 0.03;
    EXPECT_NEAR(x, -2 * std::sin(kTurn), kTolerance_m);
    EXPECT_NEAR(y, 0, kTolerance_m);
    EXPECT_NEAR(z, kWall_m - 2 * std::cos(kTurn), kTolerance_m);
}

TEST_F(Viewer, ALiveSourceIsRecordedAndUndone) {
    if (absent()) GTEST_SKIP() << "built without libglfw3-dev or libimgui-dev";
    if (!has_display()) GTEST_SKIP() << "Xvfb or xdotool is not installed";
    // Two minutes of a camera that takes two pictures a second.
    const fs::path slow = beside("slow");
    ASSERT_EQ(
        patina({"synth", "cubes", "--frames", "240", "--extent", "48x40", "--no-lighting", "--quiet", "--out", slow})
            .exit_code,
        0);
    std::ifstream given(slow / "trajectory.txt");
    std::string poses, times;
    int count = 0;
    for (std::string line; std::getline(given, line);) {
        if (line.starts_with('#')) continue;
        times += std::to_string(count) + " " + std::to_string(count / 2.0) + "\n";
        poses += std::to_string(count++ / 2.0) + line.substr(line.find(' ')) + "\n";
    }
    std::ofstream(slow / "timestamps.txt") << times;
    std::ofstream(slow / "trajectory.txt") << poses;
    const fs::path recording = beside("out-recording-1.patina");
    const int exit_code = in_window("live --simulate " + slow.string() + " --out " + out().string() +
                                        " --window --window-extent 640x480 --lighting none --texture off "
                                        "--set map.voxel_m=0.02",
                                    R"(
        # The second button, at the bottom in the middle; it is there once the run has begun.
        for i in $(seq 100); do
            xdotool mousemove --window $window 277 452; sleep 0.3
            xdotool mousedown 1; sleep 0.3; xdotool mouseup 1; sleep 0.6
            [ -e out-recording-1.patina ] && break
        done
        sleep 6
        xdotool key r; sleep 1
        # Nothing is fused during a pause, in which four frames come: both exports are the same.
        xdotool key space; sleep 1
        for i in 1 2; do
            xdotool key e
            for k in $(seq 100); do [ -e out-export-$i/scene.glb ] && break; sleep 0.2; done
            [ $i = 1 ] && sleep 2
        done
        xdotool key space; sleep 1
        xdotool key ctrl+z; sleep 4)");
    EXPECT_EQ(exit_code, 0) << files_in(beside("."))["complaint"];
    EXPECT_EQ(files_in(beside("out-export-1")), files_in(beside("out-export-2"))) << "it was paused";
    EXPECT_NE(files_in(beside("out-export-2"))["scene.glb"], files_in(out())["scene.glb"]) << "it went on";
    const auto summary = summary_of(out());
    EXPECT_GE(summary["frames"].value("undone", 0), 1);
    EXPECT_THAT(files_in(beside("."))["said"], HasSubstr(" undone)"));
    EXPECT_EQ(summary["live"]["recordings"][0]["file"], recording.string());
    const uint32_t frames = *sensor::RecordingFile(recording).sequence(sensor::SequenceRole::kMain).info.frames;
    EXPECT_GE(frames, 5u);
    EXPECT_LT(frames, summary["live"]["captured"]);
}

}  // namespace
}  // namespace patina::testing::viewer_test
