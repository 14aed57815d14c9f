#include "passes/segmentation/relabel_records.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/segmentation/label_rig.h"

namespace patina::relabel_records_test {
namespace {

/// Blocks with records as the observation passes leave them, but for their labels, which are random.
struct LabelledRecords {
    static constexpr uint32_t kBlocks = 300, kRecords = 2048, kInNoVoxel = 64;

    LabelledRecords(uint32_t edge_shift, std::mt19937& random)
        : per_block(1u << 3 * edge_shift), keys(kBlocks), table(size_t{kBlocks} * per_block, gpu::kNoRecord) {
        for (uint32_t block = 0; block < kBlocks; ++block) keys[block] = 7919 * block;
        keys[5] = keys[77] = gpu::kEmptyKey;
        for (uint32_t i = 0; i < kRecords; ++i) {
            const auto label = static_cast<uint32_t>(random() % LabelRig::kLabels);
            const auto confidence = static_cast<uint32_t>(label == 0 ? 0 : 1 + random() % 255);
            records.push_back({static_cast<uint32_t>(random()), static_cast<uint32_t>(random()),
                               static_cast<uint32_t>(random()), label_word({label, confidence})});
        }
        std::vector<uint32_t> voxels(table.size());
        std::iota(voxels.begin(), voxels.end(), 0u);
        std::shuffle(voxels.begin(), voxels.end(), random);
        for (uint32_t i = 0; i < kRecords - kInNoVoxel; ++i) table[voxels[i]] = i;
        table[voxels[kRecords]] = gpu::kRefusedRecord;
        table[voxels[kRecords + 1]] = gpu::kNewRecord;
    }

    /// The labels of all records after these blocks had their turn.
    std::vector<uint32_t> labels_after(const std::set<uint32_t>& blocks, const std::vector<uint32_t>& roots) const {
        std::vector<uint32_t> labels;
        for (const gpu::VoxelRecord& record : records) labels.push_back(record.label);
        for (const uint32_t block : blocks) {
            for (uint32_t voxel = 0; voxel < per_block; ++voxel) {
                const uint32_t id = table[block * per_block + voxel];
                if (id < kRecords) labels[id] = label_word(reference::relabelled(label_of(labels[id]), roots));
            }
        }
        return labels;
    }

    uint32_t per_block;
    std::vector<uint32_t> keys, table;
    std::vector<gpu::VoxelRecord> records;
};

class RelabelRecords : public GpuTest {
  protected:
    /// The records after one frame.
    std::vector<gpu::VoxelRecord> relabel(const ObservationMap& map, const LabelledRecords& known,
                                          const std::vector<uint32_t>& roots, uint32_t stamp) {
        graph::FrameGraph frame = runner().begin();
        ObservationMapIds ids = map.import(frame);
        gpu::MapCounters counters{};
        counters.high_water = LabelledRecords::kBlocks;
        const std::vector<uint32_t> groups{(LabelledRecords::kBlocks + 63) / 64, 1, 1, 0};
        gpu::SegmentationParams params{};
        params.stamp = stamp;
        ids.block_counters = frame.upload<gpu::MapCounters>("counters", std::span(&std::as_const(counters), 1));
        ids.block_arguments = frame.upload<uint32_t>("arguments", groups);
        ids.block_keys = frame.upload<uint32_t>("keys", known.keys);
        ids.record_table = frame.upload<uint32_t>("table", known.table);
        ids.records = frame.upload<gpu::VoxelRecord>("records", known.records);
        SegmentTableIds table = table_.import(frame);
        table.parents = frame.upload<uint32_t>("parents", roots);
        add_relabel_records(frame, map, ids, table,
                            frame.upload<gpu::SegmentationParams>("params", std::span(&std::as_const(params), 1)));
        const graph::Readback read = frame.read_back(ids.records);
        run(std::move(frame));
        return read.as<gpu::VoxelRecord>();
    }

    SegmentTable table_{device(), LabelRig::kLabels};
};

TEST_F(RelabelRecords, EachBlockHasOneTurnInWhichItsRecordsGetTheRootsOfTheirLabels) {
    for (const float voxel_m : {0.02f, 0.01f}) {
        const ObservationMap map(device(), {.voxel_m = voxel_m, .capacity_blocks = 512, .capacity_records = 2048});
        std::mt19937 random(3);
        const LabelledRecords known(map.edge_shift(), random);
        const std::vector<uint32_t> roots = random_roots(LabelRig::kLabels, random);
        const std::vector<uint32_t> untouched = known.labels_after({}, roots);
        std::set<uint32_t> had_turn;
        for (uint32_t stamp = 1000; stamp < 1000 + gpu::kSweepFrames; stamp += gpu::kSweepEvery) {
            std::vector<gpu::VoxelRecord> got = relabel(map, known, roots, stamp);
            std::set<uint32_t> turn;  // blocks with a record that changed
            for (uint32_t entry = 0; entry < known.table.size(); ++entry) {
                const uint32_t id = known.table[entry];
                if (id < got.size() && got[id].label != untouched[id]) turn.insert(entry / known.per_block);
            }
            const std::vector<uint32_t> expected = known.labels_after(turn, roots);
            for (uint32_t id = 0; id < got.size(); ++id) {
                EXPECT_EQ(got[id].label, expected[id]) << "record " << id << " in frame " << stamp;
                got[id].label = known.records[id].label;
            }
            EXPECT_EQ(std::memcmp(got.data(), known.records.data(), got.size() * sizeof got[0]), 0);
            for (const uint32_t block : turn) EXPECT_TRUE(had_turn.insert(block).second) << block << " had two turns";
        }
        for (uint32_t block = 0; block < LabelledRecords::kBlocks; ++block) {
            const bool changes = known.keys[block] != gpu::kEmptyKey && known.labels_after({block}, roots) != untouched;
            EXPECT_EQ(had_turn.contains(block), changes) << "block " << block;
        }
        EXPECT_GT(had_turn.size(), 200u);
    }
}

}  // namespace
}  // namespace patina::relabel_records_test
