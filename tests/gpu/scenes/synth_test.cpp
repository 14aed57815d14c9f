#include "tools/synth/synth.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <variant>

#include <unistd.h>

#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "sensor/files/exr_file.h"
#include "sensor/files/picture_file.h"
#include "sensor/open.h"
#include "sensor/truth.h"
#include "tests/gpu/gpu_test.h"
#include "tools/synth/truth_frame.h"

namespace patina::synth_test {
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
    tools::synthesise(device(), {.scene = "cubes", .out = out, .frames = 3, .quiet = true});
    const auto written = sensor::open_sequence(out);
    scenes::SyntheticSource live(device(), scenes::load_scene("cubes"), {.frames = 3});
    EXPECT_EQ(written->info().frames, 3u);
    EXPECT_EQ(written->info().color, live.info().color);
    EXPECT_EQ(written->info().depth, live.info().depth);
    EXPECT_EQ(written->info().metres_per_unit, live.info().metres_per_unit);
    EXPECT_EQ(written->info().max_metres, live.info().max_metres);
    for (uint32_t i = 0; i < 3; ++i) {
        const auto expected = std::get<Frame>(live.next().value());
        const auto got = std::get<Frame>(written->next().value());
        EXPECT_EQ(got.timestamp_s, expected.timestamp_s);
        EXPECT_EQ(got.exposure, expected.exposure);
        EXPECT_EQ(std::get<Image<SrgbPixel>>(got.color).pixels(), std::get<Image<SrgbPixel>>(expected.color).pixels());
        EXPECT_EQ(std::get<Image<uint16_t>>(got.depth).pixels(), std::get<Image<uint16_t>>(expected.depth).pixels());
        ASSERT_TRUE(got.world_from_camera);
        for (int c = 0; c < 4; ++c)  // a quaternion's rounding
            EXPECT_LT(glm::distance((*got.world_from_camera)[c], (*expected.world_from_camera)[c]), 1e-14);
        const auto labels =
            sensor::read_depth(out / "truth/labels" / (sensor::picture_stem(i) + ".png"), live.truth().labels.extent());
        EXPECT_EQ(std::get<Image<uint16_t>>(labels).pixels(), live.truth().labels.pixels());
    }
    EXPECT_EQ(bytes_of(out / "truth/trajectory.txt"), bytes_of(out / "trajectory.txt"));
    EXPECT_THAT(bytes_of(out / "truth/lights.json"), ::testing::HasSubstr("\"intensity\""));
    EXPECT_THAT(bytes_of(out / "truth/materials.json"), ::testing::HasSubstr("\"brushed brass\""));
}

TEST_F(SynthTest, TruthFramesHoldWhatTheColorCameraSees) {
    const fs::path out = folder_ / "cubes";
    tools::synthesise(device(), {.scene = "cubes",
                                 .out = out,
                                 .frames = 3,
                                 .truth_every = 2,
                                 .quiet = true,
                                 .noise = "kinect2",
                                 .pose_noise = tools::PoseNoise{0.01, 0.5},
                                 .extent = Extent2D{64, 53}});
    EXPECT_TRUE(fs::exists(out / "truth/frames/000000.exr"));
    EXPECT_FALSE(fs::exists(out / "truth/frames/000001.exr"));
    const Image<float> depth_m = sensor::read_exr_depth(out / "truth/frames/000002.exr");
    EXPECT_EQ(depth_m.extent(), (Extent2D{64, 53}));
    EXPECT_NE(bytes_of(out / "truth/trajectory.txt"), bytes_of(out / "trajectory.txt")) << "recorded poses have errors";

    scenes::SyntheticScene scene = scenes::load_scene("cubes");
    scene.camera = scaled_to(scene.camera, {64, 53});
    scenes::SyntheticSource live(device(), scene, {.frames = 3, .truth_every = 2});
    while (live.next()) continue;
    EXPECT_EQ(depth_m.pixels(), live.truth().seen->depth_m.pixels()) << "truth has no noise";
}

TEST_F(SynthTest, TruthDumpGivesEveryPixelItsObjectsMaterial) {
    scenes::SyntheticScene scene = scenes::load_scene("cubes");
    scene.camera = scaled_to(scene.camera, {64, 53});
    scenes::SyntheticSource live(device(), scene, {.frames = 1, .truth_every = 1});
    live.next();
    const FrameDump dump = tools::truth_dump(scene, *live.truth().seen);
    EXPECT_TRUE(dump.rgb_segment.empty());
    const std::vector<uint16_t>& labels = live.truth().labels.pixels();
    std::map<uint32_t, sensor::Material> material_of;
    for (const sensor::Material& m : materials_of(scene)) material_of[m.id] = m;
    size_t background = 0;
    for (size_t i = 0; i < labels.size(); ++i) {
        ASSERT_EQ(dump.label.pixels()[i], labels[i]);
        ASSERT_EQ(dump.valid.pixels()[i], labels[i] == 0 ? 0 : 1);
        ASSERT_EQ(dump.valid.pixels()[i] == 0, dump.depth_m.pixels()[i] == 0);
        if (labels[i] == 0) {
            ++background;
            ASSERT_EQ(dump.kd_segment.pixels()[i], glm::vec3(0));
            continue;
        }
        const sensor::Material& m = material_of.at(labels[i]);
        ASSERT_EQ(dump.kd.pixels()[i], glm::vec3(*m.kd));
        ASSERT_EQ(dump.kd_segment.pixels()[i], glm::vec3(*m.kd));
        ASSERT_EQ(dump.ks.pixels()[i], glm::vec3(m.ks));
        ASSERT_EQ(dump.alpha.pixels()[i], static_cast<float>(m.alpha));
        ASSERT_NEAR(glm::length(dump.normal.pixels()[i]), 1, 1e-3);
    }
    EXPECT_GT(background, 0u);
    EXPECT_LT(background, labels.size());
}

TEST_F(SynthTest, TexturedObjectsHaveTheirPicturesMeanAsSegmentKd) {
    scenes::SyntheticScene scene;
    scenes::Texture texture;
    texture.kd = std::make_shared<Image<glm::vec3>>(
        Extent2D{2, 1}, std::vector<glm::vec3>{glm::vec3(0.1f, 0.2f, 0.3f), glm::vec3(0.3f, 0.6f, 0.3f)});
    scene.objects = {{{}, {5, "carpet", std::nullopt, glm::dvec3(0), 1}, texture}};
    scenes::FrameTruth::Seen seen;
    const Extent2D extent{1, 1};
    seen.radiance = seen.normal = seen.kd = seen.ks_alpha = Image<glm::vec4>(extent, glm::vec4(0.5f));
    seen.depth_m = Image<float>(extent, 1.0f);
    seen.object_id = Image<uint32_t>(extent, 5u);
    const glm::vec3 mean = tools::truth_dump(scene, seen).kd_segment.at(0, 0);
    EXPECT_LT(glm::distance(mean, glm::vec3(0.2f, 0.4f, 0.3f)), 1e-6f);
}

TEST_F(SynthTest, SeedsDecideTheBytes) {
    const auto record = [&](const char* name, uint64_t seed) {
        const fs::path out = folder_ / name;
        tools::synthesise(device(), {.scene = "cubes",
                                     .out = out,
                                     .frames = 1,
                                     .quiet = true,
                                     .changes = {.seed = seed},
                                     .noise = "kinect1",
                                     .extent = Extent2D{64, 53}});
        return bytes_of(out / "color/000000.png") + bytes_of(out / "depth/000000.png");
    };
    const std::string first = record("a", 1);
    EXPECT_EQ(record("b", 1), first);
    EXPECT_NE(record("c", 2), first);
}

TEST_F(SynthTest, LinearColorIsKeptInExr) {
    const fs::path out = folder_ / "cubes";
    tools::synthesise(
        device(), {.scene = "cubes", .out = out, .frames = 1, .quiet = true, .exr = true, .extent = Extent2D{64, 53}});
    const auto frame = std::get<Frame>(sensor::open_sequence(out)->next().value());
    const auto& pixels = std::get<Image<glm::vec3>>(frame.color).pixels();
    scenes::SyntheticScene scene = scenes::load_scene("cubes");
    scene.camera = scaled_to(scene.camera, {64, 53});
    scene.recording.exr = true;
    scenes::SyntheticSource live(device(), scene, {.frames = 1});
    const auto expected = std::get<Frame>(live.next().value());
    EXPECT_EQ(pixels, std::get<Image<glm::vec3>>(expected.color).pixels());
}

/// A scene file with an unregistered colour camera, a visible lamp and a lighting path.
void write_lamp_scene(const fs::path& file) {
    fs::create_directories(file.parent_path());
    std::ofstream(file)
        << R"({"name": "lamp", "camera": {"width": 32, "height": 24, "fx": 30, "fy": 30, "cx": 16, "cy": 12},
        "color_camera": {"camera": {"width": 40, "height": 30, "fx": 35, "fy": 35, "cx": 20, "cy": 15},
                         "color_from_depth": [1, 0, 0, 0.05, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
        "objects": [{"name": "ball", "material": {"kd": [0.5, 0.4, 0.3], "ks": 0.1, "alpha": 0.2},
                     "parts": [{"sphere": {"radius": 0.4}}]}],
        "lights": [{"position": [0.5, -0.5, -0.8], "intensity": [1, 1, 1], "radius": 0.1}],
        "path": {"orbit": {"target": [0, 0, 0], "distance": 2}},
        "lighting": {"path": {"orbit": {"target": [0.5, -0.5, -0.8], "distance": 1.5}}, "frames": 2}})";
}

TEST_F(SynthTest, LightingSequenceIsASequenceOfItsOwn) {
    write_lamp_scene(folder_ / "lamp.json");
    const fs::path out = folder_ / "lamp";
    tools::synthesise(device(), {.scene = folder_ / "lamp.json", .out = out, .frames = 1, .quiet = true});
    const auto main = sensor::open_sequence(out), lighting = sensor::open_sequence(out / "lighting");
    EXPECT_EQ(main->info().frames, 1u);
    EXPECT_EQ(main->info().color.extent, (Extent2D{40, 30}));
    EXPECT_EQ(main->info().color_from_depth[3], glm::dvec4(0.05, 0, 0, 1));
    EXPECT_EQ(lighting->info().frames, 2u);
    EXPECT_EQ(lighting->info().color, main->info().color);
    const auto bright = std::get<Frame>(main->next().value());
    const auto dark = std::get<Frame>(lighting->next().value());
    EXPECT_EQ(bright.exposure, Exposure{});
    EXPECT_NEAR(dark.exposure.exposure_s, 0.01 * 0.8 * std::numbers::pi * 0.01, 1e-9);
    EXPECT_TRUE(fs::exists(out / "lighting/truth/trajectory.txt"));
    EXPECT_EQ(sensor::read_lights(out / "truth/lights.json").size(), 1u);
    EXPECT_EQ(sensor::read_materials(out / "truth/materials.json").at(0).name, "ball");

    tools::synthesise(
        device(),
        {.scene = folder_ / "lamp.json", .out = folder_ / "b", .frames = 1, .lighting = false, .quiet = true});
    EXPECT_FALSE(fs::exists(folder_ / "b/lighting"));
}

TEST_F(SynthTest, LeavesNothingBehindWhenItFails) {
    EXPECT_THROW(tools::synthesise(device(), {.scene = "spheres", .out = folder_ / "spheres"}), Error);
    EXPECT_THROW(tools::synthesise(device(), {.scene = "cubes", .out = folder_ / "cubes", .frames = 0}), Error);
    EXPECT_TRUE(!fs::exists(folder_) || fs::is_empty(folder_));
}

}  // namespace
}  // namespace patina::synth_test
