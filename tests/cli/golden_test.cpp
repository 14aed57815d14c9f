#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "sensor/exr_file.h"
#include "sensor/picture_file.h"
#include "tests/cli/run_folder.h"

// The built-in scene from the command line to its files, on every driver.

namespace patina::testing {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;

constexpr const char* kFrames = "12";
constexpr Extent2D kExtent{512, 424};

class Golden : public RunFolderTest {
  protected:
    static void run(const std::string& input, const fs::path& out) {
        const Outcome outcome = patina(
            {"run", input, "--out", out, "--quiet", "--frames", kFrames, "--dump-every", "4", "--lighting", "none"});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(outcome.out + outcome.err, "");
    }
};

/// run.json without what may differ between two runs.
std::string without_times(nlohmann::json record) {
    for (const char* key : {"times", "passes"}) EXPECT_EQ(record.erase(key), 1u) << key;
    return record.dump(1);
}

std::set<std::string> names(const std::map<std::string, std::string>& files) {
    std::set<std::string> set;
    for (const auto& [name, content] : files) set.insert(name);
    return set;
}

TEST_F(Golden, TwoRunsGiveTheSameBytes) {
    run("synthetic:cubes", beside("first"));
    run("synthetic:cubes", beside("second"));
    const auto first = files_in(beside("first")), second = files_in(beside("second"));
    ASSERT_EQ(names(first), names(second));
    for (const char* name : {"scene.glb", "trajectory.txt", "report.html", "run.json", "frames/000000.exr",
                             "frames/000004.exr", "frames/000008.exr", "previews/000002.png", "previews/000011.png"}) {
        EXPECT_TRUE(first.contains(name)) << name;
    }
    for (const auto& [name, content] : first) {
        if (name == "run.json" || name == "report.html") continue;  // hold times
        EXPECT_TRUE(content == second.at(name)) << name << " differs";
    }
    EXPECT_EQ(without_times(record_of(beside("first"))), without_times(record_of(beside("second"))));
}

TEST_F(Golden, TwoTrackedRunsGiveTheSameBytes) {
    const auto tracked = [&](const char* name) {
        const Outcome outcome = patina({"run", "synthetic:cubes", "--out", beside(name), "--quiet", "--frames", "4",
                                        "--lighting", "none", "--poses", "track"});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return files_in(beside(name));
    };
    const auto first = tracked("first"), second = tracked("second");
    for (const char* name : {"scene.glb", "trajectory.txt"}) EXPECT_TRUE(first.at(name) == second.at(name)) << name;
    const nlohmann::json record = record_of(beside("first"));
    EXPECT_EQ(without_times(record), without_times(record_of(beside("second"))));
    EXPECT_EQ(record["tracking"]["tracking"], 4);
    EXPECT_EQ(record["tracking"]["frames"].size(), 4u);
    EXPECT_EQ(record["tracking"]["frames"][3]["state"], "tracking");
    EXPECT_THAT(first.at("report.html"), ::testing::HasSubstr("Tracking"));
}

/// Median of |view - truth| over the pixels that both have, and the share of the true ones that the view has.
void expect_close(const Image<float>& view_m, const Image<uint16_t>& truth_mm) {
    ASSERT_EQ(view_m.extent(), truth_mm.extent());
    std::vector<float> errors_m;
    size_t with_truth = 0;
    for (size_t i = 0; i < view_m.pixels().size(); ++i) {
        const float truth_m = static_cast<float>(truth_mm.pixels()[i]) * 0.001f;
        // Beyond 3.9 m the default range of fusion (4 m) cuts the band short.
        if (truth_m == 0 || truth_m > 3.9f) continue;
        ++with_truth;
        if (view_m.pixels()[i] > 0) errors_m.push_back(std::abs(view_m.pixels()[i] - truth_m));
    }
    ASSERT_GT(errors_m.size(), 0u);
    EXPECT_GT(static_cast<double>(errors_m.size()), 0.95 * static_cast<double>(with_truth));
    std::nth_element(errors_m.begin(), errors_m.begin() + static_cast<ptrdiff_t>(errors_m.size() / 2), errors_m.end());
    EXPECT_LT(errors_m[errors_m.size() / 2], 0.003f);
}

TEST_F(Golden, RecordedAndLiveSceneGiveTheSameScene) {
    const fs::path recorded = beside("recorded");
    const Outcome synth = patina({"synth", "cubes", "--frames", kFrames, "--out", recorded});
    ASSERT_EQ(synth.exit_code, 0) << synth.err;
    run(recorded, beside("from_files"));
    run("synthetic:cubes", beside("live"));
    const std::string scene = read_text(beside("live") / "scene.glb");
    EXPECT_TRUE(scene == read_text(beside("from_files") / "scene.glb"));

    const nlohmann::json record = record_of(beside("from_files"));
    EXPECT_EQ(record["frames"], nlohmann::json({{"read", 12}, {"used", 12}, {"skipped", nlohmann::json::array()}}));
    EXPECT_GT(record["totals"]["triangles"], 10000);
    EXPECT_TRUE(record["warnings"].empty()) << record["warnings"];
    for (const char* frame : {"000004", "000008"}) {
        const Image<float> view_m =
            sensor::read_exr_depth(beside("from_files") / "frames" / (std::string(frame) + ".exr"));
        const auto truth = sensor::read_depth(recorded / "depth" / (std::string(frame) + ".png"), kExtent);
        expect_close(view_m, std::get<Image<uint16_t>>(truth));
    }
}

TEST_F(Golden, SceneIsValidGltf) {
    if (!fs::exists(fs::path(PATINA_SOURCE_DIR) / "node_modules/gltf-validator")) {
        GTEST_SKIP() << "node_modules/gltf-validator is missing: run npm ci in " << PATINA_SOURCE_DIR;
    }
    run("synthetic:cubes", out());
    const std::string validator = PATINA_SOURCE_DIR "/tools/validate_gltf.mjs";
    EXPECT_EQ(std::system(("node '" + validator + "' '" + (out() / "scene.glb").string() + "'").c_str()), 0);
}

TEST_F(Golden, ValidationHasNothingToSayAndTheGraphIsDumped) {
    fs::create_directory(out());
    run_quietly("synthetic:cubes", {"--frames", "2", "--validation", "--dump-graph", out() / "graph"});
    EXPECT_THAT(read_text(out() / "graph.dot"), ::testing::StartsWith("digraph"));
    const nlohmann::json graph = nlohmann::json::parse(read_text(out() / "graph.json"), nullptr, false);
    ASSERT_TRUE(graph.is_object());
    EXPECT_GT(graph["passes"].size(), 5u);
    EXPECT_GT(graph["barriers"].size(), 5u);
    if (std::system("dot -V > /dev/null 2>&1") == 0) {
        EXPECT_EQ(std::system(("dot -Tplain '" + (out() / "graph.dot").string() + "' > /dev/null").c_str()), 0);
    }
}

}  // namespace
}  // namespace patina::testing
