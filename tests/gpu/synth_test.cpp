#include "tools/synth.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <variant>

#include <unistd.h>

#include "sensor/open.h"
#include "sensor/picture_file.h"
#include "sensor/synthetic/scene_file.h"
#include "sensor/synthetic/synthetic_source.h"
#include "tests/gpu/gpu_test.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class SynthTest : public GpuTest {
  protected:
    void TearDown() override {
        fs::remove_all(folder_);
        GpuTest::TearDown();
    }
    const fs::path folder_ = fs::temp_directory_path() / text("patina_synth_test_", getpid());
};

std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    EXPECT_TRUE(in) << file;
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(SynthTest, WrittenSequenceGivesTheFramesOfTheLiveSource) {
    const fs::path out = folder_ / "cubes";
    tools::synthesise(device(), "cubes", 3, out);
    const auto written = sensor::open_sequence(out);
    sensor::SyntheticSource live(device(), sensor::load_scene("cubes"), 3);
    EXPECT_EQ(written->info().frames, 3u);
    EXPECT_EQ(written->info().color, live.info().color);
    EXPECT_EQ(written->info().depth, live.info().depth);
    EXPECT_EQ(written->info().metres_per_unit, live.info().metres_per_unit);
    EXPECT_EQ(written->info().max_metres, live.info().max_metres);
    for (uint32_t i = 0; i < 3; ++i) {
        const auto expected = std::get<sensor::Frame>(live.next().value());
        const auto got = std::get<sensor::Frame>(written->next().value());
        EXPECT_EQ(got.timestamp_s, expected.timestamp_s);
        EXPECT_EQ(got.exposure, expected.exposure);
        EXPECT_EQ(std::get<Image<sensor::SrgbPixel>>(got.color).pixels(),
                  std::get<Image<sensor::SrgbPixel>>(expected.color).pixels());
        EXPECT_EQ(std::get<Image<uint16_t>>(got.depth).pixels(), std::get<Image<uint16_t>>(expected.depth).pixels());
        ASSERT_TRUE(got.world_from_camera);
        for (int c = 0; c < 4; ++c)  // a quaternion's rounding
            EXPECT_LT(glm::distance((*got.world_from_camera)[c], (*expected.world_from_camera)[c]), 1e-14);
        const auto labels =
            sensor::read_depth(out / "truth/labels" / (sensor::picture_stem(i) + ".png"), live.labels().extent());
        EXPECT_EQ(std::get<Image<uint16_t>>(labels).pixels(), live.labels().pixels());
    }
    EXPECT_EQ(bytes_of(out / "truth/trajectory.txt"), bytes_of(out / "trajectory.txt"));
    EXPECT_THAT(bytes_of(out / "truth/lights.json"), ::testing::HasSubstr("\"intensity\""));
    EXPECT_THAT(bytes_of(out / "truth/materials.json"), ::testing::HasSubstr("\"brushed brass\""));
}

TEST_F(SynthTest, LeavesNothingBehindWhenItFails) {
    EXPECT_THROW(tools::synthesise(device(), "spheres", 3, folder_ / "spheres"), Error);
    EXPECT_THROW(tools::synthesise(device(), "cubes", 0, folder_ / "cubes"), Error);
    EXPECT_TRUE(!fs::exists(folder_) || fs::is_empty(folder_));
}

}  // namespace
}  // namespace patina
