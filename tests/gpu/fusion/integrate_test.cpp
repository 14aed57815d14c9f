#include "passes/fusion/integrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"

namespace patina::integrate_test {
namespace {

using reference::Observation;
using reference::Volume;
using reference::Voxel;

const Intrinsics kCamera{{96, 80}, 90, 91, 47.2, 40.7, {}};
constexpr float kVoxelM = 0.01f;
constexpr double kStepM = kVoxelM * gpu::kSdfRangeVox / 32767;  // of a stored distance
// Of a stored colour up to 2, mostly of its blue: 10 bits of the root of a fourth, rounded up or down.
const double kColorStep = 2 * std::sqrt(2.0 / 4) * 4 / 1023 * 1.2;

FusionSettings every_pixel() {
    FusionSettings settings;
    settings.allocation_stride_px = 1;
    return settings;
}

/// A picture whose colours say where a pixel is.
ColorView color_of(const Intrinsics& camera, const RigidTransform& pose) {
    ColorView view{camera, pose, Image<glm::vec4>(camera.extent)};
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            view.linear.at(x, y) = glm::vec4(float(x) / 128, float(y) / 128, float((x * 7 + y * 3) % 16) / 8, 1);
        }
    }
    return view;
}

/// One frame for both: the rig's and the reference's.
struct Shot {
    RigidTransform pose;
    Image<float> depth_m;
    std::optional<ColorView> color;

    void fuse(FusionRig& rig) const { rig.fuse(kCamera, pose, depth_m, color); }

    Observation observation() const {
        Observation seen{kCamera, pose, depth_m, reference::measure_slope(depth_m, kCamera), {}};
        for (reference::Slope& slope : seen.slope.pixels()) slope = reference::rounded(slope);
        if (color) seen.color = {color->camera, color->world_from_camera, color->linear};
        return seen;
    }
};

std::vector<Shot> shots(int count, bool with_color) {
    const reference::DistanceField ball = reference::sphere({0, 0, 0}, 0.25);
    const reference::DistanceField floor = reference::half_space({0, -1, 0}, -0.2);
    const auto scene = [=](glm::dvec3 p) { return std::min(ball(p), floor(p)); };
    std::vector<Shot> result;
    for (int i = 0; i < count; ++i) {
        const RigidTransform pose =
            reference::look_at({0.7 * std::sin(i * 1.1), -0.5, -0.8 * std::cos(i * 1.1)}, {0, 0, 0});
        Shot shot{pose, reference::render_depth(scene, kCamera, pose, 4.0), {}};
        if (with_color) {
            RigidTransform beside = pose;
            beside[3] += pose[0] * 0.05;
            shot.color = color_of({{120, 70}, 100, 95, 61.3, 33.9, {}}, beside);
        }
        result.push_back(shot);
    }
    return result;
}

class IntegrateTest : public GpuTest {
  protected:
    /// Counts voxels that differ by more than rounding explains.
    static void expect_same(const Volume& got, const Volume& expected, double color_tolerance) {
        size_t seen = 0, weights = 0, distances = 0, colored = 0, colors = 0;
        for (const auto& [block, voxels] : expected.blocks) {
            const std::vector<Voxel>& found = got.blocks.at(block);
            for (size_t i = 0; i < 512; ++i) {
                const Voxel &want = voxels[i], &have = found[i];
                seen += want.weight > 0;
                weights += std::abs(want.weight - have.weight) > 0;
                distances += std::abs(want.sdf_m - have.sdf_m) > 3 * kStepM + 1e-6;
                colored += want.colored;
                colors += want.colored != have.colored || glm::length(want.color - have.color) > color_tolerance;
            }
        }
        EXPECT_GT(seen, 50000u);
        // Where a voxel's centre falls within single precision's rounding of a limit (of a pixel, of the band, of two
        // steps of slope or weight), either side is right.
        EXPECT_LE(weights, seen / 500);
        EXPECT_LE(distances, seen / 500);
        EXPECT_LE(colors, colored / 200);
    }
};

TEST_F(IntegrateTest, OneFrameAndSeveralAgreeWithTheReference) {
    for (const bool with_color : {false, true}) {
        for (const int frames : {1, 4, 9}) {
            FusionSettings settings = every_pixel();
            if (frames > 4) settings.max_weight = 1;  // so that blocks settle
            FusionRig rig(device(), runner(), {kVoxelM, 8192}, settings);
            size_t waiting = 0;
            const std::vector<Shot> all = shots(frames, with_color);
            Volume expected{kVoxelM, {}};
            for (const Shot& shot : all) {
                const reference::Fusion fusion = rig.reference_fusion();
                shot.fuse(rig);
                for (const auto& block : rig.allocated()) expected.blocks.try_emplace(block, 512);
                waiting += reference::integrate(expected, shot.observation(), fusion);
            }
            EXPECT_EQ(waiting > 200, with_color && frames > 4) << waiting;
            SCOPED_TRACE(::testing::Message()
                         << frames << " frames, " << (with_color ? "with" : "without") << " colour");
            expect_same(rig.volume(), expected, frames * kColorStep);
        }
    }
}

TEST_F(IntegrateTest, AFrontalPlaneIsIntegratedByTheBook) {
    const Image<float> wall(kCamera.extent, 1.0f);
    FusionRig rig(device(), runner(), {kVoxelM, 4096}, every_pixel());
    const ColorView color{kCamera, RigidTransform(1.0), Image<glm::vec4>(kCamera.extent, glm::vec4(0.5f, 0.25f, 2, 1))};
    rig.fuse(kCamera, RigidTransform(1.0), wall, color);
    const Volume volume = rig.volume();
    const reference::Fusion fusion = rig.reference_fusion();
    const double truncation = fusion.truncation_m + fusion.truncation_slope;
    for (int z = 96; z < 104; ++z) {
        const double in_front_m = 1.0 - (z + 0.5) * kVoxelM;
        const Voxel* voxel = volume.find({0, 0, z});
        ASSERT_NE(voxel, nullptr);
        if (in_front_m < -truncation) {
            EXPECT_EQ(voxel->weight, 0) << z;
            continue;
        }
        EXPECT_NEAR(voxel->sdf_m, std::min(in_front_m, truncation), kStepM) << z;
        const double trust = std::clamp(1 + in_front_m / truncation, 0.0, 1.0);
        EXPECT_EQ(voxel->weight, std::max(std::round(16 * std::pow(trust, 1.5)), 1.0)) << z;
        EXPECT_EQ(voxel->colored, std::abs(in_front_m) <= 0.018) << z;
        if (voxel->colored) {
            EXPECT_NEAR(glm::length(voxel->color - glm::dvec3(0.5, 0.25, 2)), 0, 0.007);
        }
    }
}

TEST_F(IntegrateTest, FreeSpaceBesideAnEdgeIsAtMostAPixelFromIt) {
    // A board 1 m away covers the left half, a wall at 1.1 m lies behind it.
    Image<float> depth_m(kCamera.extent, 1.1f);
    for (uint32_t y = 0; y < 80; ++y) std::fill_n(&depth_m.at(0, y), 51, 1.0f);
    FusionRig rig(device(), runner(), {kVoxelM, 4096}, every_pixel());
    rig.fuse(kCamera, RigidTransform(1.0), depth_m, {});
    const Volume volume = rig.volume();
    const reference::Fusion fusion = rig.reference_fusion();
    const double z_m = 0.995, pixel_m = z_m / kCamera.fx,
                 truncation = fusion.truncation_m + fusion.truncation_slope * 1.1;
    ASSERT_LT(pixel_m, truncation / 2);
    // Voxel 3 appears at x = 50.4, which shows the board; 4 at 51.3, the first pixel of the wall; 5 at 52.2.
    for (const auto& [x, expected_m] : {std::pair(3, 1.0 - z_m), {4, pixel_m}, {5, truncation}}) {
        const Voxel* voxel = volume.find({x, 0, 99});
        ASSERT_NE(voxel, nullptr) << x;
        EXPECT_NEAR(voxel->sdf_m, expected_m, kStepM) << x;
    }
}

TEST_F(IntegrateTest, TheOrderOfFramesDoesNotMatterBelowTheWeightCap) {
    std::vector<Shot> all = shots(3, false);
    // All blocks first, as voxels of a block that comes late miss the frames before.
    const auto fuse_all = [&](FusionRig& rig) {
        for (const Shot& shot : all) shot.fuse(rig);
    };
    FusionRig forward(device(), runner(), {kVoxelM, 8192}, every_pixel());
    const auto only_seen_by_all = [&](const std::set<reference::BlockCoordinates>& blocks) {
        std::set<reference::BlockCoordinates> common = blocks;
        for (const Shot& shot : all) {
            FusionRig alone(device(), runner(), {kVoxelM, 8192}, every_pixel());
            shot.fuse(alone);
            std::erase_if(common,
                          [touched = alone.allocated()](const auto& block) { return !touched.contains(block); });
        }
        return common;
    };
    fuse_all(forward);
    const auto common = only_seen_by_all(forward.allocated());
    std::reverse(all.begin(), all.end());
    FusionRig backward(device(), runner(), {kVoxelM, 8192}, every_pixel());
    fuse_all(backward);
    const Volume first = forward.volume(), second = backward.volume();
    size_t compared = 0;
    for (const auto& block : common) {
        for (size_t i = 0; i < 512; ++i) {
            const Voxel &a = first.blocks.at(block)[i], &b = second.blocks.at(block)[i];
            ASSERT_EQ(a.weight, b.weight);
            ASSERT_NEAR(a.sdf_m, b.sdf_m, 2.01 * kStepM);
            compared += a.weight > 16;
        }
    }
    EXPECT_GT(compared, 1000u);
}

TEST_F(IntegrateTest, WeightsStopAtTheirCapAndTheMeanSlides) {
    FusionSettings settings = every_pixel();
    settings.max_weight = 3;
    settings.max_color_weight = 2;
    settings.settled_color_every = 1;
    FusionRig rig(device(), runner(), {kVoxelM, 4096}, settings);
    const auto fuse = [&](float depth, float red) {
        const ColorView color{kCamera, RigidTransform(1.0), Image<glm::vec4>(kCamera.extent, glm::vec4(red, 0, 0, 1))};
        rig.fuse(kCamera, RigidTransform(1.0), Image<float>(kCamera.extent, depth), color);
        return *rig.volume().find({0, 0, 99});  // 0.995 m
    };
    for (int i = 0; i < 5; ++i) fuse(1.0f, 0.5f);
    const Voxel before = fuse(1.0f, 0.5f), after = fuse(1.008f, 1.0f);
    EXPECT_EQ(before.weight, 48);
    EXPECT_EQ(after.weight, 48);
    EXPECT_NEAR(after.sdf_m, (0.005 * 48 + 0.013 * 16) / 64, 2 * kStepM);
    EXPECT_NEAR(after.color.r, 0.75, 3e-3);  // 16 of a capped 32
}

TEST_F(IntegrateTest, SettledBlocksTakeColourByTurns) {
    // The camera looks along z, then against it; voxels 5 mm in front of the wall lie in the blocks with z = 12 and
    // -13.
    for (const auto& [toward, block_z, voxel_z] : {std::tuple(1.0, 12, 99), {-1.0, -13, -100}}) {
        FusionSettings settings = every_pixel();
        settings.settled_color_every = 3;
        FusionRig rig(device(), runner(), {kVoxelM, 4096}, settings);
        const RigidTransform pose = reference::look_at({0, 0, 0}, {0, 0, toward});
        int frames = 0;
        const auto fuse = [&](float red) {
            const ColorView color{kCamera, pose, Image<glm::vec4>(kCamera.extent, glm::vec4(red, 0, 0, 1))};
            rig.fuse(kCamera, pose, Image<float>(kCamera.extent, 1.0f), color);
            ++frames;
        };
        const auto reds = [&, z = voxel_z] {
            const Volume volume = rig.volume();
            std::array<double, 5> red{};
            for (int x = -2; x < 3; ++x) red[size_t(x + 2)] = volume.find({x * 8, 0, z})->color.r;
            return red;
        };
        const auto expect_changed = [&](float red, auto&& turn) {
            const std::array<double, 5> before = reds();
            fuse(red);
            const std::array<double, 5> after = reds();
            for (int x = -2; x < 3; ++x) {
                const auto i = size_t(x + 2);
                EXPECT_EQ(std::abs(after[i] - before[i]) > 0.02, turn(x)) << "block " << x << ", frame " << frames;
            }
        };
        fuse(0.25f);
        for (const float red : {0.75f, 0.25f}) expect_changed(red, [](int) { return true; });  // few samples
        while (frames < 30) fuse(0.25f);  // voxels behind the wall gain weight slowly
        for (const float red : {1.0f, 1.25f, 1.5f, 1.75f, 2.0f, 2.25f}) {
            const int turn = 2560 + block_z + frames;
            expect_changed(red, [turn](int x) { return (x + turn) % 3 == 0; });
        }
    }
}

TEST_F(IntegrateTest, ReadingsThatSayNothingChangeNothing) {
    FusionRig rig(device(), runner(), {kVoxelM, 4096}, every_pixel());
    const Image<float> wall(kCamera.extent, 1.0f);
    rig.fuse(kCamera, RigidTransform(1.0), wall, color_of(kCamera, RigidTransform(1.0)));
    const MapContent before = rig.content();
    rig.fuse(kCamera, RigidTransform(1.0), Image<float>(kCamera.extent, 0.0f), color_of(kCamera, RigidTransform(1.0)));
    EXPECT_EQ(rig.content(), before);  // no reading
    const Image<float> too_far(kCamera.extent, rig.settings().max_depth_m + 0.01f);
    rig.fuse(kCamera, RigidTransform(1.0), too_far, color_of(kCamera, RigidTransform(1.0)));
    EXPECT_EQ(rig.content(), before);  // beyond max_depth_m
    // Every pixel alone on its depth: no plane.
    Image<float> flying(kCamera.extent);
    for (size_t i = 0; i < flying.pixels().size(); ++i) flying.pixels()[i] = 0.5f + 0.1f * float(i * 7 % 11);
    rig.fuse(kCamera, RigidTransform(1.0), flying);
    const MapContent after = rig.content();
    for (const auto& [coordinates, block] : before) ASSERT_EQ(after.at(coordinates), block);
    // Far behind a surface nothing is known: a nearer wall leaves this one as it is.
    rig.fuse(kCamera, RigidTransform(1.0), Image<float>(kCamera.extent, 0.8f), color_of(kCamera, RigidTransform(1.0)));
    const MapContent occluded = rig.content();
    for (const auto& [coordinates, block] : before) ASSERT_EQ(occluded.at(coordinates), block);
}

TEST_F(IntegrateTest, ColourIsSampledThroughItsOwnCamera) {
    // A colour camera 10 cm to the right, turned by 10 degrees, of another size; half of its picture is clipped.
    RigidTransform pose = reference::look_at({0.1, 0, 0}, {0.1 - std::tan(glm::radians(10.0)), 0, 1});
    const Intrinsics camera{{130, 70}, 110, 100, 60, 30, {}};
    ColorView color = color_of(camera, pose);
    for (uint32_t y = 0; y < 70; ++y) {
        for (uint32_t x = 0; x < 65; ++x) color.linear.at(x, y).a = 0;
    }
    FusionRig rig(device(), runner(), {kVoxelM, 4096}, every_pixel());
    rig.fuse(kCamera, RigidTransform(1.0), Image<float>(kCamera.extent, 1.0f), color);
    const Volume volume = rig.volume();
    size_t colored = 0, clipped = 0, outside = 0;
    for (const auto& [block, voxels] : volume.blocks) {
        for (int i = 0; i < 512; ++i) {
            const Voxel& voxel = voxels[static_cast<size_t>(i)];
            const glm::dvec3 center = volume.center_m(block, i);
            if (voxel.weight == 0 || std::abs(voxel.sdf_m) > 0.0179) {
                ASSERT_TRUE(!voxel.colored || std::abs(voxel.sdf_m) < 0.0181);
                continue;
            }
            const glm::dvec2 px = project(camera, glm::dvec3(rigid_inverse(pose) * glm::dvec4(center, 1)));
            if (at_rounding_limit(px)) continue;
            const glm::dvec2 pixel = glm::floor(px + 0.5);
            if (!camera.extent.contains(int(pixel.x), int(pixel.y))) {
                ++outside;
                ASSERT_FALSE(voxel.colored);
            } else if (pixel.x < 65) {
                ++clipped;
                ASSERT_FALSE(voxel.colored);
            } else {
                ++colored;
                const glm::dvec3 want(color.linear.at(uint32_t(pixel.x), uint32_t(pixel.y)));
                ASSERT_TRUE(voxel.colored);
                ASSERT_NEAR(glm::length(voxel.color - want), 0, kColorStep);
            }
        }
    }
    EXPECT_GT(colored, 1000u);
    EXPECT_GT(clipped, 1000u);
    EXPECT_GT(outside, 100u);
}

TEST_F(IntegrateTest, EveryChunkHoldsItsBlocks) {
    // Chunks of 1024 blocks instead of one: all five are used.
    const VoxelMapSettings one{kVoxelM, 5120}, many{kVoxelM, 5120, 1024 * 2048};
    FusionRig single(device(), runner(), one, every_pixel()), split(device(), runner(), many, every_pixel());
    ASSERT_EQ(split.map().chunks(), gpu::kMaxVoxelChunks);
    for (uint32_t i = 0; i < 3; ++i) {
        const RigidTransform pose = reference::look_at({0.2 * i, 0, -1}, {0, 0, 0});
        const Image<float> depth_m = random_depth(kCamera.extent, i);
        for (FusionRig* rig : {&single, &split}) rig->fuse(kCamera, pose, depth_m, color_of(kCamera, pose));
    }
    EXPECT_GT(split.counters().high_water, 4u * 1024);
    EXPECT_EQ(split.content(), single.content());
}

}  // namespace
}  // namespace patina::integrate_test
