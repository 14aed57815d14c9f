#include "passes/segmentation/clear_labels.h"

#include "engine/core/shader_camera.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/segmentation/label_rig.h"

namespace patina::clear_labels_test {
namespace {

class ClearLabels : public GpuTest {
  protected:
    /// Allocates what a camera sees, and clears.
    void allocate(LabelRig& rig, const RigidTransform& world_from_camera) {
        graph::FrameGraph frame = runner().begin();
        const gpu::Camera camera = make_camera(LabelRig::camera(), world_from_camera);
        const gpu::FusionParams values = make_fusion_params(rig.map(), rig.fusion().settings(), camera, camera, 0, 0);
        const auto params = frame.upload<gpu::FusionParams>("params", std::span(&values, 1));
        const auto depth = frame.upload("depth", {LabelRig::camera().extent, vulkan::Format::kR32f},
                                        std::as_bytes(std::span(LabelRig::depth_m(world_from_camera).pixels())));
        VoxelMapIds voxels = rig.map().import(frame);
        LabelMapIds labels = rig.labels().import(frame);
        add_allocate_blocks(frame, rig.map(), voxels, depth, params, 1);
        add_clear_labels(frame, rig.map(), voxels, labels);
        VoxelMap::keep(frame, voxels);
        LabelMap::keep(frame, labels);
        run(std::move(frame));
    }

    /// Expects labels and stamps to be cleared in the blocks that the allocation assigned, and there alone. Returns how
    /// many these are.
    uint32_t expect_new_blocks_cleared(LabelRig& rig, const RigidTransform& world_from_camera) {
        std::mt19937 random(5);
        rig.set_random(random);
        const std::vector<uint32_t> words = rig.words(), keys = rig.fusion().table().block_keys;
        allocate(rig, world_from_camera);
        const std::vector<uint32_t> cleared = rig.words(), stamps = rig.stamps(),
                                    keys_after = rig.fusion().table().block_keys;
        uint32_t assigned = 0;
        for (uint32_t block = 0; block < keys.size(); ++block) {
            const bool is_new = keys_after[block] != keys[block];
            assigned += is_new ? 1 : 0;
            EXPECT_EQ(stamps[block], is_new ? 0u : 1u) << block;
            uint32_t wrong = 0;
            for (size_t i = size_t{block} * gpu::kBlockVoxels; i < (block + size_t{1}) * gpu::kBlockVoxels; ++i) {
                wrong += cleared[i] != (is_new ? 0 : words[i]) ? 1 : 0;
            }
            EXPECT_EQ(wrong, 0u) << block << (is_new ? ", new" : ", old");
        }
        return assigned;
    }
};

TEST_F(ClearLabels, TheBlocksThatAFrameAssignsHaveNone) {
    LabelRig rig(device(), runner());
    const RigidTransform aside = reference::look_at({0.3, 0, 0}, {0.3, 0, 1});
    EXPECT_GT(expect_new_blocks_cleared(rig, aside), 20u);
    EXPECT_EQ(expect_new_blocks_cleared(rig, aside), 0u) << "nothing is new the second time";
}

TEST_F(ClearLabels, KeysThatFindThePoolFullClearNothing) {
    LabelRig rig(device(), runner());
    uint32_t assigned = 1;
    for (int i = 1; i < 9 && assigned > 0; ++i) {
        assigned = expect_new_blocks_cleared(rig, reference::look_at({0.9 * i, 0, 0}, {0.9 * i, 0, 1}));
    }
    EXPECT_GT(rig.fusion().counters().refused_blocks, 0u);
}

}  // namespace
}  // namespace patina::clear_labels_test
