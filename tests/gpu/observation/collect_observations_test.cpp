#include "tests/reference/observation/collect_observations.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/observation/observed_scene.h"

namespace patina::collect_observations_test {
namespace {

using namespace observed_scene;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

glm::dvec3 center_of(const std::array<int, 3>& at, double voxel_m) {
    return (glm::dvec3(at[0], at[1], at[2]) + 0.5) * voxel_m;
}

glm::dvec3 point_of(const std::array<int, 3>& at, const reference::ObservedVoxel& voxel, double voxel_m) {
    return center_of(at, voxel_m) + voxel.normal * voxel.offset_vox * voxel_m;
}

// The blocks around what is seen are allocated within four frames; every pixel then looks for voxels.
ObservationSettings every_pixel() {
    ObservationSettings settings;
    settings.stride_px = 1;
    return settings;
}

class CollectObservations : public GpuTest {
  protected:
    const reference::DistanceField wall_ = reference::half_space({0, 0, -1}, -1.003);  // z = 1.003, free before it
    const RigidTransform pose_{1.0};

    ObservationRig rig(const ObservationSettings& settings = every_pixel(), const ObservationMapSettings& map = {}) {
        return {device(), runner(), map, settings};
    }
};

TEST_F(CollectObservations, AWallIsSeenAsItIsFromEveryPose) {
    for (const float voxel_m : {0.02f, 0.01f}) {
        ObservationMapSettings map;
        map.voxel_m = voxel_m;
        ObservationRig rig = this->rig(every_pixel(), map);
        const RigidTransform poses[] = {pose_, reference::look_at({0.3, -0.1, 0.1}, {0, 0, 1})};
        for (const RigidTransform& pose : poses) rig.fuse(frame_of(wall_, pose));
        for (const RigidTransform& pose : poses) rig.collect(frame_of(wall_, pose));
        size_t seen_twice = 0;
        double off_degrees = 0;
        const ObservationContent content = rig.content();
        for (const auto& [at, record] : content) {
            const reference::ObservedVoxel voxel = unpack(record);
            if (voxel.surface_samples == 0) continue;
            // Depth is exact; what is left is the fusion's rounding of slopes to 11 bits, most where it saw least.
            EXPECT_LT(degrees_between(voxel.normal, {0, 0, -1}), 1);
            off_degrees += degrees_between(voxel.normal, {0, 0, -1}) / static_cast<double>(content.size());
            const glm::dvec3 point = point_of(at, voxel, voxel_m);
            EXPECT_NEAR(point.z, 1.003, 1e-4);
            EXPECT_LT(glm::distance(glm::dvec2(point), glm::dvec2(center_of(at, voxel_m))), 1e-4);
            for (const reference::SeenColor& seen : voxel.seen) {
                const auto off = [&](const RigidTransform& pose) {
                    return degrees_between(seen.direction, glm::dvec3(pose[3]) - point);
                };
                const RigidTransform& pose = off(poses[0]) < off(poses[1]) ? poses[0] : poses[1];
                EXPECT_LT(off(pose), 0.03);  // 13 bits: 0.02 degrees
                const glm::dvec2 pixel = project(kCamera, glm::dvec3(rigid_inverse(pose) * glm::dvec4(point, 1)));
                const glm::dvec3 expected(ramp(pixel.x, pixel.y));
                // Half of 1/256 of the largest channel, half floats of the image, a hundredth of a pixel.
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen.color[c], expected[c], 0.0025);
                EXPECT_EQ(seen.clipped, (std::array<bool, 3>{}));
            }
            seen_twice += voxel.seen.size() == 2;
        }
        EXPECT_LT(off_degrees, 0.04);
        EXPECT_GT(seen_twice, 0.65 * content.size());
        EXPECT_GT(content.size(), (voxel_m == 0.02f ? 1400 : 5000));
    }
}

TEST_F(CollectObservations, ASpheresNormalsAndPointsAreThoseOfTheVoxel) {
    const glm::dvec3 center(0, 0, 1);
    const double radius = 0.25;
    const auto ball = reference::sphere(center, radius);
    ObservationRig rig = this->rig();
    std::vector<RigFrame> frames;
    for (const double x : {-0.5, -0.2, 0.2, 0.5}) {
        frames.push_back(frame_of(ball, reference::look_at({x, 0.3 * x, 0.1}, center)));
    }
    for (const RigFrame& frame : frames) rig.fuse(frame, 2);
    for (int round = 0; round < 3; ++round) {
        for (const RigFrame& frame : frames) rig.collect(frame);
    }
    double worst_degrees = 0, worst_m = 0;
    size_t observed = 0;
    for (const auto& [at, record] : rig.content()) {
        const reference::ObservedVoxel voxel = unpack(record);
        // Without an observation lies what was only seen beside edges: the rim, which the model knows least.
        if (voxel.surface_samples < 6 || voxel.seen.empty()) continue;
        const glm::dvec3 point = point_of(at, voxel, 0.02);
        worst_degrees = std::max(worst_degrees, degrees_between(voxel.normal, point - center));
        worst_m = std::max(worst_m, std::abs(glm::distance(point, center) - radius));
        ++observed;
    }
    EXPECT_GT(observed, 250u);
    EXPECT_LT(worst_degrees, 4);
    EXPECT_LT(worst_m, 0.001);
}

TEST_F(CollectObservations, OccludedFarGrazingAndColourlessSurfaceIsLeftOut) {
    const auto observed = [&](const RigFrame& fused, const RigFrame& collected, const ObservationSettings& settings) {
        ObservationRig rig = this->rig(settings);
        rig.fuse(fused);
        rig.collect(collected);
        ObservationContent content = rig.content();
        std::erase_if(content, [](const auto& item) { return item.second.count() == 0; });
        return content;
    };
    const RigFrame wall = frame_of(wall_, pose_);
    const size_t all = observed(wall, wall, every_pixel()).size();
    ASSERT_GT(all, 1000u);

    RigFrame occluded = wall;  // something new stands before the left half
    for (uint32_t y = 0; y < 120; ++y) std::fill_n(&occluded.depth_m.at(0, y), 80, 0.9f);
    for (const auto& [at, record] : observed(wall, occluded, every_pixel())) EXPECT_GE(at[0], 0);

    ObservationSettings near = every_pixel();
    near.max_distance_m = 1.1f;
    const ObservationContent disc = observed(wall, wall, near);
    EXPECT_GT(disc.size(), 500u);
    for (const auto& [at, record] : disc) EXPECT_LE(glm::length(center_of(at, 0.02)), 1.13);

    const RigidTransform tilted = reference::look_at({0.8, 0, 0.6}, {0, 0, 1});
    const RigFrame grazing = frame_of(wall_, tilted);
    ObservationSettings frontal = every_pixel();
    frontal.max_angle_degrees = 60;
    const ObservationContent facing = observed(grazing, grazing, frontal);
    EXPECT_GT(facing.size(), 100u);
    EXPECT_LT(facing.size(), observed(grazing, grazing, every_pixel()).size());
    for (const auto& [at, record] : facing) {
        EXPECT_LE(degrees_between({0, 0, -1}, glm::dvec3(tilted[3]) - center_of(at, 0.02)), 61.5);
    }

    RigFrame colorless = wall;
    for (uint32_t y = 0; y < 120; ++y) std::fill_n(&colorless.color.linear.at(0, y), 80, glm::vec4(0));
    const ObservationContent right = observed(wall, colorless, every_pixel());
    EXPECT_GT(right.size(), all / 3);
    for (const auto& [at, record] : right) EXPECT_GE(at[0], 0);
}

TEST_F(CollectObservations, ColoursNearAnEdgeOfTheDepthImageAreLeftOut) {
    // A board before the wall: its right edge is at x = 0.
    const auto board = reference::box({-0.3, 0, 0.8}, {0.3, 0.4, 0.02});
    RigFrame frame = frame_of([&](glm::dvec3 p) { return std::min(board(p), wall_(p)); }, pose_);
    frame.labels = Image<uint32_t>(kCamera.extent, 7);
    for (const uint32_t margin : {2u, 6u}) {
        ObservationSettings settings = every_pixel();
        settings.edge_margin_px = margin;
        ObservationRig rig = this->rig(settings);
        rig.fuse(frame);
        rig.collect(frame);
        size_t on_board = 0, labelled_only = 0;
        double nearest_px = 1e9;
        for (const auto& [at, record] : rig.content()) {
            const reference::ObservedVoxel voxel = unpack(record);
            const glm::dvec3 point = point_of(at, voxel, 0.02);
            if (std::abs(point.y) > 0.2) continue;
            labelled_only += voxel.seen.empty() && voxel.label == 7;
            if (voxel.seen.empty()) continue;
            // The board's edge appears at x = 79.5: what lies left of it is the board, right of it the wall.
            nearest_px = std::min(nearest_px, std::abs(project(kCamera, point).x - 79.5));
            on_board += point.z < 0.9;
        }
        EXPECT_GT(on_board, 100u);
        EXPECT_GE(nearest_px, margin - 0.5);
        EXPECT_LE(nearest_px, margin + 5);
        EXPECT_GT(labelled_only, 10u) << "a label goes with the reading";
    }
}

TEST_F(CollectObservations, WhatHidesASurfaceFromTheColourCameraAloneIsFound) {
    // The colour camera, 10 cm to the right, sees the board cover a stretch of the wall that the depth camera sees.
    const auto board = reference::box({0.1, 0, 0.5}, {0.1, 0.2, 0.01});
    RigFrame frame = frame_of([&](glm::dvec3 p) { return std::min(board(p), wall_(p)); }, pose_);
    frame.color.world_from_camera[3] = glm::dvec4(0.1, 0, 0, 1);
    ObservationRig rig = this->rig();
    rig.fuse(frame);
    rig.collect(frame);
    size_t left_of_it = 0;
    for (const auto& [at, record] : rig.content()) {
        const glm::dvec3 point = point_of(at, unpack(record), 0.02);
        if (record.count() == 0 || point.z < 0.9 || std::abs(point.y) > 0.15) continue;
        // Seen from x = 0.1 the board's left edge (x = 0, z = 0.49) hides the wall right of x = 0.1 - 0.1 / 0.49.
        EXPECT_FALSE(point.x > -0.09 && point.x < 0.25) << point.x;
        left_of_it += point.x < -0.11;
    }
    EXPECT_GT(left_of_it, 100u);
}

TEST_F(CollectObservations, ClippedChannelsAreMarked) {
    RigFrame frame = frame_of(wall_, pose_);
    for (uint32_t y = 0; y < 120; ++y) std::fill_n(&frame.color.linear.at(80, y), 80, glm::vec4(0.5, 1, 0.2, 0.5));
    ObservationRig rig = this->rig();
    rig.fuse(frame);
    rig.collect(frame);
    size_t clipped = 0, whole = 0;
    for (const auto& [at, record] : rig.content()) {
        const reference::ObservedVoxel voxel = unpack(record);
        if (voxel.seen.empty()) continue;
        const double x = project(kCamera, point_of(at, voxel, 0.02)).x;
        if (std::abs(x - 79.0) < 0.01 || std::abs(x - 80.0) < 0.01) continue;
        const bool expected = x > 79;
        EXPECT_EQ(voxel.seen[0].clipped, (std::array<bool, 3>{false, expected, false})) << x;
        ++(expected ? clipped : whole);
    }
    EXPECT_GT(clipped, 500u);
    EXPECT_GT(whole, 500u);
}

TEST_F(CollectObservations, ARestingCameraAveragesAndThenChangesNothing) {
    const RigFrame dark = frame_of(wall_, pose_);
    RigFrame bright = dark;
    for (glm::vec4& pixel : bright.color.linear.pixels()) pixel += glm::vec4(0.1, 0.1, 0.1, 0);
    ObservationRig rig = this->rig();
    rig.fuse(dark);
    EXPECT_GT(rig.collect(dark).changed, 1000u);
    for (int i = 0; i < 19; ++i) rig.collect(i % 2 ? dark : bright);
    const ObservationContent before = rig.content();
    const ObservationRig::Collected last = rig.collect(bright);
    EXPECT_GT(last.visible, 1000u);
    EXPECT_EQ(last.changed, 0u);
    EXPECT_EQ(rig.content(), before);
    for (const auto& [at, record] : before) {
        const reference::ObservedVoxel voxel = unpack(record);
        ASSERT_LE(voxel.seen.size(), 1u);
        if (voxel.seen.empty()) continue;
        EXPECT_EQ(voxel.seen[0].samples, 8);
        const glm::dvec2 pixel = project(kCamera, point_of(at, voxel, 0.02));
        // The mean of four dark and four bright ones; each step rounds to 1/512 of the exponent's range.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(voxel.seen[0].color[c], ramp(pixel.x, pixel.y)[c] + 0.05, 0.008);
    }
}

TEST_F(CollectObservations, LabelsAreVotedOn) {
    RigFrame frame = frame_of(wall_, pose_);
    ObservationRig rig = this->rig();
    rig.fuse(frame);
    const auto label_all = [&](uint32_t label) {
        frame.labels = Image<uint32_t>(kCamera.extent, label);
        const uint32_t changed = rig.collect(frame).changed;
        std::set<std::pair<uint32_t, int>> found;
        for (const auto& [at, record] : rig.content()) {
            const reference::ObservedVoxel voxel = unpack(record);
            if (!voxel.seen.empty()) found.insert({voxel.label, voxel.confidence});
        }
        EXPECT_EQ(found.size(), 1u);
        return std::tuple(found.begin()->first, found.begin()->second, changed > 0);
    };
    for (int i = 0; i < 20; ++i) rig.collect(frame);  // until nothing else changes
    EXPECT_EQ(label_all(0), std::tuple(0u, 0, false));
    EXPECT_EQ(label_all(7), std::tuple(7u, 1, true));
    EXPECT_EQ(label_all(7), std::tuple(7u, 2, false));
    EXPECT_EQ(label_all(0), std::tuple(7u, 2, false));
    EXPECT_EQ(label_all(65535), std::tuple(7u, 1, false));
    EXPECT_EQ(label_all(65535), std::tuple(65535u, 1, true));
}

TEST_F(CollectObservations, TheSameFramesGiveTheSameBytesInOneChunkOrMany) {
    std::vector<RigFrame> frames;
    for (int i = 0; i < 6; ++i) {
        frames.push_back(frame_of(wall_, reference::look_at({0.1 * i, 0.05 * i, 0.1}, {0, 0, 1})));
    }
    std::optional<ObservationContent> first;
    for (const uint64_t chunk_bytes : {uint64_t{1} << 27, uint64_t{1} << 27, uint64_t{1} << 17}) {
        ObservationMapSettings map;
        map.capacity_blocks = 1024;
        map.capacity_records = 3200;
        map.max_chunk_bytes = chunk_bytes;
        ObservationRig rig = this->rig({}, map);
        EXPECT_EQ(rig.map().chunks(), chunk_bytes > 1u << 20 ? 1u : 4u);
        for (const RigFrame& frame : frames) rig.fuse(frame);
        for (const RigFrame& frame : frames) rig.collect(frame);
        const ObservationContent content = rig.content();
        if (!first) first = content;
        EXPECT_GT(content.size(), 1500u);
        EXPECT_EQ(content, *first);
    }
}

TEST_F(CollectObservations, ShadersFindARecordByItsVoxel) {
    for (const float voxel_m : {0.02f, 0.01f}) {
        ObservationMapSettings settings;
        settings.voxel_m = voxel_m;
        settings.capacity_records = 1000;  // some are refused
        ObservationRig rig = this->rig(every_pixel(), settings);
        const RigFrame frame = frame_of(wall_, pose_);
        rig.fuse(frame);
        rig.collect(frame);
        const ObservationContent content = rig.content();
        EXPECT_LT(content.size(), 1001u);
        std::vector<glm::ivec4> voxels;
        const int deep = static_cast<int>(1.003f / voxel_m);
        for (int z = deep - 2; z <= deep + 2; ++z) {
            for (int y = -35; y < 35; ++y) {
                for (int x = -35; x < 35; ++x) voxels.emplace_back(x, y, z, 0);
            }
        }
        const std::vector<gpu::VoxelRecord> found = rig.find(voxels);
        size_t have = 0;
        for (size_t i = 0; i < voxels.size(); ++i) {
            const auto expected = content.find({voxels[i].x, voxels[i].y, voxels[i].z});
            ASSERT_EQ(found[i].block_key != gpu::kEmptyKey, expected != content.end());
            if (expected == content.end()) continue;
            EXPECT_EQ(std::memcmp(&found[i], &expected->second.record, sizeof(gpu::VoxelRecord)), 0);
            ++have;
        }
        EXPECT_GT(have, 300u);
    }
}

TEST_F(CollectObservations, FullPoolsRefuseByKeyAndKeepWhatTheyHave) {
    const RigFrame left = frame_of(wall_, reference::look_at({-0.9, 0, 0.5}, {-0.9, 0, 1}));
    const RigFrame right = frame_of(wall_, pose_);
    for (const bool blocks_run_out : {false, true}) {
        ObservationMapSettings map;
        (blocks_run_out ? map.capacity_blocks : map.capacity_records) = blocks_run_out ? 250 : 1000;
        std::optional<ObservationContent> first;
        for (int attempt = 0; attempt < 3; ++attempt) {
            ObservationRig rig = this->rig(every_pixel(), map);
            rig.fuse(left);
            rig.fuse(right);
            rig.collect(left);
            const ObservationContent before = rig.content();
            ASSERT_GT(before.size(), 100u);
            ASSERT_EQ(rig.record_counters().refused_blocks + rig.block_counters().refused_blocks, 0u);
            rig.collect(right);
            const ObservationContent after = rig.content();
            for (const auto& [at, record] : before) EXPECT_TRUE(after.contains(at));
            const gpu::MapCounters counters = blocks_run_out ? rig.block_counters() : rig.record_counters();
            EXPECT_GT(counters.refused_blocks, 100u);
            EXPECT_LE(counters.free_blocks, 10u);
            EXPECT_EQ(rig.record_counters().high_water, after.size());
            if (!first) first = after;
            EXPECT_EQ(after, *first);
            // Refused once, a key is not counted again.
            rig.collect(right);
            EXPECT_EQ((blocks_run_out ? rig.block_counters() : rig.record_counters()).refused_blocks,
                      counters.refused_blocks);
        }
    }
}

TEST_F(CollectObservations, SettingsOutOfRangeAreErrors) {
    const auto map_with = [&](auto change) {
        ObservationMapSettings settings;
        change(settings);
        return [settings] { ObservationMap(device(), settings); };
    };
    EXPECT_THAT(map_with([](ObservationMapSettings& s) { s.voxel_m = 0.03f; }),
                ThrowsMessage<Error>(HasSubstr("voxels are 0.03 m, they must be 0.02 or 0.01 m")));
    EXPECT_THAT(map_with([](ObservationMapSettings& s) { s.capacity_records = 0; }),
                ThrowsMessage<Error>(HasSubstr("capacity is 0 records, it must be 1 to ")));
    EXPECT_THAT(map_with([](ObservationMapSettings& s) { s.capacity_blocks = UINT32_MAX; }),
                ThrowsMessage<Error>(HasSubstr("capacity is 4294967295 blocks, it must be 1 to ")));
    const ObservationMap map(device(), {});
    ObservationSettings settings;
    settings.stride_px = 0;
    EXPECT_THAT([&] { make_observation_params(map, settings, {}, {}, 0); },
                ThrowsMessage<Error>(HasSubstr("observation.stride_px is 0, it must be 1 to 64")));
}

}  // namespace
}  // namespace patina::collect_observations_test
