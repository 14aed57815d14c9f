#include "passes/segmentation/list_due_blocks.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "passes/state/label_map.h"
#include "shared/segmentation/segments.h"
#include "tests/gpu/gpu_test.h"

namespace patina::list_due_blocks_test {
namespace {

class ListDueBlocks : public GpuTest {
  protected:
    static constexpr uint32_t kBlocks = 8192;

    struct Listed {
        std::vector<uint32_t> blocks;
        glm::uvec3 groups;
        std::vector<uint32_t> stamps;
    };

    Listed list(const std::vector<uint32_t>& visible, const std::vector<uint32_t>& stamps, uint32_t stamp) {
        std::vector<uint32_t> counted{static_cast<uint32_t>(visible.size())};
        counted.insert(counted.end(), visible.begin(), visible.end());
        const std::vector<uint32_t> groups{kBlocks / 64, 1, 1, 0};
        graph::FrameGraph frame = runner().begin();
        VoxelMapIds voxels = map_.import(frame);
        voxels.block_keys = frame.upload<uint32_t>("keys", keys());
        voxels.block_arguments = frame.upload<uint32_t>("arguments", groups);
        LabelMapIds labels = labels_.import(frame);
        labels.stamps = frame.upload_bytes(labels.stamps, 0, std::as_bytes(std::span(stamps)), true);
        const DueBlocks due =
            add_list_due_blocks(frame, map_, voxels, labels, frame.upload<uint32_t>("visible", counted), stamp);
        const graph::Readback read = frame.read_back(due.list), arguments = frame.read_back(due.arguments),
                              stamped = frame.read_back(labels.stamps);
        run(std::move(frame));
        auto blocks = read.as<uint32_t>();
        const uint32_t count = blocks.front();
        blocks.erase(blocks.begin());
        blocks.resize(count);
        const auto sides = arguments.as<uint32_t>();
        return {blocks, {sides[0], sides[1], sides[2]}, stamped.as<uint32_t>()};
    }

    /// Half of all blocks, in any order.
    static std::vector<uint32_t> visible_blocks() {
        std::vector<uint32_t> visible(kBlocks);
        std::iota(visible.begin(), visible.end(), 0u);
        std::shuffle(visible.begin(), visible.end(), std::mt19937(4));
        visible.resize(kBlocks / 2);
        return visible;
    }

  private:
    static const std::vector<uint32_t>& keys() {
        static const std::vector<uint32_t> kKeys = [] {
            std::vector<uint32_t> made;
            for (uint32_t block = 0; block < kBlocks; ++block) made.push_back(block % 13 | (block / 13) << 11);
            return made;
        }();
        return kKeys;
    }

    VoxelMap map_{device(), {.capacity_blocks = kBlocks}};
    LabelMap labels_{device(), map_};
};

TEST_F(ListDueBlocks, EachVisibleBlockHasOneTurn) {
    const std::vector<uint32_t> visible = visible_blocks();
    std::vector<uint32_t> stamps(kBlocks, 3);
    std::set<uint32_t> had_turn;
    for (uint32_t stamp = 20; stamp < 20 + gpu::kUpdateFrames; ++stamp) {
        const Listed got = list(visible, stamps, stamp);
        for (const uint32_t block : got.blocks) {
            EXPECT_TRUE(had_turn.insert(block).second) << block << " had two turns";
            stamps[block] = stamp;
        }
        EXPECT_EQ(got.stamps, stamps);
        EXPECT_NEAR(static_cast<double>(got.blocks.size()), visible.size() / double{gpu::kUpdateFrames}, 50);
    }
    EXPECT_EQ(had_turn, std::set<uint32_t>(visible.begin(), visible.end()));
    const Listed again = list(visible, stamps, 20 + gpu::kUpdateFrames);
    for (const uint32_t block : again.blocks) EXPECT_EQ(stamps[block], 20u) << "turns are of the key";
}

TEST_F(ListDueBlocks, BlocksThatNeverWereListedAreDueAtOnce) {
    const std::vector<uint32_t> visible = visible_blocks();
    std::vector<uint32_t> stamps(kBlocks, 3);
    for (size_t i = 0; i < 2800; ++i) stamps[visible[i]] = 0;
    const Listed got = list(visible, stamps, 20);
    const std::set<uint32_t> listed(got.blocks.begin(), got.blocks.end());
    EXPECT_EQ(listed.size(), got.blocks.size());
    for (size_t i = 0; i < 2800; ++i) EXPECT_TRUE(listed.contains(visible[i]));
    EXPECT_GT(listed.size(), 2800u) << "and those that have their turn";
    EXPECT_EQ(got.groups, glm::uvec3(gpu::kGroupsPerRow, 2, 1)) << "a group for a few blocks, in rows";
}

TEST_F(ListDueBlocks, BlocksThatHaveSettledHaveALongerTurn) {
    const std::vector<uint32_t> visible = visible_blocks();
    std::vector<uint32_t> stamps(kBlocks, 3 | gpu::kSettledBlock);
    std::set<uint32_t> had_turn;
    for (uint32_t stamp = 20; stamp < 20 + gpu::kSettledFrames; ++stamp) {
        for (const uint32_t block : list(visible, stamps, stamp).blocks) {
            EXPECT_GE(block, gpu::kSettledBlock) << "it is listed as such";
            EXPECT_TRUE(had_turn.insert(block & ~gpu::kSettledBlock).second) << block << " had two turns";
        }
    }
    EXPECT_EQ(had_turn, std::set<uint32_t>(visible.begin(), visible.end()));
}

TEST_F(ListDueBlocks, RestlessBlocksHaveAShorterTurn) {
    const std::vector<uint32_t> visible = visible_blocks();
    std::vector<uint32_t> stamps(kBlocks, 3 | gpu::kRestlessBlock);
    std::set<uint32_t> had_turn;
    for (uint32_t stamp = 20; stamp < 20 + gpu::kRestlessFrames; ++stamp) {
        const Listed got = list(visible, stamps, stamp);
        for (const uint32_t block : got.blocks) {
            EXPECT_TRUE(had_turn.insert(block).second) << block << " had two turns";
            EXPECT_EQ(got.stamps[block], stamp) << "whether it still is restless, its update tells";
        }
    }
    EXPECT_EQ(had_turn, std::set<uint32_t>(visible.begin(), visible.end()));
}

TEST_F(ListDueBlocks, NothingInViewIsAnEmptyList) {
    const Listed got = list({}, std::vector<uint32_t>(kBlocks), 20);
    EXPECT_TRUE(got.blocks.empty());
    EXPECT_EQ(got.groups, glm::uvec3(1)) << "one group, which finds the list empty";
}

}  // namespace
}  // namespace patina::list_due_blocks_test
