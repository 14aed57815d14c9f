#include "passes/fusion/stream_blocks.h"

#include <algorithm>

#include "passes/state/rebuild_table.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr uint64_t kWordsBytes = gpu::kBlockVoxels * sizeof(uint32_t);  // of one array's words of a block

void dispatch_blocks(graph::PassBuilder& pass, uint32_t count) {
    pass.dispatch(std::min(count, gpu::kGroupsPerRow), (count + gpu::kGroupsPerRow - 1) / gpu::kGroupsPerRow);
}

gpu::StreamParams params_of(const VoxelMap& map, uint32_t count) { return {map.grid().chunk_shift, count, 0, 0}; }

graph::BufferId add_pack_words(graph::FrameGraph& frame, const char* name, const VoxelMap& map, graph::BufferId words,
                               const LeavingBlocks& leaving, uint32_t most) {
    auto pack = frame.compute(name, spirv::pack_words);
    pack.read("Streamed", leaving.blocks).read("StreamedCount", leaving.count).read("Words", words);
    pack.specialise("kVoxelChunks", map.chunks()).push(params_of(map, most));
    const graph::BufferId packed = pack.create("Packed", most * kWordsBytes);
    dispatch_blocks(pack, most);
    return packed;
}

void add_unpack_words(graph::FrameGraph& frame, const char* name, const VoxelMap& map, graph::BufferId& words,
                      graph::BufferId streamed, graph::BufferId packed, uint32_t count) {
    auto unpack = frame.compute(name, spirv::unpack_words);
    unpack.read("Streamed", streamed).read("Packed", packed);
    unpack.specialise("kVoxelChunks", map.chunks()).push(params_of(map, count));
    words = unpack.modify("Words", words);
    dispatch_blocks(unpack, count);
}

/// Which blocks leave; their places are free after it.
LeavingBlocks add_list_leaving(graph::FrameGraph& frame, VoxelMapIds& ids, const gpu::LeaveParams& params) {
    LeavingBlocks leaving;
    leaving.counts = frame.fill(frame.create_buffer("fusion.leaving", gpu::kLeavingWords * sizeof(uint32_t)), 0);
    auto count = frame.compute("fusion.count_leaving", spirv::count_leaving);
    count.read("BlockKeys", ids.block_keys).read("Counters", ids.counters).push(params);
    leaving.counts = count.modify("Leaving", leaving.counts);
    count.dispatch_indirect(ids.block_arguments);

    auto choose = frame.compute("fusion.choose_leaving", spirv::choose_leaving);
    leaving.counts = choose.push(params).modify("Leaving", leaving.counts);
    choose.dispatch(1);

    leaving.count = frame.fill(frame.create_buffer("fusion.leaving_count", sizeof(glm::uvec4)), 0);
    leaving.blocks =
        frame.fill(frame.create_buffer("fusion.leaving_blocks", params.most * sizeof(gpu::StreamedBlock)), 0);
    auto list = frame.compute("fusion.list_leaving", spirv::list_leaving);
    list.read("Leaving", leaving.counts).push(params);
    ids.block_keys = list.modify("BlockKeys", ids.block_keys);
    ids.free_list = list.modify("FreeList", ids.free_list);
    ids.counters = list.modify("Counters", ids.counters);
    leaving.blocks = list.modify("Streamed", leaving.blocks);
    leaving.count = list.modify("StreamedCount", leaving.count);
    list.dispatch_indirect(ids.block_arguments);
    return leaving;
}

void add_pack_labels(graph::FrameGraph& frame, const VoxelMap& map, const LabelMapIds& labels, LeavingBlocks& leaving,
                     uint32_t most) {
    leaving.labels = add_pack_words(frame, "segmentation.pack_labels", map, labels.words, leaving, most);
    auto stamps = frame.compute("segmentation.pack_stamps", spirv::pack_stamps);
    stamps.read("Stamps", labels.stamps).read("StreamedCount", leaving.count);
    leaving.blocks = stamps.modify("Streamed", leaving.blocks);
    stamps.dispatch_covering(most);
}

void add_unpack_labels(graph::FrameGraph& frame, const VoxelMap& map, LabelMapIds& labels, graph::BufferId streamed,
                       const ReturningBlocks& returning) {
    add_unpack_words(frame, "segmentation.unpack_labels", map, labels.words, streamed, returning.labels,
                     returning.count);
    auto stamps = frame.compute("segmentation.unpack_stamps", spirv::unpack_stamps);
    stamps.read("Streamed", streamed).push(params_of(map, returning.count));
    labels.stamps = stamps.modify("Stamps", labels.stamps);
    stamps.dispatch_covering(returning.count);
}

}  // namespace

LeavingBlocks add_leave_blocks(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids, LabelMapIds* labels,
                               const gpu::StreamRegion& region, uint32_t most) {
    LeavingBlocks leaving = add_list_leaving(frame, ids, {map.grid(), region, most, 0, 0, 0});
    leaving.tsdf = add_pack_words(frame, "fusion.pack_tsdf", map, ids.tsdf, leaving, most);
    leaving.color = add_pack_words(frame, "fusion.pack_color", map, ids.color, leaving, most);
    if (labels) add_pack_labels(frame, map, *labels, leaving, most);
    add_refill_table(frame, {ids.keys, ids.blocks, ids.block_keys, ids.counters, ids.block_arguments}, map.grid());
    return leaving;
}

graph::BufferId add_return_blocks(graph::FrameGraph& frame, const VoxelMap& map, VoxelMapIds& ids, LabelMapIds* labels,
                                  const ReturningBlocks& returning) {
    auto enter = frame.compute("fusion.return_blocks", spirv::return_blocks);
    enter.read("FreeList", ids.free_list).push(gpu::ReturnParams{map.grid(), returning.count, 0, 0, 0});
    ids.keys = enter.modify("Keys", ids.keys);
    ids.blocks = enter.modify("Blocks", ids.blocks);
    ids.block_keys = enter.modify("BlockKeys", ids.block_keys);
    ids.counters = enter.modify("Counters", ids.counters);
    const graph::BufferId streamed = enter.modify("Streamed", returning.blocks);
    enter.dispatch_covering(returning.count);

    auto settle = frame.compute("fusion.settle_returned", spirv::settle_returned);
    ids.block_arguments = settle.read("Counters", ids.counters).write("BlockArguments", ids.block_arguments);
    settle.dispatch(1);

    add_unpack_words(frame, "fusion.unpack_tsdf", map, ids.tsdf, streamed, returning.tsdf, returning.count);
    add_unpack_words(frame, "fusion.unpack_color", map, ids.color, streamed, returning.color, returning.count);
    if (labels) add_unpack_labels(frame, map, *labels, streamed, returning);
    return streamed;
}

}  // namespace patina
