// Lamps found in what they light, from the frames of a scene.

#include <fstream>

#include "reconstruction/session/find_lights.h"
#include "scenes/files/scene_file.h"
#include "tests/export/temporary_folder.h"
#include "tests/gpu/gpu_test.h"

namespace patina::light_fitting_test {
namespace {

class LightFitting : public GpuTest {
  protected:
    /// Of the built-in scene `cubes`, seen by a small camera.
    LightsOptions cubes() const {
        const std::filesystem::path file = folder_ / "small.json";
        std::filesystem::copy_file(scenes::assets_folder() / "scenes/cubes.json", folder_ / "cubes.json",
                                   std::filesystem::copy_options::overwrite_existing);
        std::ofstream(file) << R"({"base": "cubes.json",
            "camera": {"width": 64, "height": 53, "fx": 46, "fy": 46, "cx": 31.5, "cy": 26}})";
        LightsOptions options;
        options.sequence = "synthetic:" + file.string();
        options.frames = 30;
        options.from = LightsFrom::kMainSequence;
        options.fitting.search.most_lamps = 1;  // more take longer, and show nothing else
        return options;
    }

  private:
    const test::TemporaryFolder folder_;
};

TEST_F(LightFitting, TheirIntensityFollowsFromWhiteAndTooLargeAMisfitMeansNone) {
    LightsOptions options = cubes();
    const Illumination found = find_lights(device(), options);
    ASSERT_EQ(found.lights.size(), 1u);
    EXPECT_GT(found.misfit, 0);
    EXPECT_LT(found.misfit, options.fitting.most_misfit);
    // The albedo of bright surfaces fixes how bright it is.
    options.fitting.white_albedo /= 2;
    const Illumination brighter = find_lights(device(), options);
    ASSERT_EQ(brighter.lights.size(), 1u);
    const glm::dvec3 before = found.lights[0].light.intensity, after = brighter.lights[0].light.intensity;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c], 2 * before[c], 1e-5 * before[c]) << c;

    options.fitting.most_misfit = found.misfit / 2;
    const Illumination doubted = find_lights(device(), options);
    EXPECT_TRUE(doubted.lights.empty());
    EXPECT_EQ(doubted.misfit, found.misfit) << "which is told all the same";
    EXPECT_GT(doubted.ambient.x, 0) << "the frames' brightness tells the light";
}

}  // namespace
}  // namespace patina::light_fitting_test
