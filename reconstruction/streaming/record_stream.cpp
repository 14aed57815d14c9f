#include "reconstruction/streaming/record_stream.h"

#include "reconstruction/streaming/record_codec.h"
#include "reconstruction/streaming/upload_padded.h"

namespace patina {

namespace {

constexpr BlockStream::Limits kRecordLimits{32768, 16384};  // 10 MiB of records, and half of it

}  // namespace

RecordStream::RecordStream(graph::Runner& runner, Stages& stages, BlockStore& store)
    : BlockStream(runner, stages.geometry.map(), kRecordLimits, store), stages_(stages) {}

BlockStream::Leaving RecordStream::leave(graph::FrameGraph& graph, const gpu::StreamRegion& region, uint32_t most) {
    const LeavingRecords records = reflectance().add_leave(graph, region, most);
    Leaving leaving;
    leaving.counts = graph.read_back(records.counts, 0, gpu::kLeavingBins * sizeof(uint32_t));
    leaving.count = graph.read_back(records.count);
    leaving.blocks = graph.read_back(records.blocks);
    leaving.words = {graph.read_back(records.records), graph.read_back(records.directions),
                     graph.read_back(records.colors)};
    return leaving;
}

uint32_t RecordStream::keep_left(const Leaving& leaving) {
    const auto count = elements<gpu::LeavingCount>(leaving.count).front();
    const auto records = elements<gpu::StreamedRecord>(leaving.words[0]);
    const auto directions = elements<uint32_t>(leaving.words[1]), colors = elements<uint32_t>(leaving.words[2]);
    for (const gpu::StreamedBlock& block : elements<gpu::StreamedBlock>(leaving.blocks).first(count.blocks)) {
        const size_t first = block.first_record * kObservationWords, words = block.records * kObservationWords;
        store_.put(block.key, pack_records(packer_, {records.subspan(block.first_record, block.records),
                                                     directions.subspan(first, words), colors.subspan(first, words)}));
    }
    return count.records;
}

graph::BufferId RecordStream::bring_back(graph::FrameGraph& graph, std::span<const uint32_t> keys) {
    std::vector<gpu::StreamedBlock> blocks;
    UnpackedRecords unpacked;
    for (const uint32_t key : keys) {
        const auto first = static_cast<uint32_t>(unpacked.records.size());
        unpack_records(packer_, store_, key, static_cast<uint32_t>(blocks.size()), unpacked);
        blocks.push_back({key, gpu::kNoBlock, 0, 0, first, static_cast<uint32_t>(unpacked.records.size()) - first});
    }
    const uint32_t most_blocks = padded(blocks.size()), most_records = padded(unpacked.records.size());
    ReturningRecords list;
    list.block_count = static_cast<uint32_t>(blocks.size());
    list.record_count = static_cast<uint32_t>(unpacked.records.size());
    list.blocks = upload_padded(graph, "streaming.record_blocks", blocks, most_blocks);
    list.records = upload_padded(graph, "streaming.records", unpacked.records, most_records);
    list.directions =
        upload_padded(graph, "streaming.directions", unpacked.directions, most_records * kObservationWords);
    list.colors = upload_padded(graph, "streaming.record_colors", unpacked.colors, most_records * kObservationWords);
    return reflectance().add_return(graph, list);
}

uint32_t RecordStream::places(uint32_t key) const { return count_records(store_.at(key)); }

void RecordStream::keep(graph::FrameGraph& graph) { reflectance().keep(graph); }

void RecordStream::note_choice(const StreamRegion& near) {
    chosen_in_ = near;
    places_.clear();
}

void RecordStream::prepare_to_leave() {
    if (!stages_.segmentation || !places_.empty()) return;
    graph::FrameGraph graph = runner_.begin();
    const graph::Readback places =
        graph.read_back(stages_.segmentation->add_place_samples(graph, reflectance().observations()));
    runner_.submit(std::move(graph));
    runner_.wait();
    places_ = places.as<glm::uvec2>();
}

void RecordStream::bring_samples_back() {
    if (places_.empty()) return;
    require(chosen_in_);
    graph::FrameGraph graph = runner_.begin();
    stages_.segmentation->add_find_samples(graph, reflectance().observations(),
                                           graph.upload<glm::uvec2>("streaming.sample_places", places_));
    runner_.submit(std::move(graph));
    runner_.wait();
    places_.clear();
}

void RecordStream::reset() {
    BlockStream::reset();
    note_choice({});
}

void RecordStream::visit(graph::StateVisitor& visitor, const std::string& name) {
    BlockStream::visit(visitor, name);
    visitor.value(name + ".chosen_in", chosen_in_);
}

graph::BufferId RecordStream::keys_on_device(graph::FrameGraph& graph) {
    return reflectance().observations().import(graph).block_keys;
}

bool RecordStream::has_room(std::span<const uint32_t> keys) {
    graph::FrameGraph graph = runner_.begin();
    const ObservationMapIds ids = reflectance().observations().import(graph);
    const graph::Readback blocks = graph.read_back(ids.block_counters), records = graph.read_back(ids.record_counters);
    runner_.submit(std::move(graph));
    runner_.wait();
    uint64_t needed = 0;
    for (const uint32_t key : keys) needed += places(key);
    return blocks.as<gpu::MapCounters>().front().free_blocks >= keys.size() &&
           records.as<gpu::MapCounters>().front().free_blocks >= needed;
}

}  // namespace patina
