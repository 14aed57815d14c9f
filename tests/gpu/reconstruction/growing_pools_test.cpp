#include "reconstruction/growing_pools.h"

#include <algorithm>

#include "reconstruction/pipeline.h"
#include "reconstruction/session/rgbd_frame.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "tests/gpu/gpu_test.h"
#include "tests/support/same_bytes.h"

namespace patina::growing_pools_test {
namespace {

using ::testing::Each;
using ::testing::Field;

/// Frames of the built-in scene, coarse and small.
struct SmallCubes {
    SmallCubes(vulkan::Device& device, uint32_t count) {
        scenes::SyntheticScene scene = scenes::load_scene("cubes");
        scene.camera = scaled_to(scene.camera, {128, 106});
        scenes::SyntheticSource source(device, std::move(scene), {.frames = count});
        info = source.info();
        while (auto reading = source.next()) frames.push_back(std::get<Frame>(std::move(*reading)));
        lights = source.scene().lights;
    }

    SequenceInfo info;
    std::vector<Frame> frames;
    std::vector<Light> lights;
};

struct Result {
    Mesh mesh;
    MeshReflectance reflectance;
    std::vector<PoolState> pools;

    const PoolState& pool(const std::string& name) const {
        for (const PoolState& each : pools) {
            if (each.name == name) return each;
        }
        throw Error("there is no pool of ", name);
    }
};

void expect_same(const Result& a, const Result& b) {
    EXPECT_TRUE(same_bytes(a.mesh.positions_m, b.mesh.positions_m));
    EXPECT_TRUE(same_bytes(a.mesh.colors, b.mesh.colors));
    EXPECT_TRUE(same_bytes(a.reflectance.labels, b.reflectance.labels));
    EXPECT_TRUE(same_bytes(a.reflectance.kd, b.reflectance.kd));
}

class GrowingPoolsTest : public GpuTest {
  protected:
    static ReconstructionSettings settings(uint32_t blocks, uint32_t observed_blocks, uint32_t records,
                                           uint32_t labels = 4096) {
        ReconstructionSettings settings;
        settings.map.voxel_m = 0.01f;
        settings.map.capacity_blocks = blocks;
        settings.fusion.truncation_m = 0.03f;
        settings.remove_every = 4;
        settings.segmentation.emplace();
        settings.segmentation->capacity_labels = labels;
        settings.reflectance.emplace();
        settings.reflectance->voxel_m = 0.04f;
        settings.reflectance->capacity_blocks = observed_blocks;
        settings.reflectance->capacity_records = records;
        return settings;
    }

    Result reconstruct(const ReconstructionSettings& settings, vulkan::Device& on = device()) const {
        Pipeline pipeline(on, settings);
        pipeline.set_lights(cubes().lights);
        for (const Frame& frame : cubes().frames) pipeline.add(patina::to_rgbd(cubes().info, frame));
        Result result;
        result.mesh = pipeline.extract_surface();
        result.reflectance = pipeline.sample_reflectance(result.mesh);
        pipeline.wait();
        result.pools = pipeline.counters().pools;
        return result;
    }

    /// Rendered once for all tests.
    static const SmallCubes& cubes() {
        static const SmallCubes rendered(device(), 12);
        return rendered;
    }

    /// Too small for the first frame.
    static ReconstructionSettings small_settings() { return settings(64, 64, 64, 3); }

    /// What these grow to, reconstructed once for all tests.
    const Result& small() const {
        static const Result grown = reconstruct(small_settings());
        return grown;
    }
};

TEST_F(GrowingPoolsTest, SmallPoolsGrowIntoTheModelOfLargeOnes) {
    const Result large = reconstruct(settings(16384, 32768, 65536));
    ASSERT_GT(large.mesh.positions_m.size(), 1000u);
    expect_same(small(), large);
    for (const PoolState& pool : small().pools) {
        EXPECT_GT(pool.growths, 0u) << pool.name;
        EXPECT_EQ(pool.limit, PoolLimit::kNone) << pool.name;
        EXPECT_EQ(pool.refused, 0u) << pool.name << ": the first frame is fused anew, later ones find room";
        EXPECT_FALSE(pool.is_full());
        EXPECT_LE(pool.used, pool.capacity);
    }
    EXPECT_THAT(large.pools, Each(Field(&PoolState::growths, 0u)));
}

TEST_F(GrowingPoolsTest, EveryRunGrowsAlike) {
    const Result &first = small(), again = reconstruct(small_settings());
    expect_same(first, again);
    for (size_t i = 0; i < first.pools.size(); ++i) {
        EXPECT_EQ(first.pools[i].capacity, again.pools[i].capacity);
        EXPECT_EQ(first.pools[i].growths, again.pools[i].growths);
    }
}

TEST_F(GrowingPoolsTest, GainsAreThoseOfTheFramesAlthoughTheFirstIsFusedAnew) {
    ReconstructionSettings small = settings(64, 64, 64);
    small.reflectance.reset();
    small.gains.emplace();
    Pipeline pipeline(device(), small);
    for (const Frame& frame : cubes().frames) pipeline.add(patina::to_rgbd(cubes().info, frame));
    pipeline.wait();
    EXPECT_EQ(pipeline.gains().size(), cubes().frames.size());
}

TEST_F(GrowingPoolsTest, GivenLabelsBeyondTheCapacityAreTaken) {
    ReconstructionSettings given = settings(16384, 32768, 65536, 4);
    given.segmentation->given = true;
    Pipeline pipeline(device(), given);
    pipeline.set_lights(cubes().lights);
    pipeline.set_material(300, glm::vec3(0.1f), 0.2f);
    const Extent2D extent = cubes().info.depth.extent;
    const std::vector<uint16_t> labels(size_t{extent.width} * extent.height, 300);
    for (const Frame& frame : cubes().frames) {
        RgbdFrame rgbd = patina::to_rgbd(cubes().info, frame);
        rgbd.labels = labels;
        pipeline.add(rgbd);
    }
    const Mesh mesh = pipeline.extract_surface();
    const MeshReflectance reflectance = pipeline.sample_reflectance(mesh);
    EXPECT_GT(std::count(reflectance.labels.begin(), reflectance.labels.end(), 300u),
              ptrdiff_t(mesh.positions_m.size() / 2));
    ASSERT_GT(reflectance.segments.size(), 300u);
    ASSERT_TRUE(reflectance.segments[300].gloss.has_value());
    EXPECT_FLOAT_EQ(reflectance.segments[300].gloss->alpha, 0.2f);
    pipeline.wait();
    const PipelineCounters counters = pipeline.counters();
    for (const PoolState& pool : counters.pools) EXPECT_FALSE(pool.is_full()) << pool.name;
}

TEST_F(GrowingPoolsTest, MaterialsThatWereEstimatedStayWhenLabelsGrow) {
    const auto with_labels = [](uint32_t labels) {
        ReconstructionSettings specular = settings(16384, 32768, 65536, labels);
        specular.reflectance->capacity_labels = labels;
        specular.specular.emplace();
        return specular;
    };
    const auto labels_of = [](Pipeline& pipeline) {
        pipeline.wait();
        return pipeline.counters().pools.back();
    };
    std::vector<SegmentReflectance> segments[2];
    const auto frames = std::span(cubes().frames).first(6);
    uint32_t labels = 4096;
    for (const size_t grown : {0u, 1u}) {
        Pipeline pipeline(device(), with_labels(labels));
        pipeline.set_lights(cubes().lights);
        for (const Frame& frame : frames) {
            pipeline.add(patina::to_rgbd(cubes().info, frame));
            if (frame.index > 0) continue;
            ASSERT_EQ(labels_of(pipeline).growths, 0u) << "it is to grow later";
            labels = labels_of(pipeline).used + 2;  // room for the first frame, not for two more
        }
        ASSERT_STREQ(labels_of(pipeline).name, "labels");
        EXPECT_EQ(labels_of(pipeline).growths > 0, grown > 0);
        segments[grown] = pipeline.sample_reflectance(pipeline.extract_surface()).segments;
    }
    size_t glossy = 0;
    for (size_t label = 0; label < segments[1].size(); ++label) {
        const auto &grown = segments[1][label].gloss, &large = segments[0][label].gloss;
        ASSERT_EQ(grown.has_value(), large.has_value()) << label;
        if (!grown) continue;
        ++glossy;
        EXPECT_EQ(grown->ks, large->ks) << label;
        EXPECT_EQ(grown->alpha, large->alpha) << label;
    }
    EXPECT_GT(glossy, 0u);
}

TEST_F(GrowingPoolsTest, ALimitInTheSettingsIsKeptAndNamed) {
    ReconstructionSettings limited = settings(64, 64, 64);
    limited.map.limit_blocks = 300;
    const Result result = reconstruct(limited);
    const PoolState& blocks = result.pool("voxel blocks");
    EXPECT_EQ(blocks.capacity, 300u);
    EXPECT_EQ(blocks.limit, PoolLimit::kSetting);
    EXPECT_TRUE(blocks.is_full());
    EXPECT_GT(blocks.refused, 100u);
    EXPECT_STREQ(blocks.setting, "map.capacity_blocks");
    EXPECT_FALSE(result.pool("observed voxels").is_full());
}

TEST_F(GrowingPoolsTest, MemoryThatRunsOutIsNamedAndTheRunGoesOn) {
    vulkan::DeviceOptions options;
    options.memory_limit = 1;  // what is there at first is there; nothing grows
    vulkan::Device poor(options);
    const Result result = reconstruct(settings(300, 4096, 16384), poor);
    const PoolState& blocks = result.pool("voxel blocks");
    EXPECT_EQ(blocks.capacity, 300u);
    EXPECT_EQ(blocks.limit, PoolLimit::kMemory);
    EXPECT_TRUE(blocks.is_full());
    EXPECT_GT(result.mesh.positions_m.size(), 100u);
}

}  // namespace
}  // namespace patina::growing_pools_test
