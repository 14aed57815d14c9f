#include "reconstruction/pipeline.h"

#include <algorithm>
#include <array>
#include <map>

#include "reconstruction/session/rgbd_frame.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "tests/gpu/gpu_test.h"
#include "tools/bench/random_network.h"

namespace patina::pipeline_test {
namespace {

using ::testing::IsEmpty;

/// Small enough for hundreds of reconstructions, large enough to chunk nothing away.
ReconstructionSettings small_settings() {
    ReconstructionSettings settings;
    settings.map.voxel_m = 0.02f;
    settings.map.capacity_blocks = 4096;
    settings.fusion.truncation_m = 0.06f;
    return settings;
}

/// A few frames of the built-in scene.
struct Cubes {
    Cubes(vulkan::Device& device, uint32_t count) {
        scenes::SyntheticScene scene = scenes::load_scene("cubes");
        scene.camera = scaled_to(scene.camera, {256, 212});
        scenes::SyntheticSource source(device, std::move(scene), {.frames = count});
        info = source.info();
        while (auto reading = source.next()) frames.push_back(std::get<Frame>(std::move(*reading)));
    }

    void add_to(Pipeline& pipeline, uint32_t index) const { pipeline.add(patina::to_rgbd(info, frames[index])); }

    SequenceInfo info;
    std::vector<Frame> frames;
};

class PipelineTest : public GpuTest {
  protected:
    /// Shows the last frame to the checker, which must find it right and each of its barriers needed.
    void expect_sound(Pipeline& pipeline, const std::string& which) {
        const graph::CompiledFrame& compiled = pipeline.runner().last_frame();
        EXPECT_THAT(graph::check(compiled.description, compiled.plan), IsEmpty()) << which;
        EXPECT_THAT(graph::find_unneeded_barriers(compiled.description, compiled.plan), IsEmpty()) << which;
    }

    /// Rendered once for all tests.
    static const Cubes& four_cubes() {
        static const Cubes cubes(device(), 4);
        return cubes;
    }
    const Cubes& cubes_ = four_cubes();
};

TEST_F(PipelineTest, EveryFrameShapeIsOrderedByBarriersThatAreAllNeeded) {
    for (const bool view_every_frame : {false, true}) {
        ReconstructionSettings settings = small_settings();
        settings.remove_every = 2;
        settings.view_every_frame = view_every_frame;
        Pipeline pipeline(device(), settings);
        for (uint32_t i = 0; i < 4; ++i) {
            cubes_.add_to(pipeline, i);
            expect_sound(pipeline, text("frame ", i, view_every_frame ? " with" : " without", " view"));
        }
        const ViewReadback view = pipeline.view(cubes_.info.color, *cubes_.frames[3].world_from_camera);
        expect_sound(pipeline, "view");
        pipeline.extract_surface();
        expect_sound(pipeline, "last frame of the surface extraction");
        EXPECT_TRUE(view.ready());
    }
}

/// The built-in scene with what each pixel shows, and the lights and materials that are true.
struct LabelledCubes {
    explicit LabelledCubes(vulkan::Device& device, uint32_t count) {
        scenes::SyntheticScene scene = scenes::load_scene("cubes");
        scene.camera = scaled_to(scene.camera, {256, 212});
        scenes::SyntheticSource source(device, std::move(scene), {.frames = count, .truth_every = count - 1});
        info = source.info();
        while (auto reading = source.next()) {
            frames.push_back(std::get<Frame>(std::move(*reading)));
            labels.push_back(source.truth().labels);
            if (source.truth().seen) seen = *source.truth().seen;  // of the last frame in the end
        }
        lights = source.scene().lights;
        materials = scenes::materials_of(source.scene());
    }

    void prepare(Pipeline& pipeline) const {
        pipeline.set_lights(lights);
        for (const sensor::Material& m : materials) pipeline.set_material(m.id, glm::vec3(m.ks), float(m.alpha));
    }

    RgbdFrame frame(uint32_t index) const {
        RgbdFrame rgbd = patina::to_rgbd(info, frames[index]);
        rgbd.labels = labels[index].pixels();
        return rgbd;
    }

    SequenceInfo info;
    std::vector<Frame> frames;
    std::vector<Image<uint16_t>> labels;
    scenes::FrameTruth::Seen seen;
    std::vector<Light> lights;
    std::vector<sensor::Material> materials;
};

/// Each number of frames is rendered once for all tests.
const LabelledCubes& labelled_cubes(vulkan::Device& device, uint32_t count) {
    static std::map<uint32_t, LabelledCubes> rendered;
    return rendered.try_emplace(count, device, count).first->second;
}

/// Coarse geometry with blocks of 8 cm, so that observations have voxels of 4 cm.
ReconstructionSettings small_settings_with_reflectance() {
    ReconstructionSettings settings = small_settings();
    settings.map.voxel_m = 0.01f;
    settings.map.capacity_blocks = 16384;
    settings.fusion.truncation_m = 0.03f;
    settings.reflectance.emplace();
    settings.reflectance->voxel_m = 0.04f;
    settings.reflectance->refine.gathered_rays = 0;  // walls do not light each other in what is rendered here
    settings.reflectance->capacity_blocks = 16384;
    settings.reflectance->capacity_records = 65536;
    settings.segmentation.emplace();
    settings.segmentation->given = true;
    return settings;
}

TEST_F(PipelineTest, AlbedoSegmentsAndReRenderingAreTrueUnderKnownLights) {
    constexpr uint32_t kFrames = 8;
    const LabelledCubes& cubes = labelled_cubes(device(), kFrames);
    Pipeline pipeline(device(), small_settings_with_reflectance());
    cubes.prepare(pipeline);
    for (uint32_t i = 0; i < kFrames; ++i) pipeline.add(cubes.frame(i));
    expect_sound(pipeline, "a frame with reflectance");
    pipeline.refine_all();
    expect_sound(pipeline, "refinement of all");
    const ViewReadback pending = pipeline.view(cubes.info.color, *cubes.frames.back().world_from_camera);
    expect_sound(pipeline, "a view with reflectance");
    pipeline.wait();
    const ModelView view = pending.get();
    ASSERT_TRUE(view.reflectance);
    std::vector<double> kd_errors, rgb_errors;
    size_t labelled = 0;
    for (size_t i = 0; i < view.reflectance->kd.pixels().size(); ++i) {
        if (cubes.seen.object_id.pixels()[i] == 0) continue;
        labelled += view.reflectance->label.pixels()[i] == cubes.seen.object_id.pixels()[i];
        const glm::vec4 kd = view.reflectance->kd.pixels()[i], rgb = view.reflectance->rgb.pixels()[i];
        if (kd.a == 0) continue;
        kd_errors.push_back(glm::length(glm::vec3(kd) - glm::vec3(cubes.seen.kd.pixels()[i])));
        rgb_errors.push_back(glm::length(glm::vec3(rgb) - glm::vec3(cubes.seen.radiance.pixels()[i])));
    }
    ASSERT_GT(kd_errors.size(), 20000u);
    std::sort(kd_errors.begin(), kd_errors.end());
    std::sort(rgb_errors.begin(), rgb_errors.end());
    EXPECT_GT(labelled, kd_errors.size() * 9 / 10);
    EXPECT_LT(kd_errors[kd_errors.size() / 2], 0.02);
    EXPECT_LT(kd_errors[kd_errors.size() * 8 / 10], 0.08) << "4 cm voxels do not follow the shadows' borders";
    EXPECT_LT(rgb_errors[rgb_errors.size() / 2], 0.02);
    EXPECT_LT(rgb_errors[rgb_errors.size() * 8 / 10], 0.08);
}

TEST_F(PipelineTest, GlossInPicturesMirrorsTheRoom) {
    constexpr uint32_t kFrames = 4;
    const LabelledCubes& cubes = labelled_cubes(device(), kFrames);
    std::array<ModelView, 2> views;
    for (size_t mirrors = 0; mirrors < 2; ++mirrors) {
        ReconstructionSettings settings = small_settings_with_reflectance();
        settings.reflectance->refine.gathered_rays = 4;
        settings.reflectance->mirrored_rays = mirrors == 1 ? 16 : 0;
        Pipeline pipeline(device(), settings);
        cubes.prepare(pipeline);
        for (const sensor::Material& m : cubes.materials) pipeline.set_material(m.id, glm::vec3(0.5f), 0.05f);
        for (uint32_t i = 0; i < kFrames; ++i) pipeline.add(cubes.frame(i));
        const ViewReadback pending = pipeline.view(cubes.info.color, *cubes.frames.back().world_from_camera);
        expect_sound(pipeline, mirrors ? "a view with mirrors" : "a view with means");
        pipeline.wait();
        views[mirrors] = pending.get();
        ASSERT_TRUE(views[mirrors].reflectance);
    }
    EXPECT_EQ(views[0].reflectance->kd.pixels(), views[1].reflectance->kd.pixels());
    const auto &means = views[0].reflectance->model_rgb, &mirrored = views[1].reflectance->model_rgb;
    size_t differ = 0, known = 0;
    for (size_t i = 0; i < means.pixels().size(); ++i) {
        known += means.pixels()[i].a > 0;
        differ += glm::length(means.pixels()[i] - mirrored.pixels()[i]) > 0.02f;
    }
    EXPECT_GT(known, 20000u);
    EXPECT_GT(differ, known / 4);
}

// A simplified surface: two triangles of a floor, with a wrong albedo at their corners.
TEST_F(PipelineTest, TexturesHoldWhatRecordsKnowBetweenVertices) {
    constexpr uint32_t kFrames = 4;
    const LabelledCubes& cubes = labelled_cubes(device(), kFrames);
    Pipeline pipeline(device(), small_settings_with_reflectance());
    cubes.prepare(pipeline);
    for (uint32_t i = 0; i < kFrames; ++i) pipeline.add(cubes.frame(i));
    pipeline.refine_all();
    const ViewReadback pending = pipeline.view(cubes.info.color, *cubes.frames.back().world_from_camera);
    pipeline.wait();
    const ModelView view = pending.get();
    TexturedSurface quad;
    for (const glm::uvec2 pixel : {glm::uvec2{60, 180}, {190, 180}, {190, 200}, {60, 200}}) {
        ASSERT_EQ(cubes.seen.object_id.at(pixel.x, pixel.y), 1u) << "the floor";
        quad.mesh.positions_m.emplace_back(view.position_m.at(pixel.x, pixel.y));
        quad.mesh.normals.emplace_back(0, -1, 0);
        quad.reflectance.kd.emplace_back(0.9, 0.1, 0.9, 1);
        quad.reflectance.labels.push_back(1);
        quad.pages.push_back(0);
    }
    quad.mesh.colors.resize(4);
    quad.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    quad.place_px = {{0, 0}, {64, 0}, {64, 64}, {0, 64}};
    const TextureLayout layout{0.01, {{64, 64}}, {quad}, {}};
    const std::vector<TexturePage> pages = pipeline.bake_texture(layout, [](const Pipeline::TakePicture&) {});
    ASSERT_EQ(pages.size(), 1u);
    const glm::vec3 floor(cubes.seen.kd.at(60, 180));
    for (const glm::uvec2 texel : {glm::uvec2{8, 8}, {32, 20}, {50, 55}}) {
        EXPECT_LT(glm::length(pages[0].kd.at(texel.x, texel.y) - floor), 0.06f) << texel.x << ' ' << texel.y;
    }
}

// What records hear of each other's albedo depends on when views are cast; tracking may not.
TEST_F(PipelineTest, CastingViewsChangesNoPose) {
    const LabelledCubes& cubes = labelled_cubes(device(), 6);
    std::array<std::vector<RigidTransform>, 2> poses;
    for (const bool views : {false, true}) {
        ReconstructionSettings settings = small_settings_with_reflectance();
        settings.reflectance->refine.gathered_rays = 4;
        settings.tracking.emplace();
        settings.tracking->finest = 0;  // the pictures are small
        Pipeline pipeline(device(), settings);
        cubes.prepare(pipeline);
        for (uint32_t i = 0; i < 6; ++i) {
            pipeline.add(cubes.frame(i));
            if (views) pipeline.view(cubes.info.color, *cubes.frames[i].world_from_camera);
            EXPECT_EQ(pipeline.tracking_report()->state, TrackingState::kTracking) << i;
            poses[views].push_back(pipeline.tracking_report()->world_from_depth);
        }
    }
    EXPECT_EQ(poses[0], poses[1]);
}

TEST_F(PipelineTest, SpecularMaterialsAreFittedUnderKnownLights) {
    constexpr uint32_t kFrames = 16, kFloor = 1;
    const LabelledCubes& cubes = labelled_cubes(device(), kFrames);
    ReconstructionSettings settings = small_settings_with_reflectance();
    settings.specular.emplace();
    Pipeline pipeline(device(), settings);
    pipeline.set_lights(cubes.lights);
    for (uint32_t i = 0; i < kFrames; ++i) pipeline.add(cubes.frame(i));
    expect_sound(pipeline, "a frame with a fit");
    const MeshReflectance found = pipeline.sample_reflectance(pipeline.extract_surface());
    for (const sensor::Material& truth : cubes.materials) {
        if (truth.id != kFloor) continue;
        const std::optional<WardGloss>& gloss = found.segments[truth.id].gloss;
        ASSERT_TRUE(gloss && gloss->confidence);
        EXPECT_LT(glm::distance(gloss->ks, glm::vec3(truth.ks)), 0.02f);
        EXPECT_NEAR(gloss->alpha, truth.alpha, 0.04);
        EXPECT_GT(*gloss->confidence, 0.5f);
    }
    EXPECT_FALSE(found.segments[100].gloss) << "no segment";
}

// Nobody has seen from two sides yet what it is like.
TEST_F(PipelineTest, TheFirstFrameGivesSegmentsAMaterial) {
    constexpr uint32_t kFloor = 1;
    const LabelledCubes& cubes = labelled_cubes(device(), 1);
    ReconstructionSettings settings = small_settings_with_reflectance();
    settings.specular.emplace();
    Pipeline pipeline(device(), settings);
    pipeline.set_lights(cubes.lights);
    pipeline.add(cubes.frame(0));
    const MeshReflectance found = pipeline.sample_reflectance(pipeline.extract_surface());
    const std::optional<WardGloss>& gloss = found.segments[kFloor].gloss;
    ASSERT_TRUE(gloss && gloss->confidence);
    EXPECT_LT(glm::distance(gloss->ks, glm::vec3(0.04f)), 1e-5f) << "what is usual";
    EXPECT_LT(*gloss->confidence, 0.01f);
}

TEST_F(PipelineTest, SpecularMaterialsFollowTheNetwork) {
    const LabelledCubes& cubes = labelled_cubes(device(), 8);
    for (const bool fit : {false, true}) {
        ReconstructionSettings settings = small_settings_with_reflectance();
        settings.specular = SpecularSettings{.fit = fit};
        settings.network = random_hemi_network(1);
        Pipeline pipeline(device(), settings);
        pipeline.set_lights(cubes.lights);
        for (uint32_t i = 0; i < 8; ++i) pipeline.add(cubes.frame(i));
        expect_sound(pipeline, fit ? "a frame with network and fit" : "a frame with a network");
    }
    ReconstructionSettings settings = small_settings_with_reflectance();
    settings.specular = SpecularSettings{.fit = false};
    const auto refusal = [](const char* part) { return ::testing::ThrowsMessage<Error>(::testing::HasSubstr(part)); };
    EXPECT_THAT([&] { Pipeline(device(), settings); }, refusal("by a network, but there is none"));
    settings.specular = SpecularSettings{};
    settings.segmentation.reset();
    EXPECT_THAT([&] { Pipeline(device(), settings); }, refusal("there are no segments"));
}

TEST_F(PipelineTest, TheNetworkIsNotAskedOfWhatTheFitIsSureOf) {
    const LabelledCubes& cubes = labelled_cubes(device(), 24);
    ReconstructionSettings settings = small_settings_with_reflectance();
    settings.specular.emplace();
    settings.network = random_hemi_network(1);
    Pipeline pipeline(device(), settings);
    pipeline.set_lights(cubes.lights);
    for (uint32_t i = 0; i < 24; ++i) pipeline.add(cubes.frame(i));
    graph::FrameGraph frame = pipeline.runner().begin();
    const graph::Readback read_fits = frame.read_back(pipeline.specular()->fits(frame));
    const graph::Readback read_means = frame.read_back(pipeline.specular()->means(frame));
    pipeline.runner().submit(std::move(frame));
    pipeline.runner().wait();
    const auto fits = read_fits.as<gpu::WardFit>();
    const auto means = read_means.as<gpu::PerceptualMaterial>();
    uint32_t spared = 0, asked = 0;
    for (size_t label = 0; label < fits.size(); ++label) {
        const auto times = static_cast<uint32_t>(means[label].cgb_d_weight.w);
        EXPECT_LE(times, fits[label].estimates) << label;
        if (fits[label].confidence >= gpu::kAskedBelowConfidence && times + 3 < fits[label].estimates) ++spared;
        if (times > 0) ++asked;
    }
    EXPECT_GT(spared, 0u);
    EXPECT_GT(asked, 2u);
}

TEST_F(PipelineTest, LabelsOfAnotherSizeAreRefused) {
    Pipeline pipeline(device(), small_settings_with_reflectance());
    RgbdFrame frame = patina::to_rgbd(cubes_.info, cubes_.frames[0]);
    const std::vector<uint16_t> labels(7);
    frame.labels = labels;
    EXPECT_THROW(pipeline.add(frame), Error);
}

TEST_F(PipelineTest, EveryPixelOfTheFirstFrameLooksForSurface) {
    const auto counters_at = [&](uint32_t stride_px, uint32_t frames) {
        ReconstructionSettings settings = small_settings_with_reflectance();
        settings.segmentation.reset();
        settings.fusion.allocation_stride_px = settings.reflectance->observe.stride_px = stride_px;
        Pipeline pipeline(device(), settings);
        for (uint32_t i = 0; i < frames; ++i) cubes_.add_to(pipeline, i);
        pipeline.wait();
        return pipeline.counters();
    };
    const PipelineCounters all = counters_at(1, 1), few = counters_at(8, 1);
    EXPECT_GT(few.map.high_water, 1000u);
    EXPECT_EQ(few.map.high_water, all.map.high_water);
    EXPECT_GT(few.observations.records.high_water, 1000u);
    EXPECT_EQ(few.observations.records.high_water, all.observations.records.high_water);
    EXPECT_LT(counters_at(8, 2).observations.records.high_water, counters_at(1, 2).observations.records.high_water);
}

TEST_F(PipelineTest, AFrameOfAKnownShapeIsNotCompiledAgain) {
    ReconstructionSettings settings = small_settings();
    settings.map.capacity_blocks = 32768;  // a pool that grows changes the shape
    settings.remove_every = 0;
    Pipeline pipeline(device(), settings);
    cubes_.add_to(pipeline, 0);
    const uint32_t compilations = pipeline.runner().compilations();
    for (uint32_t i = 1; i < 4; ++i) cubes_.add_to(pipeline, i);
    EXPECT_EQ(pipeline.runner().compilations(), compilations);
}

TEST_F(PipelineTest, OneFrameOfGeometryTakesFewDispatches) {
    ReconstructionSettings settings = small_settings();
    settings.remove_every = 1;
    settings.view_every_frame = true;
    Pipeline pipeline(device(), settings);
    cubes_.add_to(pipeline, 0);
    const graph::CompiledFrame& compiled = pipeline.runner().last_frame();
    const auto dispatches = std::ranges::count_if(compiled.plan.order, [&](uint32_t pass) {
        return std::ranges::none_of(compiled.description.passes[pass].accesses, [](const graph::Access& access) {
            return graph::scope_of(access.use).stages == graph::kStageTransfer;
        });
    });
    EXPECT_GT(dispatches, 8);
    EXPECT_LE(dispatches, 25);
}

TEST_F(PipelineTest, AnAllocationThatFailsIsOneErrorThatNamesItsResource) {
    vulkan::DeviceOptions options;
    options.selector = device().caps().name;
    options.validation = true;
    constexpr uint32_t kEnough = 200;
    uint32_t failures = 0;
    for (bool succeeded = false; !succeeded; ++failures) {
        ASSERT_LT(failures, kEnough) << "the run never succeeds";
        options.fail_allocation_at = failures + 1;
        vulkan::Device failing(options);
        try {
            Pipeline pipeline(failing, small_settings());
            cubes_.add_to(pipeline, 0);
            const ViewReadback view = pipeline.view(cubes_.info.color, *cubes_.frames[0].world_from_camera);
            pipeline.extract_surface();
            succeeded = true;
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), ::testing::ContainsRegex("out of memory.*'.+'")) << "allocation " << failures + 1;
        }
        EXPECT_THAT(failing.validation_messages(), IsEmpty()) << "allocation " << failures + 1;
        EXPECT_EQ(failing.shared_context().use_count(), 1) << "something outlives allocation " << failures + 1;
    }
    EXPECT_GT(failures, 10u);
}

TEST_F(PipelineTest, ObservationsOfThingsThatWentAreGivenBackInFramesThatAreHeldOutToo) {
    const LabelledCubes& cubes = labelled_cubes(device(), 2);
    ReconstructionSettings settings = small_settings_with_reflectance();
    settings.segmentation->sample_every = 1;
    settings.reflectance->reclaim_every = 1;
    settings.remove_every = 4;
    for (const bool held_out : {false, true}) {
        SCOPED_TRACE(held_out);
        Pipeline pipeline(device(), settings);
        cubes.prepare(pipeline);
        pipeline.add(cubes.frame(0));
        pipeline.wait();
        const gpu::MapCounters before = pipeline.counters().observations.records;
        // Nothing is left of the room but a wall behind it.
        RgbdFrame cleared = cubes.frame(0);
        const std::vector<uint16_t> wall(cleared.depth.camera.extent.area(), 5500);
        cleared.depth.pixels = std::span(wall);
        cleared.held_out = held_out;
        for (int i = 0; i < 20; ++i) pipeline.add(cleared);
        expect_sound(pipeline, "a frame that gives observations back");
        pipeline.wait();
        const gpu::MapCounters after = pipeline.counters().observations.records;
        EXPECT_GT(before.capacity - before.free_blocks, 1000u);
        EXPECT_GT(after.deleted_blocks, (before.capacity - before.free_blocks) / 2);
    }
}

TEST_F(PipelineTest, EveryBlockTakesColourWhateverFramesAreHeldOut) {
    ReconstructionSettings settings = small_settings();
    settings.fusion.settled_color_every = 2;
    Pipeline pipeline(device(), settings);
    const Intrinsics camera = cubes_.info.depth;
    const auto add = [&](uint8_t grey, int count) {
        RgbdFrame frame = patina::to_rgbd(cubes_.info, cubes_.frames[0]);
        const Image<glm::u8vec3> picture(frame.color.camera.extent, glm::u8vec3(grey));
        frame.color.pixels = std::span(picture.pixels());
        for (int i = 0; i < count; ++i) {
            frame.held_out = i % 2 == 1;
            pipeline.add(frame);
        }
        const ViewReadback pending = pipeline.view(camera, frame.world_from_depth);
        pipeline.wait();
        return pending.get().color;
    };
    const Image<glm::vec4> before = add(60, 24), after = add(200, 48);
    size_t seen = 0, changed = 0;
    for (size_t i = 0; i < before.pixels().size(); ++i) {
        if (before.pixels()[i].a == 0) continue;
        ++seen;
        changed += after.pixels()[i].r > 4 * before.pixels()[i].r ? 1 : 0;
    }
    EXPECT_GT(seen, before.pixels().size() / 3);
    EXPECT_GT(changed, seen * 97 / 100);
}

}  // namespace
}  // namespace patina::pipeline_test
