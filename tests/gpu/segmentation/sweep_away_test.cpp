#include "passes/segmentation/sweep_away.h"

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/segmentation/label_rig.h"

namespace patina::sweep_away_test {
namespace {

using SweepAway = GpuTest;

TEST_F(SweepAway, VoxelsThatAreAwayCountForTheRootsOfTheirLabels) {
    std::mt19937 random(23);
    constexpr uint32_t kLabels = 150;  // more than two groups, and a part of one
    SegmentTable table(device(), kLabels);
    const std::vector<uint32_t> roots = random_roots(kLabels, random);
    std::vector<uint32_t> away(kLabels), expected(kLabels);
    std::vector<gpu::SegmentLabel> labels(kLabels);
    for (uint32_t label = 1; label < kLabels; ++label) {
        away[label] = random() % 3 == 0 ? 0 : random() % 100000;
        labels[label].tally = expected[label] = random() % 1000;
        labels[label].voxels = label;
    }
    for (uint32_t label = 1; label < kLabels; ++label) {
        if (roots[label] != 0) expected[roots[label]] += away[label];
    }
    graph::FrameGraph frame = runner().begin();
    SegmentTableIds ids = table.import(frame);
    ids.parents = frame.upload<uint32_t>("parents", roots);
    ids.labels = frame.upload<gpu::SegmentLabel>("labels", labels);
    add_sweep_away(frame, ids, frame.upload<uint32_t>("away", away));
    const graph::Readback read = frame.read_back(ids.labels);
    run(std::move(frame));
    const auto counted = read.as<gpu::SegmentLabel>();
    for (uint32_t label = 0; label < kLabels; ++label) {
        EXPECT_EQ(counted[label].tally, expected[label]) << label;
        EXPECT_EQ(counted[label].voxels, label) << "all else stays";
    }
}

}  // namespace
}  // namespace patina::sweep_away_test
