#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "sensor/files/exr_file.h"
#include "sensor/files/picture_file.h"
#include "tests/cli/golden_numbers.h"
#include "tests/cli/run_folder.h"

// The built-in scene from the command line to its files, on every driver.

namespace patina::testing::golden_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;

constexpr const char* kFrames = "12";
constexpr const char* kCoarseTexels = "8";  // millimetres; most of a run's time goes by their number
constexpr Extent2D kExtent{256, 212};

/// A run whose numbers are stored in tests/golden/NAME.json.
struct Stored {
    const char *scene, *frames, *shown_frame;
    std::vector<std::string> settings;

    fs::path file() const { return fs::path(PATINA_SOURCE_DIR) / "tests/golden" / (std::string(scene) + ".json"); }
};

const std::vector<Stored>& stored_runs() {
    static const std::vector<Stored> runs{
        {"cubes", "24", "000020", {}},  // the network has seen a segment
        {"office", "12", "000008", {}},
    };
    return runs;
}

class Golden : public RunFolderTest {
  protected:
    static void run(const std::string& input, const fs::path& out, std::vector<std::string> more) {
        std::vector<std::string> arguments{"run",   input,          "--out", out,          "--quiet", "--frames",
                                           kFrames, "--dump-every", "4",     "--lighting", "none"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = patina(arguments);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(outcome.out + outcome.err, "");
    }

    /// Compares with what is stored, or stores instead where tools/accept_golden asks for it.
    void expect_stored(const Stored& run) {
        const fs::path recorded = beside("recorded");
        const Outcome synth = patina(
            {"synth", run.scene, "--frames", run.frames, "--extent", "128x106", "--quiet", "--out", recorded.string()});
        ASSERT_EQ(synth.exit_code, 0) << synth.err;
        std::vector<std::string> arguments{"run",
                                           recorded.string(),
                                           "--out",
                                           out().string(),
                                           "--quiet",
                                           "--surface-error",
                                           "0",
                                           "--texture",
                                           "off",
                                           "--no-map",
                                           "--dump-every",
                                           std::to_string(std::stoi(run.shown_frame))};
        arguments.insert(arguments.end(), run.settings.begin(), run.settings.end());
        const Outcome outcome = patina(arguments);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        const nlohmann::json measured = golden_numbers(out(), run.shown_frame);
        if (std::getenv("PATINA_ACCEPT_GOLDEN")) {
            sensor::testing::write_text(run.file(), measured.dump(1) + "\n");
            return;
        }
        ASSERT_TRUE(fs::exists(run.file())) << "tools/accept_golden writes it";
        const auto stored = nlohmann::json::parse(read_text(run.file()));
        for (const std::string& difference : golden_differences(stored, measured))
            ADD_FAILURE() << difference << " (tools/accept_golden stores what the scenes give now)";
    }
};

/// run.json without what may differ between two runs.
std::string without_times(nlohmann::json summary) {
    for (const char* key : {"times", "passes"}) EXPECT_EQ(summary.erase(key), 1u) << key;
    return summary.dump(1);
}

std::set<std::string> names(const std::map<std::string, std::string>& files) {
    std::set<std::string> set;
    for (const auto& [name, content] : files) set.insert(name);
    return set;
}

TEST_F(Golden, TwoRunsGiveTheSameBytes) {
    for (const char* name : {"first", "second"})
        run(small_cubes(), beside(name), {"--detail", "coarse", "--texture", kCoarseTexels});
    const auto first = files_in(beside("first")), second = files_in(beside("second"));
    ASSERT_EQ(names(first), names(second));
    for (const char* name : {"scene.glb", "trajectory.txt", "report.html", "run.json", "frames/000000.exr",
                             "frames/000004.exr", "frames/000008.exr", "previews/000002.png", "previews/000011.png"}) {
        EXPECT_TRUE(first.contains(name)) << name;
    }
    for (const auto& [name, content] : first) {
        if (name == "run.json" || name == "report.html") continue;  // hold times
        if (name == "map.sqlite") continue;  // blocks lie in the order in which threads took them
        EXPECT_TRUE(content == second.at(name)) << name << " differs";
    }
    EXPECT_EQ(without_times(summary_of(beside("first"))), without_times(summary_of(beside("second"))));
    EXPECT_EQ(summary_of(beside("first"))["warnings"].size(), 0u)
        << "the view reaches less than 8 m, of which nobody asked";
}

TEST_F(Golden, TwoTrackedRunsGiveTheSameBytes) {
    const auto tracked = [&](const char* name) {
        const Outcome outcome = patina({"run", small_cubes(), "--out", beside(name), "--quiet", "--frames", "4",
                                        "--lighting", "none", "--poses", "track", "--texture", "off", "--no-map"});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return files_in(beside(name));
    };
    const auto first = tracked("first"), second = tracked("second");
    for (const char* name : {"scene.glb", "trajectory.txt"}) EXPECT_TRUE(first.at(name) == second.at(name)) << name;
    const nlohmann::json summary = summary_of(beside("first"));
    EXPECT_EQ(without_times(summary), without_times(summary_of(beside("second"))));
    EXPECT_EQ(summary["tracking"]["tracking"], 4);
    EXPECT_EQ(summary["tracking"]["frames"].size(), 4u);
    EXPECT_EQ(summary["tracking"]["frames"][3]["state"], "tracking");
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
    const Outcome synth = patina({"synth", "cubes", "--extent", "256x212", "--frames", kFrames, "--out", recorded});
    ASSERT_EQ(synth.exit_code, 0) << synth.err;
    run(recorded, beside("from_files"), {"--texture", "off"});
    run(small_cubes(), beside("live"), {"--texture", "off"});
    const std::string scene = read_text(beside("live") / "scene.glb");
    EXPECT_TRUE(scene == read_text(beside("from_files") / "scene.glb"));

    const nlohmann::json summary = summary_of(beside("from_files"));
    EXPECT_EQ(summary["frames"], nlohmann::json({{"read", 12}, {"used", 12}, {"skipped", nlohmann::json::array()}}));
    EXPECT_GT(summary["totals"]["triangles"], 10000);
    EXPECT_TRUE(summary["warnings"].empty()) << summary["warnings"];
    for (const char* frame : {"000004", "000008"}) {
        const Image<float> view_m =
            sensor::read_exr_depth(beside("from_files") / "frames" / (std::string(frame) + ".exr"));
        const auto truth = sensor::read_depth(recorded / "depth" / (std::string(frame) + ".png"), kExtent);
        expect_close(view_m, std::get<Image<uint16_t>>(truth));
    }
}

TEST_F(Golden, CubesBeyondFourMetresGiveTheStoredNumbers) { expect_stored(stored_runs().at(0)); }
TEST_F(Golden, OfficeGivesTheStoredNumbers) { expect_stored(stored_runs().at(1)); }

// No driver needed.
TEST(GoldenNumbers, AreEachHeldToTheirTolerance) {
    for (const Stored& run : stored_runs()) {
        const auto stored = nlohmann::json::parse(read_text(run.file()));
        EXPECT_TRUE(golden_differences(stored, stored).empty());
        EXPECT_GT(stored["materials"].size(), 4u);
        EXPECT_EQ(stored["lights"].size(), 3u);
        EXPECT_EQ(stored["view"]["cells"].size(), 12u);
        const nlohmann::json numbers = stored.flatten();
        for (const auto& [path, value] : numbers.items()) {
            const auto differences = [&, path = path](double change) {
                nlohmann::json changed = numbers;
                changed[path] = changed[path].get<double>() + change;
                return golden_differences(stored, changed.unflatten());
            };
            const double tolerance = golden_tolerance(path, value.get<double>());
            EXPECT_TRUE(differences(0.9 * tolerance).empty()) << path;
            EXPECT_EQ(differences(1.1 * tolerance).size(), 1u) << path;
            nlohmann::json fewer = numbers;
            fewer.erase(path);
            EXPECT_EQ(golden_differences(stored, fewer.unflatten()).size(), 1u) << path;
            EXPECT_EQ(golden_differences(fewer.unflatten(), stored).size(), 1u) << path;
        }
    }
    EXPECT_GT(nlohmann::json::parse(read_text(stored_runs()[0].file()))["view"]["farthest_m"], 5);
}

TEST_F(Golden, SceneIsValidGltf) {
    if (!fs::exists(fs::path(PATINA_SOURCE_DIR) / "node_modules/gltf-validator")) {
        GTEST_SKIP() << "node_modules/gltf-validator is missing: run npm ci in " << PATINA_SOURCE_DIR;
    }
    run_quietly(small_cubes(),
                {"--frames", "2", "--lighting", "none", "--detail", "coarse", "--texture", kCoarseTexels});
    const std::string validator = PATINA_SOURCE_DIR "/tools/validate_gltf.mjs";
    EXPECT_EQ(std::system(("node '" + validator + "' '" + (out() / "scene.glb").string() + "'").c_str()), 0);
}

TEST_F(Golden, ValidationHasNothingToSayAndTheGraphIsDumped) {
    fs::create_directory(out());
    run_quietly(small_cubes(), {"--frames", "2", "--detail", "coarse", "--texture", kCoarseTexels, "--validation",
                                "--dump-graph", out() / "graph"});
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
}  // namespace patina::testing::golden_test
