// Blocks of the map, between which rays cross what is empty in few steps.

#include "passes/reflectance/mark_blocks.h"

#include <cmath>
#include <set>
#include <span>

#include "tests/gpu/reflectance/occupancy_bits.h"
#include "tests/gpu/reflectance/radiant_room.h"

namespace patina::mark_blocks_test {
namespace {

using MarkBlocks = RadiantRoomTest;

TEST_F(MarkBlocks, BlocksAndTheirCubesAreMarked) {
    const auto model = fused(grey, std::array{glm::dvec3(0, 0, 1)});
    model->reflectance.update_all({});
    graph::Readback read;
    model->reflectance.change([&](graph::FrameGraph& frame, ReflectanceStateIds& state) {
        read = frame.read_back(state.surroundings, kBlocksInUseAt, sizeof(gpu::Occupancy));
    });
    OccupancyBits expected;
    for (const reference::BlockCoordinates& block : model->observations.fusion().allocated())
        expected.add({block[0], block[1], block[2]});
    const OccupancyBits marked(read.as<uint32_t>());
    EXPECT_GT(expected.cubes.size(), 3u);
    EXPECT_GT(expected.cells.size(), 50u);
    EXPECT_EQ(marked.cubes, expected.cubes);
    EXPECT_EQ(marked.cells, expected.cells);
}

TEST_F(MarkBlocks, RaysFindTheSameAsWhereEveryBlockIsLookedAt) {
    const std::vector<uint32_t> all(sizeof(gpu::Occupancy) / sizeof(uint32_t), 0xffffffffu);
    ReflectanceSettings settings;
    settings.gathered_rays = 4;
    std::array<std::vector<RefinedRecord>, 2> found;
    for (size_t every = 0; every < 2; ++every) {
        const auto model = fused(grey, std::array{glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)});
        if (every == 1) {
            model->reflectance.change([&](graph::FrameGraph& frame, ReflectanceStateIds& state) {
                state.surroundings =
                    frame.upload_bytes(state.surroundings, kBlocksInUseAt, std::as_bytes(std::span(all)), false);
            });
        }
        model->reflectance.update_all(settings);
        found[every] = model->reflectance.records();
    }
    ASSERT_EQ(found[0].size(), found[1].size());
    double met = 0;
    for (size_t i = 0; i < found[0].size(); ++i) {
        // Where a ray enters a block may differ in the last digit, and with it the voxel whose colour it takes.
        ASSERT_EQ(found[0][i].gathered.met, found[1][i].gathered.met) << i;
        ASSERT_LT(glm::distance(found[0][i].gathered.mean, found[1][i].gathered.mean), kColorStep) << i;
        met += found[0][i].gathered.met;
    }
    EXPECT_GT(met, 1000) << "one wall sees the other";
}

}  // namespace
}  // namespace patina::mark_blocks_test
