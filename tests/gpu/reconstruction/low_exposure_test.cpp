#include <algorithm>

#include "engine/core/srgb.h"
#include "reconstruction/pipeline.h"
#include "reconstruction/session/rgbd_frame.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "tests/gpu/gpu_test.h"

// Frames of low exposure before the first one.

namespace patina::low_exposure_test {
namespace {

using ::testing::IsEmpty;

constexpr uint32_t kFrames = 6;

/// Frames from all around the built-in scene, small.
struct Tour {
    explicit Tour(vulkan::Device& device) {
        scenes::SyntheticScene scene = scenes::load_scene("cubes");
        scene.camera = scaled_to(scene.camera, {256, 212});
        scenes::SyntheticSource source(device, std::move(scene), {.frames = 40});
        info = source.info();
        lights = source.scene().lights;
        while (auto reading = source.next()) {
            const uint32_t index = std::get<Frame>(*reading).index;
            if (index % 8 != 0 && index != 39) continue;
            frames.push_back(std::get<Frame>(std::move(*reading)));
            labels.push_back(source.truth().labels);
        }
    }

    SequenceInfo info;
    std::vector<Light> lights;
    std::vector<Frame> frames;
    std::vector<Image<uint16_t>> labels;
};

class LowExposureTest : public GpuTest {
  protected:
    /// Rendered once for all tests.
    static const Tour& the_tour() {
        static const Tour tour(device());
        return tour;
    }

    RgbdFrame frame(size_t i) const {
        RgbdFrame rgbd = to_rgbd(tour_.info, tour_.frames[i]);
        rgbd.labels = tour_.labels[i].pixels();
        return rgbd;
    }

    /// The same at an eighth of the exposure, as linear colours.
    void add_low(Pipeline& pipeline, size_t i) const {
        RgbdFrame rgbd = frame(i);
        std::vector<glm::vec3> dark;
        for (const SrgbPixel pixel : std::get<Image<SrgbPixel>>(tour_.frames[i].color).pixels())
            dark.push_back(linear_color(pixel) / 8.0f);
        rgbd.color.pixels = std::span<const glm::vec3>(dark);
        // Half as much again as is right: what was observed so would show.
        pipeline.add_low_exposure(rgbd, 12, 2);
    }

    static ReconstructionSettings settings() {
        ReconstructionSettings settings;
        settings.map.voxel_m = 0.01f;
        settings.map.capacity_blocks = 16384;
        settings.fusion.truncation_m = 0.03f;
        settings.reflectance.emplace();
        settings.reflectance->voxel_m = 0.04f;
        settings.reflectance->capacity_blocks = 16384;
        settings.reflectance->capacity_records = 65536;
        settings.segmentation.emplace();
        settings.segmentation->given = true;
        settings.specular.emplace();
        return settings;
    }

    ModelView view(Pipeline& pipeline, size_t i) const {
        const ViewReadback pending = pipeline.view(tour_.info.color, *tour_.frames[i].world_from_camera);
        pipeline.wait();
        return pending.get();
    }

    static size_t with_depth(const ModelView& view) {
        return static_cast<size_t>(
            std::ranges::count_if(view.position_m.pixels(), [](glm::vec4 position_m) { return position_m.w > 0; }));
    }

    const Tour& tour_ = the_tour();
};

TEST_F(LowExposureTest, BeforeTheFirstFrameItTellsGeometryAloneAndCountsNoFrames) {
    Pipeline with(device(), settings()), without(device(), settings());
    for (Pipeline* pipeline : {&with, &without}) pipeline->set_lights(tour_.lights);
    for (size_t i = 1; i < kFrames; ++i) {
        add_low(with, i);
        const graph::CompiledFrame& compiled = with.runner().last_frame();
        EXPECT_THAT(graph::check(compiled.description, compiled.plan), IsEmpty()) << i;
    }
    with.end_low_exposure();
    EXPECT_EQ(with.frames(), 0u);
    for (Pipeline* pipeline : {&with, &without}) {
        pipeline->add(frame(0));
        pipeline->wait();
        EXPECT_EQ(pipeline->frames(), 1u);
        EXPECT_EQ(pipeline->counters().frames, 1u);
    }
    // What the first frame observed, and no more. Its surface is smoother, so that some records are others.
    const auto records = [](Pipeline& pipeline) {
        const gpu::MapCounters counters = pipeline.counters().observations.records;
        return double(counters.capacity - counters.free_blocks);
    };
    EXPECT_NEAR(records(with) / records(without), 1, 0.1);
    const ModelView known = view(with, 0), plain = view(without, 0);
    std::vector<float> ratios;
    for (size_t i = 0; i < known.reflectance->kd.pixels().size(); ++i) {
        const glm::vec4 a = known.reflectance->kd.pixels()[i], b = plain.reflectance->kd.pixels()[i];
        if (a.a > 0 && b.a > 0 && b.g > 0.05f) ratios.push_back(a.g / b.g);
    }
    ASSERT_GT(ratios.size(), 10000u);
    std::ranges::nth_element(ratios, ratios.begin() + std::ptrdiff_t(ratios.size() / 2));
    EXPECT_NEAR(ratios[ratios.size() / 2], 1, 0.03) << "colours of low exposure are half as much again";
    // From a side that the first frame does not show.
    EXPECT_GT(with_depth(view(with, kFrames - 1)), with_depth(view(without, kFrames - 1)) * 21 / 20);
}

TEST_F(LowExposureTest, AfterTheFirstFrameItTellsNoGeometry) {
    Pipeline pipeline(device(), settings());
    pipeline.set_lights(tour_.lights);
    pipeline.add(frame(0));
    const size_t before = with_depth(view(pipeline, kFrames - 1));
    for (size_t i = 1; i < kFrames; ++i) add_low(pipeline, i);
    pipeline.end_low_exposure();
    EXPECT_EQ(with_depth(view(pipeline, kFrames - 1)), before);
    EXPECT_EQ(pipeline.frames(), 1u);
}

}  // namespace
}  // namespace patina::low_exposure_test
