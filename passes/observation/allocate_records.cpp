#include "passes/observation/allocate_records.h"

#include "spirv/shaders.h"

namespace patina {

namespace {

/// Inserts the blocks that pixels see. Returns which voxel each of them sees.
graph::BufferId add_touch(graph::FrameGraph& frame, ObservationMapIds& ids, const ObservationInputs& inputs,
                          graph::BufferId params, Extent2D visited) {
    auto touch = frame.compute("observation.touch_surface", spirv::touch_surface);
    touch.read("position_m", inputs.position_m).read("normal", inputs.normal);
    touch.read("depth_m", inputs.depth_m).read("slope", inputs.slope).read("Observation", params);
    ids.keys = touch.modify("Keys", ids.keys);
    ids.new_slots = touch.write("NewSlots", ids.new_slots);
    ids.block_counters = touch.modify("Counters", ids.block_counters);
    const graph::BufferId voxels = touch.create("PixelVoxels", visited.area() * sizeof(uint32_t));
    touch.dispatch_covering(visited);
    return voxels;
}

void add_assign_blocks(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                       graph::BufferId params) {
    auto select = frame.compute("observation.select_blocks", spirv::select_blocks);
    select.read("Keys", ids.keys).read("NewSlots", ids.new_slots).push(map.grid());
    ids.block_counters = select.modify("Counters", ids.block_counters);
    ids.block_arguments = select.write("BlockArguments", ids.block_arguments);
    const graph::BufferId arguments = select.create("AssignArguments", 16);
    select.dispatch(1);

    auto assign = frame.compute("observation.assign_tables", spirv::assign_tables);
    assign.read("Keys", ids.keys).read("NewSlots", ids.new_slots).read("Observation", params);
    assign.read("FreeBlocks", ids.free_blocks);
    ids.block_counters = assign.modify("Counters", ids.block_counters);
    ids.blocks = assign.modify("Blocks", ids.blocks);
    ids.block_keys = assign.modify("BlockKeys", ids.block_keys);
    ids.record_table = assign.modify("RecordTable", ids.record_table);
    assign.dispatch_indirect(arguments);
}

/// Lists the records that pixels see, in `visible`. Returns the list of voxels without a record.
graph::BufferId add_mark(graph::FrameGraph& frame, ObservationMapIds& ids, RecordList& visible, graph::BufferId params,
                         graph::BufferId pixel_voxels, Extent2D visited) {
    auto mark = frame.compute("observation.mark_records", spirv::mark_records);
    mark.read("Observation", params).read("PixelVoxels", pixel_voxels).read("Blocks", ids.blocks);
    ids.record_table = mark.modify("RecordTable", ids.record_table);
    ids.seen = mark.modify("Seen", ids.seen);
    ids.record_counters = mark.modify("Counters", ids.record_counters);
    const graph::BufferId new_voxels = mark.create("NewVoxels", visited.area() * sizeof(uint32_t));
    visible.list = mark.modify("Visible", visible.list);
    visible.arguments = mark.modify("VisibleArguments", visible.arguments);
    mark.dispatch_covering(visited);
    return new_voxels;
}

void add_assign_records(graph::FrameGraph& frame, ObservationMapIds& ids, RecordList& visible, graph::BufferId params,
                        graph::BufferId new_voxels) {
    auto select = frame.compute("observation.select_records", spirv::select_records);
    select.read("BlockKeys", ids.block_keys).read("NewVoxels", new_voxels).read("Observation", params);
    ids.record_counters = select.modify("Counters", ids.record_counters);
    const graph::BufferId arguments = select.create("AssignArguments", 16);
    select.dispatch(1);

    auto assign = frame.compute("observation.assign_records", spirv::assign_records);
    assign.read("Observation", params).read("BlockKeys", ids.block_keys).read("NewVoxels", new_voxels);
    assign.read("FreeRecords", ids.free_records);
    ids.record_counters = assign.modify("Counters", ids.record_counters);
    ids.record_table = assign.modify("RecordTable", ids.record_table);
    ids.records = assign.modify("Records", ids.records);
    ids.seen = assign.modify("Seen", ids.seen);
    ids.changed = assign.modify("Changed", ids.changed);
    ids.albedo = assign.modify("Albedo", ids.albedo);
    ids.visibility = assign.modify("Visibility", ids.visibility);
    visible.list = assign.modify("Visible", visible.list);
    visible.arguments = assign.modify("VisibleArguments", visible.arguments);
    assign.dispatch_indirect(arguments);
}

}  // namespace

RecordList add_allocate_records(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                                const ObservationInputs& inputs, graph::BufferId params,
                                const gpu::ObservationParams& values) {
    const Extent2D visited{values.visited.x, values.visited.y};
    RecordList visible = create_record_list(frame, "observation.visible", visited.area());
    const graph::BufferId pixel_voxels = add_touch(frame, ids, inputs, params, visited);
    add_assign_blocks(frame, map, ids, params);
    const graph::BufferId new_voxels = add_mark(frame, ids, visible, params, pixel_voxels, visited);
    add_assign_records(frame, ids, visible, params, new_voxels);
    return visible;
}

}  // namespace patina
