#include <cstring>

#include "tests/cli/run_folder.h"

// What changes the bytes of a run with materials, and what does not.

namespace patina::testing::same_bytes_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using sensor::testing::write_text;

/// The values of the first mesh's attribute in a binary glTF, as bytes.
std::string attribute_of(const std::string& glb, const char* name) {
    uint32_t json_bytes = 0;
    std::memcpy(&json_bytes, glb.data() + 12, sizeof json_bytes);
    const nlohmann::json gltf = nlohmann::json::parse(glb.substr(20, json_bytes));
    std::string values;
    for (const auto& mesh : gltf["meshes"]) {
        const auto& attributes = mesh["primitives"][0]["attributes"];
        const auto& accessor = gltf["accessors"][attributes[name].get<size_t>()];
        const auto& view = gltf["bufferViews"][accessor["bufferView"].get<size_t>()];
        const size_t first = 20 + json_bytes + 8 + view.value("byteOffset", size_t{0});
        values += glb.substr(first, view["byteLength"].get<size_t>());
    }
    return values;
}

class SameBytes : public RunFolderTest {
  protected:
    void record(const char* frames) {
        const Outcome outcome = patina({"synth", "cubes", "--frames", frames, "--extent", "128x106", "--no-lighting",
                                        "--quiet", "--out", recording_});
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        fs::copy_file(recording_ / "truth/lights.json", lights_);
    }

    /// Of a run with these lights: all files but those that hold times.
    std::map<std::string, std::string> files_of_run(std::vector<std::string> more) {
        std::vector<std::string> arguments{"run",     recording_,     "--lights", lights_,    "--out", out(),
                                           "--quiet", "--dump-every", "2",        "--detail", "coarse"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = patina(arguments);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        std::map<std::string, std::string> files = files_in(out());
        for (const char* name : {"run.json", "report.html"}) files.erase(name);
        fs::remove_all(out());
        return files;
    }

    static void expect_same(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
        ASSERT_EQ(a.size(), b.size());
        EXPECT_TRUE(a.contains("scene.glb") && a.contains("materials.json"));
        for (const auto& [name, content] : a) EXPECT_TRUE(b.contains(name) && b.at(name) == content) << name;
    }

    const fs::path recording_ = beside("recording"), lights_ = beside("lights.json");
};

TEST_F(SameBytes, TruthBesideTheFramesChangesNothing) {
    record("4");
    // As of a camera whose pictures blur; the limit makes all that moves blurred.
    for (const bool blurs : {false, true}) {
        if (blurs) {
            nlohmann::json sequence = nlohmann::json::parse(read_text(recording_ / "sequence.json"));
            EXPECT_EQ(sequence["color"]["motion_blur"], false) << "synth says that rendered pictures do not blur";
            sequence["color"].erase("motion_blur");
            write_text(recording_ / "sequence.json", sequence.dump());
        }
        const std::vector<std::string> more{
            "--set",     "observe.max_blur_px=0.001", "--set", "observe.smeared_observations=0", "--no-map",
            "--texture", blurs ? "off" : "8"};
        const auto with_truth = files_of_run(more);
        fs::rename(recording_ / "truth", beside("truth"));
        const auto without_truth = files_of_run(more);
        fs::rename(beside("truth"), recording_ / "truth");
        SCOPED_TRACE(blurs ? "blurred" : "sharp");
        expect_same(with_truth, without_truth);
    }
}

TEST_F(SameBytes, ASeedChangesMaterialsAndNeitherPathNorLights) {
    record("8");  // until the network has seen a segment
    const auto zero = files_of_run({"--texture", "off", "--no-map"}),
               one = files_of_run({"--texture", "off", "--no-map", "--seed", "1"}),
               again = files_of_run({"--texture", "off", "--no-map", "--seed", "1"});
    expect_same(one, again);
    EXPECT_FALSE(one.at("scene.glb") == zero.at("scene.glb"));
    EXPECT_FALSE(one.at("materials.json") == zero.at("materials.json")) << "the network is shown other voxels";
    EXPECT_TRUE(one.at("trajectory.txt") == zero.at("trajectory.txt"));
    EXPECT_TRUE(one.at("lights.json") == zero.at("lights.json"));
}

TEST_F(SameBytes, ASeedRoundsColoursAndLeavesTheSurface) {
    record("4");
    const auto scene_of = [&](std::vector<std::string> more) {
        more.insert(more.end(),
                    {"--lighting", "none", "--labels", "off", "--surface-error", "0", "--texture", "off", "--no-map"});
        run_quietly(recording_, std::move(more));
        return read_text(out() / "scene.glb");
    };
    const std::string plain = scene_of({}), zero = scene_of({"--seed", "0"}), one = scene_of({"--seed", "1"});
    EXPECT_EQ(summary_of(out())["seed"], 1);
    EXPECT_TRUE(plain == zero) << "the default";
    ASSERT_GT(attribute_of(zero, "POSITION").size(), 10000u);
    EXPECT_TRUE(attribute_of(zero, "POSITION") == attribute_of(one, "POSITION"));
    EXPECT_TRUE(attribute_of(zero, "NORMAL") == attribute_of(one, "NORMAL"));
    EXPECT_FALSE(attribute_of(zero, "COLOR_0") == attribute_of(one, "COLOR_0"));
}

TEST_F(SameBytes, ASeedIsAlsoThatOfASyntheticScenesNoise) {
    write_text(beside("noisy.json"), R"({
        "objects": [{"name": "wall", "material": {"kd": 0.5, "ks": 0.04, "alpha": 0.1},
                     "parts": [{"rectangle": {"size": [4, 4]}}]}],
        "lights": [{"position": [0, -1, -2], "intensity": 4}],
        "camera": {"width": 64, "height": 53, "fx": 46, "fy": 46, "cx": 31.5, "cy": 26},
        "path": {"orbit": {"target": [0, 0, 0], "distance": 2, "azimuth_degrees": 180}},
        "recording": {"noise": "kinect2", "pose_noise": {"translation": 0.01, "rotation_degrees": 0.1}, "seed": 3}})");
    const auto path_of = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"--texture", "off", "--no-map"});
        run_quietly("synthetic:" + beside("noisy.json").string(), std::move(more));
        return read_text(out() / "trajectory.txt");
    };
    const std::string plain = path_of({"--frames", "2"});
    EXPECT_EQ(path_of({"--frames", "2", "--seed", "3"}), plain) << "what the scene says";
    EXPECT_NE(path_of({"--frames", "2", "--seed", "4"}), plain);
}

TEST_F(SameBytes, WhatSteersATerminalIsNotPrinted) {
    record("4");
    const fs::path steering = beside("a\033[31mb");
    fs::rename(recording_, steering);
    fs::remove(steering / "color/000001.png");
    const Outcome outcome =
        patina({"run", steering, "--lighting", "none", "--texture", "off", "--no-map", "--out", beside("c\033[2Jd")});
    ASSERT_TRUE(fs::exists(beside("c\033[2Jd") / "scene.glb")) << outcome.err;
    EXPECT_THAT(outcome.out + outcome.err, ::testing::Not(::testing::HasSubstr("\033")));
    EXPECT_THAT(outcome.err, ::testing::HasSubstr("a\\x1b[31mb/color/000001 is missing"));
    EXPECT_THAT(outcome.out, ::testing::HasSubstr("c\\x1b[2Jd"));
    EXPECT_THAT(expect_failure(patina({"info", beside("e\033]0;f")})), ::testing::HasSubstr("e\\x1b]0;f does not"));
    EXPECT_THAT(patina({"info", steering}).out, ::testing::HasSubstr("a\\x1b[31mb/color/000001 is missing"));
}

}  // namespace
}  // namespace patina::testing::same_bytes_test
