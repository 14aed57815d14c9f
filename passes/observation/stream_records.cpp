#include "passes/observation/stream_records.h"

#include "passes/state/rebuild_table.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr uint64_t kQuadBytes = gpu::kRecordQuads * sizeof(glm::uvec4);  // of a record's directions, and of its colours

graph::BufferId add_pack_quads(graph::FrameGraph& frame, const char* name, const ObservationMap& map,
                               graph::BufferId words, const LeavingRecords& leaving, graph::BufferId list,
                               uint32_t most) {
    auto pack = frame.compute(name, spirv::pack_quads);
    pack.read("StreamedRecords", list).read("Count", leaving.count).read("Words", words);
    pack.specialise("kVoxelChunks", map.chunks()).push(gpu::CopyRecordsParams{map.grid().chunk_shift, most, 0, 0});
    const graph::BufferId packed = pack.create("Packed", most * kQuadBytes);
    pack.dispatch_covering(most);
    return packed;
}

void add_unpack_quads(graph::FrameGraph& frame, const char* name, const ObservationMap& map, graph::BufferId& words,
                      graph::BufferId entered, graph::BufferId packed, uint32_t count) {
    auto unpack = frame.compute(name, spirv::unpack_quads);
    unpack.read("Entered", entered).read("Packed", packed);
    unpack.specialise("kVoxelChunks", map.chunks()).push(gpu::CopyRecordsParams{map.grid().chunk_shift, count, 0, 0});
    words = unpack.modify("Words", words);
    unpack.dispatch_covering(count);
}

/// Lists what leaves; its places are free after it. Returns the list of record ids.
graph::BufferId add_list_leaving(graph::FrameGraph& frame, ObservationMapIds& ids,
                                 const gpu::LeaveRecordsParams& params, uint32_t most, LeavingRecords& leaving) {
    leaving.counts = frame.fill(frame.create_buffer("observation.leaving", gpu::kLeavingWords * sizeof(uint32_t)), 0);
    auto count = frame.compute("observation.count_leaving", spirv::count_leaving_records);
    count.read("BlockKeys", ids.block_keys).read("Counters", ids.block_counters);
    count.read("RecordTable", ids.record_table).push(params);
    leaving.counts = count.modify("Leaving", leaving.counts);
    count.dispatch_indirect(ids.block_arguments);

    auto choose = frame.compute("observation.choose_leaving", spirv::choose_leaving);
    leaving.counts = choose.push(gpu::LeaveParams{{}, {}, most, 0, 0, 0}).modify("Leaving", leaving.counts);
    choose.dispatch(1);

    leaving.count = frame.fill(frame.create_buffer("observation.leaving_count", sizeof(gpu::LeavingCount)), 0);
    auto list = frame.compute("observation.list_leaving", spirv::list_leaving_records);
    list.read("Leaving", leaving.counts).read("RecordTable", ids.record_table).push(params);
    ids.block_keys = list.modify("BlockKeys", ids.block_keys);
    ids.free_blocks = list.modify("FreeBlocks", ids.free_blocks);
    ids.free_records = list.modify("FreeRecords", ids.free_records);
    ids.block_counters = list.modify("BlockCounters", ids.block_counters);
    ids.record_counters = list.modify("RecordCounters", ids.record_counters);
    leaving.count = list.modify("Count", leaving.count);
    leaving.blocks = list.create("Streamed", most * sizeof(gpu::StreamedBlock));
    const graph::BufferId records = list.create("StreamedRecords", most * sizeof(uint32_t));
    list.dispatch_indirect(ids.block_arguments);
    return records;
}

}  // namespace

LeavingRecords add_leave_records(graph::FrameGraph& frame, StreamedMap streamed, const gpu::VoxelGrid& voxels,
                                 const gpu::StreamRegion& region, uint32_t most) {
    const ObservationMap& map = streamed.map;
    ObservationMapIds& ids = streamed.ids;
    LeavingRecords leaving;
    const graph::BufferId list =
        add_list_leaving(frame, ids, {voxels, region, map.edge_shift(), 0, 0, 0}, most, leaving);
    leaving.directions = add_pack_quads(frame, "observation.pack_directions", map, ids.directions, leaving, list, most);
    leaving.colors = add_pack_quads(frame, "observation.pack_colors", map, ids.colors, leaving, list, most);

    auto pack = frame.compute("observation.pack_leaving", spirv::pack_leaving_records);
    pack.read("StreamedRecords", list).read("Count", leaving.count).read("Seen", ids.seen).read("Changed", ids.changed);
    pack.read("Albedo", ids.albedo).read("Visibility", ids.visibility);
    pack.push(gpu::CopyRecordsParams{map.grid().chunk_shift, most, 0, 0});
    ids.records = pack.modify("Records", ids.records);
    streamed.state.status = pack.modify("Status", streamed.state.status);
    streamed.state.gathered = pack.modify("Gathered", streamed.state.gathered);
    streamed.away = pack.modify("Away", streamed.away);
    leaving.records = pack.create("Packed", most * sizeof(gpu::StreamedRecord));
    pack.dispatch_covering(most);

    add_refill_table(frame, {ids.keys, ids.blocks, ids.block_keys, ids.block_counters, ids.block_arguments},
                     map.grid());
    return leaving;
}

graph::BufferId add_return_records(graph::FrameGraph& frame, StreamedMap streamed, const ReturningRecords& returning) {
    const ObservationMap& map = streamed.map;
    ObservationMapIds& ids = streamed.ids;
    const gpu::ReturnRecordsParams params{map.grid(), map.edge_shift(), map.capacity_records(), returning.block_count,
                                          returning.record_count};
    auto place = frame.compute("observation.return_blocks", spirv::return_record_blocks);
    place.read("FreeList", ids.free_blocks).push(params);
    ids.keys = place.modify("Keys", ids.keys);
    ids.blocks = place.modify("Blocks", ids.blocks);
    ids.block_keys = place.modify("BlockKeys", ids.block_keys);
    ids.block_counters = place.modify("Counters", ids.block_counters);
    ids.record_counters = place.modify("RecordCounters", ids.record_counters);
    ids.record_table = place.modify("RecordTable", ids.record_table);
    const graph::BufferId none =
        frame.fill(frame.create_buffer("observation.returned_count", sizeof(gpu::ReturnedCount)), 0);
    const graph::BufferId returned = place.modify("Returned", none);
    const graph::BufferId blocks = place.modify("Streamed", returning.blocks);
    place.dispatch_covering(returning.block_count);

    auto enter = frame.compute("observation.enter_records", spirv::enter_records);
    enter.read("Streamed", blocks).read("Packed", returning.records).read("FreeRecords", ids.free_records);
    enter.read("RecordCounters", ids.record_counters).push(params);
    ids.record_table = enter.modify("RecordTable", ids.record_table);
    ids.records = enter.modify("Records", ids.records);
    ids.seen = enter.modify("Seen", ids.seen);
    ids.changed = enter.modify("Changed", ids.changed);
    ids.albedo = enter.modify("Albedo", ids.albedo);
    ids.visibility = enter.modify("Visibility", ids.visibility);
    streamed.state.status = enter.modify("Status", streamed.state.status);
    streamed.state.gathered = enter.modify("Gathered", streamed.state.gathered);
    streamed.away = enter.modify("Away", streamed.away);
    const graph::BufferId entered = enter.create("Entered", returning.record_count * sizeof(uint32_t));
    enter.dispatch_covering(returning.record_count);

    auto settle = frame.compute("observation.settle_returned", spirv::settle_returned_records);
    settle.read("Streamed", blocks).read("Returned", returned).read("BlockCounters", ids.block_counters).push(params);
    ids.record_counters = settle.modify("RecordCounters", ids.record_counters);
    ids.free_records = settle.modify("FreeRecords", ids.free_records);
    ids.block_arguments = settle.write("BlockArguments", ids.block_arguments);
    settle.dispatch(1);

    add_unpack_quads(frame, "observation.unpack_directions", map, ids.directions, entered, returning.directions,
                     returning.record_count);
    add_unpack_quads(frame, "observation.unpack_colors", map, ids.colors, entered, returning.colors,
                     returning.record_count);
    return blocks;
}

}  // namespace patina
