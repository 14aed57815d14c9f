#include "reconstruction/stages/segmentation_stage.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "reconstruction/pipeline.h"
#include "reconstruction/session/rgbd_frame.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "tests/gpu/gpu_test.h"

namespace patina::segmentation_stage_test {
namespace {

/// The built-in scene, small, with what each pixel shows.
struct SmallCubes {
    SmallCubes(vulkan::Device& device, uint32_t count) {
        scenes::SyntheticScene scene = scenes::load_scene("cubes");
        scene.camera = scaled_to(scene.camera, {256, 212});
        scenes::SyntheticSource source(device, std::move(scene), {.frames = count});
        info = source.info();
        while (auto reading = source.next()) {
            frames.push_back(std::get<Frame>(std::move(*reading)));
            labels.push_back(source.truth().labels);
        }
    }

    RgbdFrame frame(uint32_t index) const {
        RgbdFrame rgbd = patina::to_rgbd(info, frames[index]);
        rgbd.labels = labels[index].pixels();
        return rgbd;
    }

    SequenceInfo info;
    std::vector<Frame> frames;
    std::vector<Image<uint16_t>> labels;
};

class SegmentationStageTest : public GpuTest {
  protected:
    static ReconstructionSettings settings(bool given) {
        ReconstructionSettings settings;
        settings.map.voxel_m = 0.01f;
        settings.map.capacity_blocks = 16384;
        settings.fusion.truncation_m = 0.03f;
        settings.segmentation.emplace();
        settings.segmentation->given = given;
        return settings;
    }

    /// The labels of what a frame's depth camera sees.
    Image<uint32_t> view(Pipeline& pipeline, uint32_t index) {
        const ViewReadback pending = pipeline.view(cubes_.info.depth, *cubes_.frames[index].world_from_camera);
        pipeline.wait();
        return pending.get().label;
    }

    /// Rendered once for all tests.
    static const SmallCubes& two_cubes() {
        static const SmallCubes cubes(device(), 2);
        return cubes;
    }
    const SmallCubes& cubes_ = two_cubes();
};

TEST_F(SegmentationStageTest, GivenIdsAreTheLabelsOfTheMap) {
    Pipeline pipeline(device(), settings(true));
    for (int i = 0; i < 4; ++i) pipeline.add(cubes_.frame(0));
    const Image<uint32_t> seen = view(pipeline, 0);
    size_t covered = 0, known = 0, right = 0;
    for (size_t i = 0; i < seen.pixels().size(); ++i) {
        if (cubes_.labels[0].pixels()[i] == 0) continue;
        ++covered;
        if (seen.pixels()[i] == 0) continue;
        ++known;
        right += seen.pixels()[i] == cubes_.labels[0].pixels()[i];
    }
    EXPECT_GT(covered, seen.pixels().size() / 4);
    EXPECT_GT(known, covered * 95 / 100);
    EXPECT_GT(right, known * 97 / 100) << "but for the voxels between two objects";
}

TEST_F(SegmentationStageTest, ACameraThatStandsStillSeesTheSameLabelsForGood) {
    Pipeline pipeline(device(), settings(false));
    for (uint32_t i = 0; i < gpu::kUpdateFrames; ++i) pipeline.add(cubes_.frame(0));
    const Image<uint32_t> before = view(pipeline, 0);
    const uint32_t created = pipeline.counters().segments.created;
    EXPECT_GT(created, 3u);
    for (uint32_t i = 0; i < 4 * gpu::kUpdateFrames; ++i) pipeline.add(cubes_.frame(0));
    const Image<uint32_t> after = view(pipeline, 0);
    EXPECT_EQ(pipeline.counters().segments.created, created);
    size_t changed = 0;
    for (size_t i = 0; i < before.pixels().size(); ++i)
        changed += before.pixels()[i] != 0 && before.pixels()[i] != after.pixels()[i];
    EXPECT_LT(changed, before.pixels().size() / 500);
    const LabelStability stability = pipeline.counters().label_stability;
    EXPECT_GT(stability.voxels, 0u);
    EXPECT_LT(stability.flips, stability.voxels / 500 + 1);
    EXPECT_GE(stability.seen, static_cast<double>(stability.voxels)) << "not every block has its turn";
}

TEST_F(SegmentationStageTest, ASecondPassOverTheSamePathMakesNoLabels) {
    const SmallCubes path(device(), 24);
    Pipeline pipeline(device(), settings(false));
    const auto pass = [&] {
        for (uint32_t i = 0; i < 8; ++i) pipeline.add(path.frame(i));
        pipeline.wait();
        return pipeline.counters().segments.created;
    };
    const uint32_t created = pass();
    EXPECT_GT(created, 3u);
    EXPECT_EQ(pass(), created);
}

TEST_F(SegmentationStageTest, TheSameInputGivesTheSameLabels) {
    std::vector<Image<uint32_t>> seen;
    for (int run = 0; run < 2; ++run) {
        Pipeline pipeline(device(), settings(false));
        for (uint32_t i = 0; i < 6; ++i) pipeline.add(cubes_.frame(i % 2));
        seen.push_back(view(pipeline, 1));
    }
    EXPECT_EQ(seen[0].pixels(), seen[1].pixels());
}

TEST_F(SegmentationStageTest, WithoutDepthThereAreNoSegments) {
    Pipeline pipeline(device(), settings(false));
    RgbdFrame frame = cubes_.frame(0);
    const std::vector<uint16_t> nothing(frame.depth.camera.extent.area());
    frame.depth.pixels = std::span<const uint16_t>(nothing);
    for (int i = 0; i < 3; ++i) pipeline.add(frame);
    const std::vector<uint32_t> seen = view(pipeline, 0).pixels();
    EXPECT_EQ(std::set<uint32_t>(seen.begin(), seen.end()), std::set<uint32_t>{0});
    EXPECT_EQ(pipeline.counters().segments.created, 0u);
}

/// A brown wall with a grey disc on it, and the camera before its middle.
class DiscOnAWall {
  public:
    static constexpr double kDistanceM = 1, kRadiusM = 0.25, kBlendM = 0.01;

    RgbdFrame frame() const {
        RgbdFrame frame;
        frame.depth = {std::span<const uint16_t>(depth_mm_), camera_};
        frame.color = {std::span<const glm::vec3>(color_), camera_};
        return frame;
    }

    const Intrinsics& camera() const { return camera_; }

    /// From the disc's rim, metres; negative within it.
    double beside_m(size_t pixel) const {
        const glm::dvec2 at(static_cast<double>(pixel % camera_.extent.width), pixel / camera_.extent.width);
        return glm::length((at - glm::dvec2(camera_.cx, camera_.cy)) / camera_.fx) * kDistanceM - kRadiusM;
    }

  private:
    Intrinsics camera_{{160, 120}, 140, 140, 79.5, 59.5};
    std::vector<uint16_t> depth_mm_ = std::vector<uint16_t>(camera_.extent.area(), 1000);
    std::vector<glm::vec3> color_ = [this] {
        std::vector<glm::vec3> color;
        for (size_t i = 0; i < camera_.extent.area(); ++i) {
            const double share = std::clamp(0.5 + beside_m(i) / kBlendM, 0.0, 1.0);
            color.push_back(
                glm::mix(glm::vec3(0.20f, 0.19f, 0.16f), glm::vec3(0.24f, 0.12f, 0.05f), static_cast<float>(share)));
        }
        return color;
    }();
};

TEST_F(SegmentationStageTest, WhatOnlyItsColorTellsFromItsSurroundingsGetsALabelOfItsOwnAndKeepsIt) {
    const DiscOnAWall wall;
    for (const bool splits : {true, false}) {
        ReconstructionSettings chosen = settings(false);
        chosen.reflectance.emplace();
        chosen.segmentation->frame.edges.cut_chroma = 10;  // no edge of colour parts them in a frame
        if (!splits) chosen.segmentation->split_chroma = 0;
        Pipeline pipeline(device(), chosen);
        for (int i = 0; i < 24; ++i) pipeline.add(wall.frame());
        const ViewReadback pending = pipeline.view(wall.camera(), RigidTransform(1.0));
        pipeline.wait();
        const std::vector<uint32_t> seen = pending.get().label.pixels();
        std::map<uint32_t, int> within, around;
        for (size_t i = 0; i < seen.size(); ++i) {
            if (std::abs(wall.beside_m(i)) > 2 * chosen.map.voxel_m)
                ++(wall.beside_m(i) < 0 ? within : around)[seen[i]];
        }
        const auto most = [](const std::map<uint32_t, int>& labels) {
            return std::ranges::max_element(labels, {}, [](const auto& item) { return item.second; })->first;
        };
        const uint32_t inner = most(within), outer = most(around);
        EXPECT_EQ(inner != outer, splits);
        EXPECT_EQ(pipeline.counters().segments.split, splits ? 1u : 0u);
        if (!splits) continue;
        EXPECT_EQ(within[outer], 0);
        EXPECT_EQ(around[inner], 0);
    }
}

TEST_F(SegmentationStageTest, SegmentationTakesFewDispatches) {
    Pipeline pipeline(device(), settings(false));
    pipeline.add(cubes_.frame(0));
    const graph::CompiledFrame& compiled = pipeline.runner().last_frame();
    size_t dispatches = 0;
    for (const uint32_t pass : compiled.plan.order)
        dispatches += compiled.description.passes[pass].name.starts_with("segmentation.") ? 1 : 0;
    EXPECT_GE(dispatches, 10u);
    EXPECT_LE(dispatches, 20u);
}

}  // namespace
}  // namespace patina::segmentation_stage_test
