#include "passes/fusion/raycast.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/reference/fusion/raycast.h"

namespace patina::raycast_test {
namespace {

const Intrinsics kCamera{{320, 240}, 300, 300, 159.5, 119.5, {}};

struct Errors {
    std::vector<double> depth_m, normal_deg;
    size_t missed = 0, invented = 0;

    static double quantile(std::vector<double> values, double q) {
        std::sort(values.begin(), values.end());
        return values.empty() ? 0 : values[static_cast<size_t>(q * static_cast<double>(values.size() - 1))];
    }
};

Errors compare(const FusionRig::View& view, const reference::DistanceField& scene, const RigidTransform& pose) {
    const Image<float> truth = reference::render_depth(scene, kCamera, pose, 4.0);
    Errors errors;
    for (size_t i = 0; i < truth.pixels().size(); ++i) {
        const float expected = truth.pixels()[i];
        const glm::vec4 hit = view.position_m.pixels()[i];
        if (expected == 0 || hit.w == 0) {
            errors.missed += expected != 0;
            errors.invented += hit.w != 0;
            continue;
        }
        errors.depth_m.push_back(std::abs(hit.w - expected));
        const glm::dvec3 normal(view.normal.pixels()[i]),
            expected_normal = reference::normal_at(scene, glm::dvec3(hit));
        // Not the arc cosine: it turns a rounding of 2^-11 in a half float into two degrees.
        const double sine = glm::length(glm::cross(normal, expected_normal));
        errors.normal_deg.push_back(glm::degrees(std::atan2(sine, glm::dot(normal, expected_normal))));
    }
    return errors;
}

class RaycastTest : public GpuTest {};

TEST_F(RaycastTest, FusedSphereAndBoxAreFoundWhereTheyAre) {
    const std::pair<const char*, reference::DistanceField> scenes[] = {
        {"sphere", reference::sphere({0, 0, 0}, 0.3)}, {"box", reference::box({0, 0, 0}, {0.2, 0.25, 0.3})}};
    for (const auto& [name, scene] : scenes) {
        FusionRig rig(device(), runner());
        for (const RigidTransform& pose : reference::orbit({0, 0, 0}, 1.2, 40)) {
            rig.fuse(kCamera, pose, reference::render_depth(scene, kCamera, pose, 4.0));
        }
        for (const MapAccess access : {MapAccess::kStorage, preferred_map_access(device().caps(), rig.map())}) {
            const RigidTransform pose = reference::orbit({0, 0, 0}, 1.0, 7)[3];
            const Errors errors = compare(rig.raycast(kCamera, pose, access), scene, pose);
            SCOPED_TRACE(name);
            EXPECT_LE(Errors::quantile(errors.depth_m, 0.5), 0.0005);
            EXPECT_LE(Errors::quantile(errors.depth_m, 0.99), 0.0025);
            EXPECT_LE(Errors::quantile(errors.normal_deg, 0.5), 2.0);
            // Edges and limbs are rounded by a fraction of a pixel.
            EXPECT_LE(errors.missed + errors.invented, errors.depth_m.size() / 100);
        }
    }
}

/// A ball seen from all around, in a map of 1 cm voxels.
FusionRig fused_ball(vulkan::Device& device, graph::Runner& runner, const VoxelMapSettings& map = {0.01f, 8192}) {
    FusionRig rig(device, runner, map);
    const reference::DistanceField ball = reference::sphere({0, 0, 0}, 0.25);
    for (const RigidTransform& pose : reference::orbit({0, 0, 0}, 1.0, 20)) {
        rig.fuse(kCamera, pose, reference::render_depth(ball, kCamera, pose, 4.0));
    }
    return rig;
}

size_t hits(const FusionRig::View& view) {
    return static_cast<size_t>(std::count_if(view.position_m.pixels().begin(), view.position_m.pixels().end(),
                                             [](const glm::vec4& pixel) { return pixel.w != 0; }));
}

/// True when two views are the same to the bit.
bool same(const FusionRig::View& a, const FusionRig::View& b) {
    return a.position_m.pixels() == b.position_m.pixels() && a.normal.pixels() == b.normal.pixels();
}

const RigidTransform kLook = reference::look_at({0.4, -0.3, -0.7}, {0, 0, 0});

TEST_F(RaycastTest, AgreesWithDenseMarchingThroughTheSameVoxels) {
    FusionRig rig = fused_ball(device(), runner());
    const reference::Volume volume = rig.volume();
    for (const Extent2D extent : {Extent2D{1, 1}, {13, 7}, {65, 33}}) {
        const Intrinsics camera = pinhole_camera(extent);
        const Image<float> expected = reference::raycast(volume, camera, kLook, 0.1, 1.5);
        const FusionRig::View got = rig.raycast(camera, kLook);
        size_t both = 0, differing = 0, off = 0;
        for (size_t i = 0; i < extent.area(); ++i) {
            const float depth = got.position_m.pixels()[i].w, want = expected.pixels()[i];
            differing += (depth == 0) != (want == 0);
            if (depth == 0 || want == 0) continue;
            ++both;
            // A tenth of a voxel: the shader interpolates once and takes one Newton step.
            off += std::abs(depth - want) > 0.001;
            const glm::dvec3 ray((double(i % extent.width) - camera.cx) / camera.fx,
                                 (double(i / extent.width) - camera.cy) / camera.fy, 1);
            const glm::dvec3 point(kLook * glm::dvec4(ray * double(depth), 1));
            ASSERT_NEAR(glm::length(point - glm::dvec3(got.position_m.pixels()[i])), 0, 2e-6);
            const float length = glm::length(glm::vec3(got.normal.pixels()[i]));
            ASSERT_TRUE(length == 0 || std::abs(length - 1) < 2e-3f);
        }
        EXPECT_GE(both, extent.area() / 10) << extent;
        EXPECT_LE(differing + off, both / 25) << extent;
    }
}

TEST_F(RaycastTest, SurfaceIsMetFromItsSeenSideOnly) {
    FusionRig rig = fused_ball(device(), runner());
    EXPECT_EQ(hits(rig.raycast(kCamera, reference::look_at({0, 0, 0}, {0, 0, 1}))), 0u);
    EXPECT_EQ(hits(rig.raycast(kCamera, reference::look_at({0, 0, -1}, {0, 0, -2}))), 0u);

    // A wall seen from one side, looked at from the other.
    FusionRig wall(device(), runner(), {0.01f, 8192});
    const RigidTransform front = reference::look_at({0, 0, -1}, {0, 0, 0});
    for (int i = 0; i < 4; ++i) wall.fuse(kCamera, front, Image<float>(kCamera.extent, 1.0f));
    EXPECT_GT(hits(wall.raycast(kCamera, front)), kCamera.extent.area() * 99 / 100);
    EXPECT_EQ(hits(wall.raycast(kCamera, reference::look_at({0, 0, 1}, {0, 0, 0}))), 0u);
}

TEST_F(RaycastTest, RaysThatPassByAnOutlineMeetWhatIsBehind) {
    const reference::DistanceField ball = reference::sphere({0, 0, 0}, 0.25),
                                   wall = reference::box({0, 0, 1.1}, {2, 2, 0.5});
    const reference::DistanceField scene = [&](glm::dvec3 p) { return std::min(ball(p), wall(p)); };
    FusionRig rig(device(), runner(), {0.01f, 16384});
    for (int i = 0; i < 16; ++i) {
        const double angle = i * std::numbers::pi / 8;
        const RigidTransform pose =
            reference::look_at({0.3 * std::cos(angle), 0.3 * std::sin(angle), -0.9}, {0, 0, 0.1});
        rig.fuse(kCamera, pose, reference::render_depth(scene, kCamera, pose, 4.0));
    }
    const reference::Volume volume = rig.volume();
    const Intrinsics camera = pinhole_camera({160, 120});
    for (const double x : {-0.25, 0.02, 0.2}) {
        const RigidTransform pose = reference::look_at({x, 0.07, -0.85}, {0, 0, 0.1});
        const Image<float> expected = reference::raycast(volume, camera, pose, 0.1, 2);
        const FusionRig::View got = rig.raycast(camera, pose);
        size_t both = 0, missed = 0, off = 0;
        for (size_t i = 0; i < expected.pixels().size(); ++i) {
            const float depth = got.position_m.pixels()[i].w, want = expected.pixels()[i];
            missed += want != 0 && depth == 0;
            both += want != 0 && depth != 0;
            off += want != 0 && std::abs(depth - want) > 0.005;
        }
        EXPECT_GE(both, expected.pixels().size() * 8 / 10) << x;
        EXPECT_EQ(missed, 0u) << x;
        EXPECT_LE(off, both / 100) << x;
    }
}

TEST_F(RaycastTest, RaysThatPassByAnOutlineDoNotMeetBacks) {
    FusionRig rig = fused_ball(device(), runner(), {0.01f, 16384});
    const reference::DistanceField wall = reference::box({0, 0, 0.8}, {2, 2, 0.1});
    const RigidTransform behind = reference::look_at({0, 0, 2}, {0, 0, 0.8});
    rig.fuse(kCamera, behind, reference::render_depth(wall, kCamera, behind, 4.0));
    const reference::DistanceField ball = reference::sphere({0, 0, 0}, 0.25);
    size_t on_ball = 0, beyond = 0;
    for (const double x : {-0.3, -0.1, 0.1, 0.3}) {
        const FusionRig::View view = rig.raycast(kCamera, reference::look_at({x, 0.05, -1}, {0, 0, 0}));
        for (const glm::vec4& hit : view.position_m.pixels()) {
            if (hit.w == 0) continue;
            const bool near = std::abs(ball(glm::dvec3(hit))) < 0.05;
            ++(near ? on_ball : beyond);
        }
    }
    EXPECT_GT(on_ball, 10000u);
    EXPECT_EQ(beyond, 0u);
}

TEST_F(RaycastTest, AnEmptyMapHasNoSurface) {
    FusionRig rig(device(), runner(), {0.01f, 64});
    for (const Extent2D extent : {Extent2D{1, 1}, {13, 7}, {65, 33}}) {
        EXPECT_EQ(hits(rig.raycast(pinhole_camera(extent), kLook)), 0u);
        rig.fuse(pinhole_camera(extent), kLook, Image<float>(extent, 0.0f));
    }
}

TEST_F(RaycastTest, BothWaysToReadTheMapGiveTheSameBytes) {
    FusionRig rig = fused_ball(device(), runner());
    if (preferred_map_access(device().caps(), rig.map()) != MapAccess::kTexel) {
        GTEST_SKIP() << "the device prefers storage buffers, or its texel buffers hold fewer than "
                     << (uint64_t{1} << rig.map().grid().chunk_shift) * gpu::kBlockVoxels << " elements";
    }
    const FusionRig::View storage = rig.raycast(kCamera, kLook, MapAccess::kStorage);
    EXPECT_GT(hits(storage), 1000u);
    EXPECT_TRUE(same(storage, rig.raycast(kCamera, kLook, MapAccess::kTexel)));
}

TEST_F(RaycastTest, TwoMapsOfTheSameFramesGiveTheSameBytes) {
    FusionRig first = fused_ball(device(), runner()), second = fused_ball(device(), runner());
    const FusionRig::View view = first.raycast(kCamera, kLook);
    EXPECT_GT(hits(view), 1000u);
    EXPECT_TRUE(same(view, first.raycast(kCamera, kLook)));
    EXPECT_TRUE(same(view, second.raycast(kCamera, kLook)));
}

TEST_F(RaycastTest, ChunksDoNotShow) {
    FusionRig single = fused_ball(device(), runner(), {0.008f, 640});
    // Chunks of 128 blocks.
    FusionRig split = fused_ball(device(), runner(), {0.008f, 640, 128 * 2048});
    ASSERT_EQ(split.map().chunks(), gpu::kMaxVoxelChunks);
    ASSERT_GT(split.counters().high_water, 3u * 128);
    ASSERT_EQ(split.counters().refused_blocks, 0u);
    const FusionRig::View view = single.raycast(kCamera, kLook);
    for (const MapAccess access : {MapAccess::kStorage, preferred_map_access(device().caps(), split.map())}) {
        EXPECT_TRUE(same(view, split.raycast(kCamera, kLook, access)));
    }
}

}  // namespace
}  // namespace patina::raycast_test
