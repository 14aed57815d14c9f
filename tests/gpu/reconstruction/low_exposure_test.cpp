#include <algorithm>

#include "engine/core/srgb.h"
#include "reconstruction/lights/ruled_out_places.h"
#include "reconstruction/lights/surface_samples.h"
#include "reconstruction/lights/try_in_volume.h"
#include "reconstruction/pipeline.h"
#include "reconstruction/session/rgbd_frame.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/lighting/lamp_emission.h"

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

    /// Samples all over a view, the second half with highlights that mirror the camera.
    static std::vector<gpu::LightSample> samples_of(const ModelView& view) {
        const std::vector<glm::vec4>&places = view.position_m.pixels(), &normals = view.normal.pixels();
        std::vector<gpu::LightSample> samples(2 * gpu::kLightSamples);
        for (size_t i = 0; i < samples.size(); ++i) {
            const size_t pixel = i * places.size() / samples.size();
            if (places[pixel].w <= 0) continue;
            samples[i].point_m = glm::vec4(glm::vec3(places[pixel]), 9);
            samples[i].normal = normals[pixel];
            samples[i].diffuse = glm::vec4(0.5f);
            samples[i].highlight = glm::vec4(glm::vec3(normals[pixel]), 1);
        }
        return samples;
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

TEST_F(LowExposureTest, RulesOutUnseenLampsWhereTwoPicturesLooked) {
    Pipeline pipeline(device(), settings());
    pipeline.set_lights(tour_.lights);
    for (size_t i = 0; i < 2; ++i) pipeline.add(frame(i));
    const ModelView seen = view(pipeline, 0);
    const Extent2D extent = seen.position_m.extent();
    const glm::vec3 surface_m(seen.position_m.at(extent.width / 2, extent.height / 2));
    const glm::vec3 camera_m((*tour_.frames[0].world_from_camera)[3]);
    const glm::vec3 way = glm::normalize(surface_m - camera_m);
    const std::vector<glm::vec3> places_m{0.5f * (camera_m + surface_m), surface_m + 0.4f * way, camera_m - 0.3f * way,
                                          camera_m - 2.0f * way};
    for (uint32_t pictures = 0; pictures < 3; ++pictures) {
        const std::vector<gpu::Camera>& cameras = pipeline.reflectance()->low_exposure_cameras();
        ASSERT_EQ(cameras.size(), pictures);
        const RuledOutPlaces ruled_out(pipeline, cameras);
        const bool enough = pictures == 2;
        EXPECT_EQ(ruled_out(places_m), (std::vector<bool>{enough, false, enough, false})) << pictures;
        add_low(pipeline, 0);
    }
}

TEST_F(LowExposureTest, LampsInRuledOutPlacesGiveNothing) {
    Pipeline pipeline(device(), settings());
    pipeline.set_lights(tour_.lights);
    for (size_t i = 0; i < 2; ++i) pipeline.add(frame(i));
    for (int i = 0; i < 2; ++i) add_low(pipeline, 0);
    std::vector<gpu::LightSample> drawn = samples_of(view(pipeline, 0));
    const LitSurface surface(drawn, 1);
    const RuledOutPlaces ruled_out(pipeline, pipeline.reflectance()->low_exposure_cameras());
    const TryLampsInVolume try_any(pipeline, drawn, surface), try_unseen(pipeline, drawn, surface, &ruled_out);
    const RigidTransform& camera = *tour_.frames[0].world_from_camera;
    const std::vector<glm::vec3> places_m{glm::vec3(camera[3] - 0.3 * camera[2]),
                                          glm::vec3(camera[3] - 2.0 * camera[2])};
    const auto any = try_any(places_m, gpu::kLightSamples), unseen = try_unseen(places_m, gpu::kLightSamples);
    EXPECT_GT(any[0].received->mean, 0);
    EXPECT_GT(any[1].received->mean, 0);
    EXPECT_EQ(unseen[0].received->mean, 0);
    EXPECT_EQ(unseen[1].received->by_sample, any[1].received->by_sample);
    for (const float share : unseen[0].unexplained) EXPECT_EQ(share, 1);
}

TEST_F(LowExposureTest, SurfaceReceivesOfAFlatLampByTheCosineToItsAxis) {
    Pipeline pipeline(device(), settings());
    pipeline.set_lights(tour_.lights);
    for (size_t i = 0; i < 2; ++i) pipeline.add(frame(i));
    std::vector<gpu::LightSample> samples = samples_of(view(pipeline, 0));
    samples.resize(gpu::kLightSamples);
    Light flat = tour_.lights.at(0);
    flat.axis = glm::normalize(glm::dvec3(0.5, 1, 0.2));
    const std::vector<glm::vec3> around = received_from(pipeline, samples, std::span(tour_.lights).first(1));
    const std::vector<glm::vec3> received = received_from(pipeline, samples, std::span(&flat, 1));
    size_t lit = 0;
    for (size_t i = 0; i < received.size(); ++i) {
        const glm::dvec3 to_lamp = flat.position_m - glm::dvec3(samples[i].point_m);
        const glm::dvec3 expected = reference::emitted(glm::dvec3(around[i]), flat.axis, to_lamp);
        EXPECT_LT(glm::distance(glm::dvec3(received[i]), expected), 1e-5) << i;
        lit += received[i].g > 0;
    }
    EXPECT_GT(lit, 100u);
}

}  // namespace
}  // namespace patina::low_exposure_test
