#include "passes/fusion/stream_blocks.h"

#include <numeric>

#include "passes/state/block_keys.h"
#include "reconstruction/streaming/stream_region.h"
#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/gpu/segmentation/label_rig.h"

namespace patina::stream_blocks_test {
namespace {

/// Blocks on the host, by key.
struct HostBlock {
    uint32_t stamp = 0;
    std::vector<uint32_t> tsdf, color, labels;

    bool operator==(const HostBlock&) const = default;
};
using HostBlocks = std::map<uint32_t, HostBlock>;

class StreamBlocksTest : public GpuTest {
  protected:
    /// All blocks of the device.
    HostBlocks blocks_on(LabelRig& rig) {
        graph::FrameGraph frame = runner().begin();
        const auto content = rig.fusion().content();
        const TableContent table = rig.fusion().table();
        const std::vector<uint32_t> words = rig.words(), stamps = rig.stamps();
        HostBlocks blocks;
        for (uint32_t id = 0; id < table.block_keys.size(); ++id) {
            const uint32_t key = table.block_keys[id];
            if (key == gpu::kEmptyKey) continue;
            const BlockContent& voxels = content.at(coordinates_of_key(key));
            const auto first = words.begin() + id * gpu::kBlockVoxels;
            blocks[key] = {stamps[id], voxels.tsdf, voxels.color, {first, first + gpu::kBlockVoxels}};
        }
        return blocks;
    }

    HostBlocks leave(LabelRig& rig, const StreamRegion& region, uint32_t most, uint32_t* outside = nullptr) {
        graph::FrameGraph frame = runner().begin();
        VoxelMapIds ids = rig.map().import(frame);
        LabelMapIds labels = rig.labels().import(frame);
        const LeavingBlocks leaving = add_leave_blocks(frame, rig.map(), ids, &labels, region.gpu(), most);
        VoxelMap::keep(frame, ids);
        const auto count = frame.read_back(leaving.count), list = frame.read_back(leaving.blocks);
        const auto tsdf = frame.read_back(leaving.tsdf), color = frame.read_back(leaving.color);
        const auto words = frame.read_back(leaving.labels), counts = frame.read_back(leaving.counts);
        run(std::move(frame));
        if (outside) *outside = counts.as<uint32_t>()[gpu::kLeavingOutside];
        HostBlocks left;
        const auto part = [](const graph::Readback& read, uint32_t i) {
            const auto all = read.as<uint32_t>();
            const auto first = all.begin() + i * gpu::kBlockVoxels;
            return std::vector<uint32_t>(first, first + gpu::kBlockVoxels);
        };
        const auto streamed = list.as<gpu::StreamedBlock>();
        for (uint32_t i = 0; i < count.as<uint32_t>().front(); ++i)
            left[streamed[i].key] = {streamed[i].label_stamp, part(tsdf, i), part(color, i), part(words, i)};
        return left;
    }

    /// Returns the block ids that they got.
    std::vector<uint32_t> return_to(LabelRig& rig, const HostBlocks& blocks) {
        std::vector<gpu::StreamedBlock> list;
        std::vector<uint32_t> tsdf, color, labels;
        for (const auto& [key, block] : blocks) {
            list.push_back({key, 0, 0, block.stamp, 0, 0});
            tsdf.insert(tsdf.end(), block.tsdf.begin(), block.tsdf.end());
            color.insert(color.end(), block.color.begin(), block.color.end());
            labels.insert(labels.end(), block.labels.begin(), block.labels.end());
        }
        graph::FrameGraph frame = runner().begin();
        VoxelMapIds ids = rig.map().import(frame);
        LabelMapIds label_ids = rig.labels().import(frame);
        const ReturningBlocks returning{static_cast<uint32_t>(list.size()),
                                        frame.upload<gpu::StreamedBlock>("blocks", list),
                                        frame.upload<uint32_t>("tsdf", tsdf), frame.upload<uint32_t>("color", color),
                                        frame.upload<uint32_t>("words", labels)};
        const auto read = frame.read_back(add_return_blocks(frame, rig.map(), ids, &label_ids, returning));
        VoxelMap::keep(frame, ids);
        LabelMap::keep(frame, label_ids);
        run(std::move(frame));
        std::vector<uint32_t> ids_got;
        for (const gpu::StreamedBlock& block : read.as<gpu::StreamedBlock>()) ids_got.push_back(block.block);
        return ids_got;
    }

    /// Table, lists and counters fit each other.
    void expect_sound(LabelRig& rig) {
        const TableContent table = rig.fusion().table();
        const gpu::MapCounters counters = rig.fusion().counters();
        std::vector<uint32_t> ids = table.free_list, expected(LabelRig::kCapacity);
        uint32_t used = 0;
        for (uint32_t id = 0; id < table.block_keys.size(); ++id) {
            if (table.block_keys[id] == gpu::kEmptyKey) continue;
            ids.push_back(id);
            ++used;
            EXPECT_LT(id, counters.high_water);
        }
        std::sort(ids.begin(), ids.end());
        std::iota(expected.begin(), expected.end(), 0u);
        EXPECT_EQ(ids, expected) << "every block is in use or free, once";
        uint32_t entered = 0;
        for (size_t slot = 0; slot < table.keys.size(); ++slot) {
            if (table.keys[slot] == gpu::kEmptyKey) continue;
            ++entered;
            if (table.blocks[slot] == gpu::kNoBlock) continue;
            EXPECT_EQ(table.block_keys[table.blocks[slot]], table.keys[slot]);
        }
        EXPECT_EQ(entered, counters.table_keys);
        EXPECT_EQ(counters.free_blocks, LabelRig::kCapacity - used);
    }

    /// The blocks of a region, and those outside.
    static std::pair<HostBlocks, HostBlocks> split(LabelRig& rig, const HostBlocks& blocks,
                                                   const StreamRegion& region) {
        std::pair<HostBlocks, HostBlocks> parts;
        for (const auto& [key, block] : blocks) {
            const bool inside = region.holds(rig.map().grid(), block_of_key(rig.map().grid(), key));
            (inside ? parts.first : parts.second)[key] = block;
        }
        return parts;
    }

    LabelRig filled() {
        LabelRig rig(device(), runner());
        std::mt19937 random(17);
        rig.set_random(random, 1);
        return rig;
    }
};

TEST_F(StreamBlocksTest, WhatLiesOutsideLeavesAndComesBackAsItWas) {
    for (const StreamRegion& region :
         {StreamRegion::ball({0.1, 0, 0.9}, 0.25), StreamRegion::box({-3, -100, -100}, {2, 100, 100})}) {
        LabelRig rig = filled();
        const HostBlocks before = blocks_on(rig);
        const auto [inside, outside] = split(rig, before, region);
        ASSERT_GT(inside.size(), 20u);
        ASSERT_GT(outside.size(), 50u);
        uint32_t counted = 0;
        EXPECT_EQ(leave(rig, region, 1024, &counted), outside);
        EXPECT_EQ(counted, outside.size());
        EXPECT_EQ(blocks_on(rig), inside);
        EXPECT_EQ(rig.fusion().counters().left_blocks, outside.size());
        expect_sound(rig);
        for (const uint32_t id : return_to(rig, outside)) EXPECT_NE(id, gpu::kNoBlock);
        EXPECT_EQ(blocks_on(rig), before);
        EXPECT_EQ(rig.fusion().counters().refused_blocks, 0u);
        expect_sound(rig);
        EXPECT_TRUE(leave(rig, {}, 1024).empty()) << "no block lies outside of everything";
        EXPECT_EQ(blocks_on(rig), before);
    }
}

TEST_F(StreamBlocksTest, OfTooManyTheSameOnesLeaveInEveryRun) {
    const StreamRegion region = StreamRegion::ball({0.1, 0, 0.9}, 0.1);
    constexpr uint32_t kMost = 40;
    LabelRig rig = filled(), again = filled();
    uint32_t outside = 0, next = 0;
    const HostBlocks left = leave(rig, region, kMost, &outside);
    ASSERT_GT(outside, 3 * kMost);
    EXPECT_LE(left.size(), kMost);
    EXPECT_GE(left.size(), kMost - 8) << "whole bins, of one or two blocks each";
    // The rigs' labels go by block ids, which differ.
    HostBlocks left_again = leave(again, region, kMost);
    ASSERT_EQ(left_again.size(), left.size());
    for (const auto& [key, block] : left) EXPECT_EQ(left_again[key].tsdf, block.tsdf);
    const HostBlocks more = leave(rig, region, kMost, &next);
    EXPECT_EQ(next, outside - left.size());
    EXPECT_GT(more.size(), 0u);
    for (const auto& [key, block] : more) EXPECT_FALSE(left.contains(key));
    expect_sound(rig);
}

TEST_F(StreamBlocksTest, WhatFindsNoPlaceStaysAway) {
    LabelRig rig = filled();
    const HostBlocks before = blocks_on(rig);
    // More than the pool has room for, at places of their own.
    HostBlocks many;
    const uint32_t free = rig.fusion().counters().free_blocks;
    for (uint32_t i = 0; i < free + 40; ++i) {
        HostBlock block = before.begin()->second;
        block.tsdf[0] = i;
        many[(100 + i % 64) | (100 + i / 64) << 11] = block;
    }
    const std::vector<uint32_t> ids = return_to(rig, many);
    EXPECT_EQ(std::count(ids.begin(), ids.end(), gpu::kNoBlock), 40);
    EXPECT_EQ(rig.fusion().counters().refused_blocks, 40u);
    EXPECT_EQ(rig.fusion().counters().free_blocks, 0u);
    expect_sound(rig);
    const HostBlocks after = blocks_on(rig);
    for (const auto& [key, block] : before) EXPECT_EQ(after.at(key), block);
    auto id = ids.begin();
    for (const auto& [key, block] : many) {
        EXPECT_EQ(after.contains(key), *id != gpu::kNoBlock);
        if (*id++ == gpu::kNoBlock) continue;
        EXPECT_EQ(after.at(key), block);
    }
}

TEST_F(StreamBlocksTest, AKeyThatHasABlockGetsTheVoxelsThatComeBack) {
    LabelRig rig = filled();
    HostBlocks changed = blocks_on(rig);
    const size_t count = changed.size();
    for (auto& [key, block] : changed) {
        block.tsdf[5] ^= 77;
        block.stamp += 3;
    }
    return_to(rig, changed);
    EXPECT_EQ(blocks_on(rig), changed);
    EXPECT_EQ(LabelRig::kCapacity - rig.fusion().counters().free_blocks, count);
    expect_sound(rig);
}

}  // namespace
}  // namespace patina::stream_blocks_test
