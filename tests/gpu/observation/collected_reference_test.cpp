#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/shader_camera.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/observation/observed_scene.h"

// The collection of observations against its reference, on a cluttered scene.

namespace patina::collected_reference_test {
namespace {

using namespace observed_scene;

class CollectedReference : public GpuTest {};

/// A ball and a crate before a wall, passed by; `apart`: with the colour camera beside the depth camera; `moves`: while
/// its shutter is open.
std::vector<RigFrame> cluttered_frames(bool apart, bool moves) {
    const auto ball = reference::sphere({-0.2, 0.1, 0.9}, 0.18);
    const auto crate = reference::box({0.3, 0.05, 1.1}, {0.15, 0.2, 0.15});
    const auto room = reference::half_space(glm::normalize(glm::dvec3(0.1, -0.2, -1)), -1.5);
    const auto scene = [&](glm::dvec3 p) { return std::min({ball(p), crate(p), room(p)}); };
    std::vector<RigFrame> frames;
    for (int i = 0; i < 8; ++i) {
        RigFrame frame = frame_of(scene, reference::look_at({-0.4 + 0.1 * i, -0.1, 0.01 * i}, {0, 0, 1}));
        if (apart) {
            frame.color.world_from_camera =
                frame.world_from_camera * glm::translate(RigidTransform(1.0), glm::dvec3(0.05, 0, 0.002));
        }
        frame.labels.emplace(kCamera.extent);
        std::vector<uint32_t>& labels = frame.labels->pixels();
        for (size_t k = 0; k < labels.size(); ++k) labels[k] = (k / 13 + size_t(i)) % 3;
        if (moves && i > 0) {
            const ColorView& before = frames.back().color;
            frame.motion = {make_camera(before.camera, before.world_from_camera).camera_from_world, 0.6f};
        }
        frames.push_back(std::move(frame));
    }
    return frames;
}

bool alike(const reference::ObservedVoxel& got, const reference::ObservedVoxel& expected) {
    const bool same_surface = got.seen.size() == expected.seen.size() &&
                              got.surface_samples == expected.surface_samples && got.label == expected.label &&
                              got.confidence == expected.confidence &&
                              (got.surface_samples == 0 || degrees_between(got.normal, expected.normal) < 0.05) &&
                              std::abs(got.offset_vox - expected.offset_vox) < 0.002;
    return same_surface && std::equal(got.seen.begin(), got.seen.end(), expected.seen.begin(),
                                      [](const reference::SeenColor& a, const reference::SeenColor& b) {
                                          return degrees_between(a.direction, b.direction) < 0.03 &&
                                                 a.samples == b.samples && a.clipped == b.clipped &&
                                                 glm::distance(a.color, b.color) < 0.004;
                                      });
}

/// Collects frame by frame, and expects of each what the reference makes of the state before. Returns how many
/// observations there were, over all frames.
size_t expect_reference(ObservationRig& rig, std::vector<RigFrame> frames) {
    for (const RigFrame& frame : frames) rig.fuse(frame, 2);
    // Readings that come and go within the tolerance from the model.
    for (RigFrame& frame : frames) {
        for (size_t k = 0; k < frame.depth_m.pixels().size(); ++k) {
            const float wave = std::sin(0.3f * static_cast<float>(k % kCamera.extent.width));
            if (frame.depth_m.pixels()[k] > 0) frame.depth_m.pixels()[k] += 0.025f * wave;
        }
    }
    size_t compared = 0, differ = 0, observations = 0;
    for (uint32_t i = 0; i < frames.size(); ++i) {
        const RigFrame& frame = frames[i];
        const ObservationContent before = rig.content();
        const ObservationRig::Collected collected = rig.collect(frame);
        const ObservationContent after = rig.content();

        const reference::ObservationRules rules{0.02,
                                                6,
                                                80,
                                                0.01,
                                                0.003,
                                                1,
                                                2,
                                                2,
                                                {i * 5 % 4 % 2, i * 5 % 4 / 2},
                                                {},
                                                rig.settings().max_blur_px,
                                                rig.settings().smeared_observations};
        reference::ObservedFrame observed{frame.camera,
                                          frame.world_from_camera,
                                          collected.position_m,
                                          collected.normal,
                                          frame.depth_m,
                                          reference::measure_slope(frame.depth_m, frame.camera),
                                          frame.color.camera,
                                          frame.color.world_from_camera,
                                          frame.color.linear,
                                          *frame.labels,
                                          i == 0 ? RigidTransform(1.0) : frames[i - 1].color.world_from_camera,
                                          frame.motion ? double{frame.motion->shutter_share} : 0};
        for (reference::Slope& slope : observed.slope.pixels()) slope = reference::rounded(slope);
        const auto visible = reference::seen_voxels(observed, rules);
        EXPECT_NEAR(collected.visible, visible.size(), 0.003 * visible.size());
        for (const auto& [at, record] : after) {
            const auto found = before.find(at);
            reference::ObservedVoxel expected =
                found == before.end() ? reference::ObservedVoxel{} : unpack(found->second);
            if (visible.contains(at)) reference::observe(expected, {at[0], at[1], at[2]}, observed, rules);
            const reference::ObservedVoxel got = unpack(record);
            ++compared;
            differ += !alike(got, expected);
            observations += got.seen.size();
        }
    }
    // Single precision may decide otherwise where a reading or a pixel is at a limit.
    EXPECT_LE(differ, compared / 200);
    return observations;
}

TEST_F(CollectedReference, IsAgreedWithWhereverTheColourCameraIs) {
    for (const bool apart : {false, true}) {
        ObservationRig rig(device(), runner());
        EXPECT_GT(expect_reference(rig, cluttered_frames(apart, false)), 60000u);
    }
}

TEST_F(CollectedReference, IsAgreedWithWhileTheCameraMoves) {
    const auto observations = [&](uint32_t smeared) {
        ObservationSettings settings;
        settings.smeared_observations = smeared;
        ObservationRig rig(device(), runner(), {}, settings);
        return expect_reference(rig, cluttered_frames(true, true));
    };
    const size_t sharp = observations(0);
    EXPECT_GT(sharp, 20000u);
    EXPECT_LT(sharp, 50000u) << "of 67 000, as a part of the picture is smeared";
    EXPECT_GT(observations(2), sharp);
}

}  // namespace
}  // namespace patina::collected_reference_test
