#include "passes/segmentation/split_labels.h"

#include "shared/segmentation/split_labels.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

/// Dispatches over all of them; over none while no label has a partner.
struct PartArguments {
    graph::BufferId voxels, records;
};

PartArguments add_start_splits(graph::FrameGraph& frame, const VoxelMapIds& voxels, const ObservationMap& observations,
                               const ObservationMapIds& records, SegmentTableIds& table, SegmentSampleIds& samples,
                               uint32_t labels, const SplitChoice& choice) {
    auto find = frame.compute("segmentation.find_splits", spirv::find_splits);
    find.read("Records", records.records).read("Counts", samples.counts).read("Kept", samples.kept);
    find.read("Labels", table.labels).read("Partners", table.partners).read("Colors", records.colors);
    find.read("Albedo", records.albedo);
    find.specialise("kVoxelChunks", observations.chunks());
    const uint64_t bytes = labels * sizeof(gpu::SplitProposal);
    const graph::BufferId proposals =
        find.modify("Proposals", frame.fill(frame.create_buffer("segmentation.split_proposals", bytes), 0));
    find.push(gpu::FindSplitsParams{observations.grid(), observations.edge_shift(), labels, choice.least_apart,
                                    choice.stamp});
    find.dispatch(gpu::kGroupsPerRow, (labels + gpu::kGroupsPerRow - 1) / gpu::kGroupsPerRow);

    auto start = frame.compute("segmentation.start_splits", spirv::start_splits);
    start.read("Proposals", proposals).read("FreeLabels", table.free_labels);
    start.read("VoxelCounters", voxels.counters).read("RecordCounters", records.record_counters);
    table.parents = start.modify("Parents", table.parents);
    table.labels = start.modify("Labels", table.labels);
    table.partners = start.modify("Partners", table.partners);
    table.rules = start.modify("Rules", table.rules);
    table.counters = start.modify("Counters", table.counters);
    samples.kd = start.modify("SegmentKds", samples.kd);
    const PartArguments arguments{start.create("VoxelArguments", 4 * sizeof(uint32_t)),
                                  start.create("RecordArguments", 4 * sizeof(uint32_t))};
    start.push(gpu::StartSplitsParams{choice.stamp, labels, 0, 0});
    start.dispatch(1);
    return arguments;
}

}  // namespace

void add_split_labels(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& voxels, LabelMapIds& labels,
                      const ObservationMap& observations, ObservationMapIds& records, SegmentTableIds& table,
                      SegmentSampleIds& samples, uint32_t capacity_labels, const SplitChoice& choice) {
    const PartArguments arguments =
        add_start_splits(frame, voxels, observations, records, table, samples, capacity_labels, choice);

    auto part_voxels = frame.compute("segmentation.part_voxels", spirv::part_voxels);
    part_voxels.read("BlockKeys", voxels.block_keys).read("Counters", voxels.counters).read("Color", voxels.color);
    part_voxels.read("Partners", table.partners).read("Rules", table.rules);
    labels.words = part_voxels.modify("Words", labels.words);
    part_voxels.push(map.grid());
    part_voxels.specialise("kVoxelChunks", map.chunks());
    part_voxels.dispatch_indirect(arguments.voxels);

    auto part_records = frame.compute("segmentation.part_records", spirv::part_records);
    part_records.read("RecordCounters", records.record_counters).read("Words", labels.words);
    part_records.read("Keys", voxels.keys).read("Blocks", voxels.blocks);
    part_records.read("Parents", table.parents).read("Partners", table.partners);
    records.records = part_records.modify("Records", records.records);
    part_records.push(gpu::PartRecordsParams{map.grid(), observations.grid(), observations.edge_shift(), 0, 0, 0});
    part_records.specialise("kVoxelChunks", map.chunks());
    part_records.dispatch_indirect(arguments.records);
}

}  // namespace patina
