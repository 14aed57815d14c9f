// What lamps give samples of a fused and observed surface: a box on a floor, one view of which is brighter.

#include "passes/lighting/sample_surface.h"

#include <cstring>
#include <numbers>
#include <random>
#include <set>

#include "passes/reflectance/mark_blocks.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/observation/observation_rig.h"
#include "tests/gpu/reflectance/surroundings_inputs.h"
#include "tests/reference/lighting/light_samples.h"

namespace patina::sample_surface_test {
namespace {

const Intrinsics kCamera{{128, 96}, 107, 107, 63.5, 47.5, {}};
const glm::dvec3 kBoxCenter{0, -0.15, 0}, kBoxHalf{0.15, 0.15, 0.1};
constexpr int kFrames = 6, kBright = 2;
constexpr float kDull = 0.2f, kShine = 0.45f;

double scene(glm::dvec3 p) {
    return std::min(reference::box(kBoxCenter, kBoxHalf)(p), reference::half_space({0, -1, 0}, 0)(p));
}

RigFrame view(int i) {
    const double azimuth = i * std::numbers::pi / 3;
    RigFrame frame;
    frame.camera = kCamera;
    frame.world_from_camera =
        reference::look_at({0.8 * std::cos(azimuth), -1.1, 0.8 * std::sin(azimuth)}, {0, -0.1, 0});
    frame.depth_m = reference::render_depth(scene, kCamera, frame.world_from_camera, 4);
    const float value = i == kBright ? kShine : kDull;
    frame.color = {kCamera, frame.world_from_camera,
                   Image<glm::vec4>(kCamera.extent, glm::vec4(value, value, value, 1))};
    return frame;
}

/// Whether the way from a point to another passes a box this much larger than the one in the scene.
bool box_between(glm::dvec3 from, glm::dvec3 to, double larger_m) {
    double enter = 0, leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double way = to[axis] - from[axis], center = kBoxCenter[axis] - from[axis];
        const double half = kBoxHalf[axis] + larger_m;
        const double a = (center - half) / way, b = (center + half) / way;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter < leave;
}

class SampleSurface : public GpuTest {
  protected:
    static const std::vector<RigFrame>& frames() {
        static const std::vector<RigFrame> all = [] {
            std::vector<RigFrame> made;
            for (int i = 0; i < kFrames; ++i) made.push_back(view(i));
            return made;
        }();
        return all;
    }

    std::unique_ptr<ObservationRig> make_model() {
        auto rig = std::make_unique<ObservationRig>(device(), runner(), ObservationMapSettings{});
        for (const RigFrame& frame : frames()) {
            rig->fuse(frame, 2);
            rig->collect(frame);
        }
        return rig;
    }

    /// Blocks that have a voxel with enough observations: there is a place for one sample of each.
    static size_t blocks_to_sample(ObservationRig& rig) {
        std::set<uint32_t> blocks;
        for (const auto& [voxel, known] : rig.content())
            if (known.count() >= gpu::kLeastForSample) blocks.insert(known.record.block_key);
        return blocks.size();
    }

    std::vector<gpu::LightSample> draw(ObservationRig& rig) {
        graph::FrameGraph frame = runner().begin();
        const std::vector<gpu::RecordStatus> none(rig.map().capacity_records());
        const graph::BufferId status = frame.upload<gpu::RecordStatus>("status", std::span(none));
        const graph::Readback drawn =
            frame.read_back(add_sample_surface(frame, rig.map(), rig.map().import(frame), status, 0));
        run(std::move(frame));
        return drawn.as<gpu::LightSample>();
    }
};

TEST_F(SampleSurface, TellsTheColourWithoutHighlightsAndWhereHighlightsAreSeenFrom) {
    const auto rig = make_model();
    const auto drawn = draw(*rig);
    ASSERT_EQ(drawn.size(), 2 * gpu::kLightSamples);
    const glm::vec3 bright_camera_m(frames()[kBright].world_from_camera[3]);
    uint32_t samples = 0, highlights = 0;
    for (uint32_t place = 0; place < drawn.size(); ++place) {
        const gpu::LightSample& s = drawn[place];
        if (s.point_m.w == 0) continue;
        ++(place < gpu::kLightSamples ? samples : highlights);
        EXPECT_GE(s.point_m.w, gpu::kLeastForSample);
        EXPECT_LT(std::abs(scene(glm::dvec3(s.point_m))), 0.01);
        EXPECT_NEAR(glm::length(glm::vec3(s.normal)), 1, 1e-3);
        EXPECT_NEAR(s.diffuse.r, kDull, 0.004f);  // the shared exponent's steps
        if (place < gpu::kLightSamples) continue;
        EXPECT_NEAR(s.highlight.w, kShine - kDull, 0.004f);
        const glm::vec3 to_viewer = glm::normalize(bright_camera_m - glm::vec3(s.point_m));
        EXPECT_GT(glm::dot(to_viewer, glm::vec3(s.highlight)), 0.999f);
    }
    const size_t blocks = blocks_to_sample(*rig);
    EXPECT_GT(blocks, 150u);
    EXPECT_GT(samples, 0.9 * static_cast<double>(blocks)) << "few blocks compete for one place";
    EXPECT_GT(highlights, 100u);
}

TEST_F(SampleSurface, DoesNotDependOnTheOrderOfRecords) {
    const auto first = draw(*make_model()), second = draw(*make_model());
    ASSERT_EQ(first.size(), second.size());
    EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof first[0]), 0);
}

/// Whether a lamp gives the floor cosine over squared distance where the box is not between, and nothing where it is.
void expect_shadow_of_box(const std::vector<gpu::LightSample>& drawn, const float* received, glm::vec3 lamp_m) {
    uint32_t lit = 0, shaded = 0, wrong = 0;
    for (uint32_t i = 0; i < gpu::kLightSamples; ++i) {
        const gpu::LightSample& s = drawn[i];
        const bool is_floor = s.normal.y <= -0.99f && std::abs(s.point_m.y) <= 0.01f;
        if (s.point_m.w == 0 || !is_floor) continue;
        const glm::vec3 offset_m = lamp_m - glm::vec3(s.point_m);
        const float distance_m = glm::length(offset_m);
        const float open = glm::dot(offset_m, glm::vec3(s.normal)) /
                           (std::numbers::pi_v<float> * distance_m * distance_m * distance_m);
        const glm::dvec3 from(s.point_m), to(lamp_m);
        if (!box_between(from, to, 0.03)) {
            ++lit;
            wrong += std::abs(received[i] - open) > 0.01f * open;
        } else if (box_between(from, to, -0.03)) {
            ++shaded;
            wrong += received[i] != 0;
        }
    }
    EXPECT_GT(lit, 100u);
    EXPECT_GT(shaded, 5u);
    EXPECT_LE(wrong, (lit + shaded) / 100);
}

/// How often the reference decided.
struct Decided {
    uint32_t lit = 0, shaded = 0, low = 0;
    uint32_t wrong = 0;  ///< where hardware rounds otherwise, and passes a voxel by a hair on the other side
};

void expect_reference(const std::vector<gpu::LightSample>& drawn, const float* received, glm::vec3 lamp_m,
                      const reference::Volume& volume, Decided& decided) {
    for (uint32_t i = 0; i < gpu::kLightSamples; ++i) {
        const gpu::LightSample& s = drawn[i];
        if (s.point_m.w == 0) {
            EXPECT_EQ(received[i], 0);
            continue;
        }
        const reference::TrialLight expected =
            reference::try_light(volume, glm::dvec3(s.point_m), glm::dvec3(s.normal), glm::dvec3(lamp_m));
        // The march looks at nearest voxels, and takes half a voxel for noise.
        const double least_vox = expected.least_distance_m / volume.voxel_m;
        if (expected.received == 0) {
            ++decided.low;
            EXPECT_EQ(received[i], 0);
        } else if (least_vox > 0.5) {
            ++decided.lit;
            if (received[i] == 0)
                ++decided.wrong;
            else
                EXPECT_NEAR(received[i], expected.received, 1e-4 * expected.received) << "sample " << i;
        } else if (least_vox < -1.5) {
            ++decided.shaded;
            decided.wrong += received[i] != 0;
        }
    }
}

TEST_F(SampleSurface, LampsGiveCosineOverSquaredDistanceUnlessTheModelIsBetween) {
    const auto rig = make_model();
    const auto drawn = draw(*rig);
    std::vector<glm::vec3> places_m{{0.8f, -0.5f, 0.1f}, {-0.5f, -0.6f, -0.6f}};
    std::mt19937 random(9);
    std::uniform_real_distribution<float> side_m(-1, 1), height_m(-0.9f, -0.05f);
    // Every other one is near the box, or within.
    for (int i = 0; i < 8; ++i) {
        const float near = i % 2 == 0 ? 1.0f : 0.35f;
        places_m.emplace_back(near * side_m(random), near * height_m(random), near * side_m(random));
    }
    graph::FrameGraph frame = runner().begin();
    const VoxelMap& map = rig->fusion().map();
    const auto samples = frame.upload<gpu::LightSample>("samples", drawn);
    ReflectanceStateIds around;
    around.surroundings = frame.fill(frame.create_buffer("surroundings", kSurroundingsBytes), 0);
    const VoxelMapIds voxels = map.import(frame);
    add_mark_blocks(frame, around, map, voxels);
    const graph::Readback read =
        frame.read_back(add_try_lights(frame, {map, voxels, around.surroundings}, samples, places_m));
    run(std::move(frame));
    const auto received = read.as<float>();
    const reference::Volume volume = rig->fusion().volume();
    Decided decided;
    for (size_t lamp = 0; lamp < places_m.size(); ++lamp) {
        SCOPED_TRACE(text("lamp ", lamp));
        const float* const of_lamp = &received[lamp * gpu::kLightSamples];
        if (lamp < 2) expect_shadow_of_box(drawn, of_lamp, places_m[lamp]);
        expect_reference(drawn, of_lamp, places_m[lamp], volume, decided);
    }
    EXPECT_GT(decided.lit, 1000u);
    EXPECT_GT(decided.shaded, 100u);
    EXPECT_GT(decided.low, 30u);
    EXPECT_LE(decided.wrong, device().caps().software() ? 0 : decided.lit / 1000);
}

// A strip of the ceiling shows the sky; or what is as dark as a ceiling.
TEST_F(SampleSurface, SunsGiveCosinesWhereTheSkyIsOnTheWayAndTheModelIsNotBetween) {
    const auto rig = make_model();
    const auto drawn = draw(*rig);
    const std::vector<glm::vec3> directions{
        glm::normalize(glm::vec3(0.5f, -1, 0.1f)), glm::normalize(glm::vec3(-0.2f, -1, -0.6f)), {0, 1, 0}};
    const double cell_m = double{gpu::kSurroundingsCellM};
    const reference::Volume volume = rig->fusion().volume();
    for (const float radiance : {0.8f, 0.4f}) {
        std::set<std::array<int, 3>> sky;
        for (int x = -10; x < 10; ++x)
            for (int z = -40; z < 40; ++z)
                if (radiance > 0.5f) sky.insert({x, static_cast<int>(std::floor(kCeiling_m / cell_m)), z});
        graph::FrameGraph frame = runner().begin();
        const VoxelMap& map = rig->fusion().map();
        ReflectanceStateIds around;
        around.surroundings = frame.fill(frame.create_buffer("surroundings", kSurroundingsBytes), 0);
        add_ceiling(frame, around, [&](double x, double) { return std::abs(x) < 10 * cell_m ? radiance : 0.2f; });
        const VoxelMapIds voxels = map.import(frame);
        add_mark_blocks(frame, around, map, voxels);
        const auto samples = frame.upload<gpu::LightSample>("samples", drawn);
        const graph::Readback read =
            frame.read_back(add_try_suns(frame, {map, voxels, around.surroundings}, samples, directions,
                                         gpu::kLightSamples, glm::vec4(0, 0, 0, 10)));
        run(std::move(frame));
        const auto received = read.as<float>();
        Decided decided;
        uint32_t missed = 0;
        for (size_t sun = 0; sun < directions.size(); ++sun) {
            const glm::dvec3 direction(directions[sun]);
            for (uint32_t i = 0; i < gpu::kLightSamples; ++i) {
                const gpu::LightSample& s = drawn[i];
                const float got = received[sun * gpu::kLightSamples + i];
                const glm::dvec3 point_m(s.point_m), normal(s.normal);
                const double cosine = glm::dot(direction, normal);
                // The camera that saw the ceiling saw 1.5 m of it to each side.
                const glm::dvec3 above = point_m + direction * (kCeiling_m / direction.y);
                if (s.point_m.w == 0 || std::max(std::abs(above.x), std::abs(above.z)) > 1.3) continue;
                const double sky_m = reference::sky_on_way_m(sky, cell_m, point_m, normal, direction, 3);
                // There a ray may pass less of it than a step.
                const bool near_strip = std::abs(std::abs(above.x) - 10 * cell_m) < 0.03;
                const double least_vox =
                    reference::try_light(volume, point_m, normal, point_m + 5.0 * direction).least_distance_m /
                    volume.voxel_m;
                if (cosine < 0.04) {
                    ++decided.low;
                    EXPECT_EQ(got, 0);
                } else if (sky_m == 0 && !near_strip) {
                    ++missed;
                    decided.wrong += got != 0;
                } else if (cosine > 0.06 && sky_m > 0.005 && least_vox > 0.5) {
                    ++decided.lit;
                    decided.wrong += std::abs(got - static_cast<float>(cosine)) > 1e-5f;
                } else if (least_vox < -1.5) {
                    ++decided.shaded;
                    decided.wrong += got != 0;
                }
            }
        }
        const bool shows = radiance > 0.5f;
        EXPECT_EQ(decided.lit > 150, shows) << decided.lit;
        EXPECT_EQ(decided.shaded > 5, shows) << decided.shaded;
        EXPECT_GT(missed, 200u);
        EXPECT_GT(decided.low, 30u);
        EXPECT_LE(decided.wrong, device().caps().software() ? 0 : decided.lit / 1000);
    }
}

}  // namespace
}  // namespace patina::sample_surface_test
