#include "passes/segmentation/sample_records.h"

#include "engine/core/error.h"
#include "spirv/shaders.h"

namespace patina {

void add_sample_records(graph::FrameGraph& frame, const ObservationMap& map, const ObservationMapIds& records,
                        const SegmentSamples& samples, SegmentSampleIds& ids, const SampleChoice& choice) {
    const uint32_t labels = samples.labels(), capacity = map.capacity_records();
    const gpu::SegmentSampleParams params{choice.seed, labels, choice.min_observations, 0};
    const gpu::SampledPart part{choice.voxels, choice.region, params};
    const auto zeros = [&](const char* name, uint64_t words) {
        return frame.fill(frame.create_buffer(name, words * sizeof(uint32_t)), 0);
    };
    auto count = frame.compute("segmentation.count_samples", spirv::count_samples);
    count.read("RecordCounters", records.record_counters).read("Records", records.records).push(part);
    const graph::BufferId levels =
        count.modify("Levels", zeros("segmentation.sample_levels", uint64_t{labels} * 2 * gpu::kSampleLevels));
    count.dispatch_covering(capacity);

    auto choose = frame.compute("segmentation.choose_samples", spirv::choose_samples);
    choose.read("Levels", levels).push(params);
    ids.counts = choose.write("Counts", ids.counts);
    ids.kd = choose.write("SegmentKds", ids.kd);
    choose.dispatch_covering(labels);

    auto collect = frame.compute("segmentation.collect_samples", spirv::collect_samples);
    collect.read("RecordCounters", records.record_counters).read("Records", records.records).push(part);
    collect.read("Counts", ids.counts).read("Albedo", records.albedo);
    ids.kd = collect.modify("SegmentKds", ids.kd);
    collect.modify("Filled", zeros("segmentation.samples_filled", labels));
    ids.kept = collect.write("Kept", ids.kept);
    collect.dispatch_covering(capacity);
}

graph::BufferId add_draw_records(graph::FrameGraph& frame, const ObservationMapIds& records,
                                 const SegmentSamples& samples, const SegmentSampleIds& ids, uint32_t draws,
                                 uint32_t seed) {
    if (draws == 0 || draws > gpu::kSegmentSamples / 2) {
        throw Error("the pass 'segmentation.draw_records' is to draw ", draws,
                    " records of a segment, it can draw 1 to ", gpu::kSegmentSamples / 2);
    }
    const uint64_t bytes = uint64_t{samples.labels()} * draws * sizeof(uint32_t);
    const graph::BufferId none = frame.fill(frame.create_buffer("segmentation.drawn", bytes), gpu::kNoRecord);
    auto pass = frame.compute("segmentation.draw_records", spirv::draw_records);
    pass.read("Records", records.records).read("Counts", ids.counts).read("Kept", ids.kept);
    pass.push(gpu::SegmentSampleParams{seed, samples.labels(), 0, draws});
    const graph::BufferId drawn = pass.modify("Drawn", none);
    pass.dispatch(gpu::kGroupsPerRow, (samples.labels() + gpu::kGroupsPerRow - 1) / gpu::kGroupsPerRow);
    return drawn;
}

graph::BufferId add_place_samples(graph::FrameGraph& frame, const ObservationMapIds& records,
                                  const SegmentSamples& samples, const SegmentSampleIds& ids) {
    auto place = frame.compute("segmentation.place_samples", spirv::place_samples);
    place.read("Records", records.records).read("Counts", ids.counts).read("Kept", ids.kept);
    place.push(gpu::SegmentSampleParams{0, samples.labels(), 0, 0});
    const graph::BufferId places =
        place.create("Places", uint64_t{samples.labels()} * gpu::kSegmentSamples * sizeof(glm::uvec2));
    place.dispatch_covering(samples.labels());
    return places;
}

void add_find_samples(graph::FrameGraph& frame, const ObservationMap& map, const ObservationMapIds& records,
                      const SegmentSamples& samples, SegmentSampleIds& ids, graph::BufferId places) {
    auto find = frame.compute("segmentation.find_samples", spirv::find_samples);
    find.read("Places", places).read("Keys", records.keys).read("Blocks", records.blocks);
    find.read("RecordTable", records.record_table);
    find.push(gpu::FoundSamplesParams{map.grid(), map.edge_shift(), samples.labels(), 0, 0});
    ids.counts = find.modify("Counts", ids.counts);
    ids.kept = find.modify("Kept", ids.kept);
    find.dispatch_covering(samples.labels());
}

}  // namespace patina
