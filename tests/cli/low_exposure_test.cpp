#include <fstream>

#include "tests/cli/run_folder.h"

// A recording whose low-exposure sequence goes round the scene, in which surfaces light each other.

namespace patina::testing {
namespace {

namespace fs = std::filesystem;

class LowExposure : public RunFolderTest {
  protected:
    LowExposure() {
        const Outcome synth = patina({"synth", "bunnies-bounces", "--frames", "3", "--extent", "64x53", "--samples",
                                      "2", "--out", scene(), "--quiet"});
        EXPECT_EQ(synth.exit_code, 0) << synth.err;
    }

    std::string scene() const { return beside("bunnies"); }

    /// run.json of a run that may fall short of materials.
    nlohmann::json run_to(const fs::path& to, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"run", scene(), "--out", to, "--texture", "off", "--quiet"};
        for (const char* setting : {"map.voxel_m=0.02", "fusion.truncation_m=0.06"})
            arguments.insert(arguments.end(), {"--set", setting});
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = patina(arguments);
        EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(0, 3)) << outcome.err;
        return summary_of(to);
    }

    static int64_t unseen(const nlohmann::json& summary) {
        return summary["totals"]["vertices that no colour picture saw"];
    }
};

TEST_F(LowExposure, ItIsPartOfTheSurfaceAndOfNoCount) {
    const nlohmann::json with = run_to(out());
    const nlohmann::json without = run_to(beside("without"), {"--lights", scene() + "/truth/lights.json"});
    for (const nlohmann::json& summary : {with, without}) EXPECT_EQ(summary["frames"]["used"], 3);
    EXPECT_EQ(with["lights"]["found_by"], "lighting sequence");
    EXPECT_GT(with["voxel_pool"]["blocks_used"], without["voxel_pool"]["blocks_used"]);
    EXPECT_GT(unseen(with), 10 * unseen(without)) << "the other side of things";
    run_to(beside("again"));
    EXPECT_EQ(files_in(out())["scene.glb"], files_in(beside("again"))["scene.glb"]);
}

TEST_F(LowExposure, FramesWithoutAPoseAreLeftOut) {
    const fs::path trajectory = fs::path(scene()) / "lighting/trajectory.txt";
    std::ifstream in(trajectory);
    std::string first, rest;
    for (std::string line; std::getline(in, line);) (first.empty() && line[0] != '#' ? first : rest) += line + "\n";
    in.close();
    std::ofstream(trajectory) << "0 nan nan nan 0 0 0 1\n" << rest;
    EXPECT_EQ(run_to(out())["frames"]["used"], 3);
}

}  // namespace
}  // namespace patina::testing
