#include "passes/reflectance/find_due_records.h"

#include <algorithm>

#include "spirv/shaders.h"

namespace patina {

namespace {

/// Binds what both passes that look for due records have in common; they list what waits for marching in `march`.
void bind(graph::PassBuilder& pass, ReflectanceFrame& reflectance, RecordList& march, RecordList& refine) {
    pass.read("Lights", reflectance.lights).read("Materials", reflectance.materials);
    pass.read("Records", reflectance.records.records).push(reflectance.params);
    reflectance.state.status = pass.modify("Status", reflectance.state.status);
    march.list = pass.modify("March", march.list);
    march.arguments = pass.modify("MarchArguments", march.arguments);
    refine.list = pass.modify("Refine", refine.list);
    refine.arguments = pass.modify("RefineArguments", refine.arguments);
}

void add_due_window(graph::FrameGraph& frame, ReflectanceFrame& reflectance, const RecordList& changed,
                    DueRecords& due) {
    auto pass = frame.compute("reflectance.due_window", spirv::due_window);
    bind(pass, reflectance, due.march, due.refine);
    const ObservationMapIds& ids = reflectance.records;
    pass.read("Keys", ids.keys).read("Blocks", ids.blocks).read("RecordTable", ids.record_table);
    pass.read("ChangedList", changed.list);
    reflectance.state.windows = pass.modify("Windows", reflectance.state.windows);
    const uint32_t buckets = reflectance.map.table_slots() / gpu::kBucketSlots;
    const uint32_t rows = std::min(buckets, gpu::kWindowSteps);
    const uint32_t looked_at = std::min(reflectance.params.max_steps + gpu::kMaxProbes, rows) * (buckets / rows);
    pass.dispatch_covering(looked_at * gpu::kBucketSlots);
}

/// Records that wait for marching.
struct WaitingRecords {
    RecordList never_marched, changed;
};

WaitingRecords add_due_changed(graph::FrameGraph& frame, ReflectanceFrame& reflectance, const RecordList& changed,
                               RecordList& refine) {
    const uint32_t capacity = reflectance.map.capacity_records();
    WaitingRecords waiting{create_record_list(frame, "reflectance.never_marched", capacity),
                           create_record_list(frame, "reflectance.waiting", capacity)};
    auto pass = frame.compute("reflectance.due_changed", spirv::due_changed);
    bind(pass, reflectance, waiting.changed, refine);
    pass.read("ChangedList", changed.list);
    waiting.never_marched.list = pass.modify("NeverMarched", waiting.never_marched.list);
    waiting.never_marched.arguments = pass.modify("NeverMarchedArguments", waiting.never_marched.arguments);
    pass.dispatch_indirect(changed.arguments);
    return waiting;
}

void add_accept_due(graph::FrameGraph& frame, ReflectanceFrame& reflectance, const RecordList& waiting,
                    const gpu::AcceptParams& params, RecordList& march) {
    auto pass = frame.compute("reflectance.accept_due", spirv::accept_due);
    pass.read("Waiting", waiting.list).read("Records", reflectance.records.records).push(params);
    march.list = pass.modify("March", march.list);
    march.arguments = pass.modify("MarchArguments", march.arguments);
    pass.dispatch_indirect(waiting.arguments);
}

}  // namespace

DueRecords add_find_due_records(graph::FrameGraph& frame, ReflectanceFrame& reflectance, const RecordList& changed) {
    const uint32_t capacity = reflectance.map.capacity_records();
    DueRecords due{create_record_list(frame, "reflectance.march", capacity),
                   create_record_list(frame, "reflectance.refine", capacity)};
    add_due_window(frame, reflectance, changed, due);
    const WaitingRecords waiting = add_due_changed(frame, reflectance, changed, due.refine);
    const uint32_t stamp = reflectance.params.stamp;
    add_accept_due(frame, reflectance, waiting.never_marched, {stamp, reflectance.budgets.first_marched_records},
                   due.march);
    add_accept_due(frame, reflectance, waiting.changed, {stamp, reflectance.budgets.marched_records}, due.march);
    return due;
}

}  // namespace patina
