#include "passes/segmentation/sweep_labels.h"

#include <set>

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/segmentation/label_rig.h"

namespace patina::sweep_labels_test {
namespace {

class SweepLabels : public GpuTest {
  protected:
    /// One frame's sweep.
    void sweep(LabelRig& rig, const std::vector<uint32_t>& roots, uint32_t stamp) {
        graph::FrameGraph frame = runner().begin();
        gpu::SegmentationParams params{};
        params.stamp = stamp;
        LabelMapIds labels = rig.labels().import(frame);
        SegmentTableIds table = table_.import(frame);
        table.parents = frame.upload<uint32_t>("parents", roots);
        add_sweep_labels(frame, rig.map(), rig.map().import(frame), labels, table,
                         frame.upload<gpu::SegmentationParams>("params", std::span(&params, 1)));
        LabelMap::keep(frame, labels);
        frame.keep(table.labels);
        run(std::move(frame));
    }

    void reset_table() {
        graph::FrameGraph frame = runner().begin();
        table_.reset(frame);
        run(std::move(frame));
    }

    std::vector<gpu::SegmentLabel> known() {
        graph::FrameGraph frame = runner().begin();
        const graph::Readback read = frame.read_back(table_.import(frame).labels);
        run(std::move(frame));
        return read.as<gpu::SegmentLabel>();
    }

    SegmentTable table_{device(), LabelRig::kLabels};
};

TEST_F(SweepLabels, EachBlockHasOneTurnInWhichLabelsAreReplacedByRootsAndCounted) {
    std::mt19937 random(11);
    LabelRig rig(device(), runner());
    rig.set_random(random, 1);
    reset_table();
    const std::vector<uint32_t> roots = random_roots(LabelRig::kLabels, random), keys = rig.fusion().table().block_keys;
    std::vector<uint32_t> expected = rig.words();
    std::vector<uint32_t> tally(LabelRig::kLabels);
    std::set<uint32_t> waiting;
    for (uint32_t block = 0; block < keys.size(); ++block) {
        if (keys[block] != gpu::kEmptyKey) waiting.insert(block);
    }
    const size_t blocks = waiting.size();
    ASSERT_GT(blocks, 100u);
    ASSERT_LT(blocks, LabelRig::kCapacity) << "some of the pool is free";
    size_t most_at_once = 0;
    for (uint32_t stamp = 90; stamp < 90 + gpu::kSweepFrames; stamp += gpu::kSweepEvery) {
        sweep(rig, roots, stamp);
        const std::vector<uint32_t> words = rig.words();
        size_t swept = 0;
        for (auto block = waiting.begin(); block != waiting.end();) {
            const size_t first = size_t{*block} * gpu::kBlockVoxels;
            if (std::equal(&words[first], &words[first] + gpu::kBlockVoxels, &expected[first])) {
                ++block;
                continue;
            }
            for (size_t i = first; i < first + gpu::kBlockVoxels; ++i) {
                const reference::VoxelLabel label = reference::relabelled(label_of(expected[i]), roots);
                expected[i] = label_word(label);
                if (label.label != 0) ++tally[label.label];
            }
            block = waiting.erase(block);
            ++swept;
        }
        ASSERT_EQ(words, expected) << "after frame " << stamp;
        most_at_once = std::max(most_at_once, swept);
    }
    EXPECT_TRUE(waiting.empty()) << waiting.size() << " blocks had no turn";
    EXPECT_LT(most_at_once, 5 * blocks / (2 * gpu::kSweepParts)) << "turns are spread evenly";
    const std::vector<gpu::SegmentLabel> labels = known();
    for (uint32_t label = 1; label < LabelRig::kLabels; ++label) EXPECT_EQ(labels[label].tally, tally[label]) << label;
}

}  // namespace
}  // namespace patina::sweep_labels_test
