#include "passes/reflectance/find_due_records.h"

#include "spirv/shaders.h"

namespace patina {

namespace {

/// Binds what both passes that look for due records have in common.
void bind(graph::PassBuilder& pass, ReflectanceFrame& reflectance, DueRecords& due) {
    pass.read("Lights", reflectance.lights).read("Materials", reflectance.materials);
    pass.read("Records", reflectance.records.records).push(reflectance.params);
    reflectance.state.status = pass.modify("Status", reflectance.state.status);
    due.march.list = pass.modify("March", due.march.list);
    due.march.arguments = pass.modify("MarchArguments", due.march.arguments);
    due.refine.list = pass.modify("Refine", due.refine.list);
    due.refine.arguments = pass.modify("RefineArguments", due.refine.arguments);
}

void add_due_changed(graph::Frame& frame, ReflectanceFrame& reflectance, const RecordList& changed, DueRecords& due) {
    auto pass = frame.compute("reflectance.due_changed", spirv::due_changed);
    bind(pass, reflectance, due);
    pass.read("ChangedList", changed.list);
    pass.dispatch_indirect(changed.arguments);
}

void add_due_window(graph::Frame& frame, ReflectanceFrame& reflectance, DueRecords& due) {
    auto pass = frame.compute("reflectance.due_window", spirv::due_window);
    bind(pass, reflectance, due);
    const ObservationMapIds& ids = reflectance.records;
    pass.read("Keys", ids.keys).read("Blocks", ids.blocks).read("RecordTable", ids.record_table);
    pass.read("RecordCounters", ids.record_counters);
    reflectance.state.cursors = pass.modify("Cursors", reflectance.state.cursors);
    const uint32_t buckets =
        std::min(reflectance.params.max_window + gpu::kMaxProbes, reflectance.map.table_slots() / gpu::kBucketSlots);
    pass.dispatch_covering(buckets * gpu::kBucketSlots);
}

RecordList add_accept_due(graph::Frame& frame, ReflectanceFrame& reflectance, const RecordList& march) {
    RecordList accepted =
        create_record_list(frame, "reflectance.accepted", reflectance.map.settings().capacity_records);
    auto pass = frame.compute("reflectance.accept_due", spirv::accept_due);
    pass.read("March", march.list).read("Records", reflectance.records.records).push(reflectance.params);
    reflectance.state.cursors = pass.modify("Cursors", reflectance.state.cursors);
    accepted.list = pass.modify("Accepted", accepted.list);
    accepted.arguments = pass.modify("AcceptedArguments", accepted.arguments);
    pass.dispatch_indirect(march.arguments);
    return accepted;
}

}  // namespace

DueRecords add_find_due_records(graph::Frame& frame, ReflectanceFrame& reflectance, const RecordList& changed) {
    const uint32_t capacity = reflectance.map.settings().capacity_records;
    DueRecords due{create_record_list(frame, "reflectance.march", capacity),
                   create_record_list(frame, "reflectance.refine", capacity)};
    add_due_changed(frame, reflectance, changed, due);
    add_due_window(frame, reflectance, due);
    due.march = add_accept_due(frame, reflectance, due.march);
    return due;
}

}  // namespace patina
