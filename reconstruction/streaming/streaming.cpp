#include "reconstruction/streaming/streaming.h"

#include "passes/segmentation/sweep_away.h"
#include "passes/state/block_keys.h"

namespace patina {

namespace {

// Blocks leave in one of the frames between two sweeps: the host has them before the next one. Voxels are swept in
// frame 1 of gpu::kSweepEvery, observed voxels in frame 3.
constexpr uint32_t kLeaveTurn = 2, kRecordsLeaveTurn = 0;

uint32_t turn_of(uint32_t index) { return (index + 1) % gpu::kSweepEvery; }

/// Where there are both, each store has half of the memory.
uint64_t bytes_of_store(const ReconstructionSettings& settings) {
    return (uint64_t{settings.host_mib} << 20) / (settings.reflectance ? 2 : 1);
}

}  // namespace

Streaming::Streaming(graph::Runner& runner, Stages& stages)
    : stages_(stages),
      block_store_(bytes_of_store(stages.settings), "away.blocks"),
      record_store_(bytes_of_store(stages.settings), "away.records"),
      voxels_(runner, stages, block_store_) {
    if (stages.reflectance) records_.emplace(runner, stages, record_store_);
}

void Streaming::reset() {
    voxels_.reset();
    if (records_) records_->reset();
}

void Streaming::forget_records() {
    if (records_) records_->reset();
}

ComingPlaces Streaming::plan(const StreamRegion& near, uint32_t index, Many many) {
    const bool relabels = stages_.segmentation.has_value();
    const auto turn = [&](bool leaves, bool (*in_frame)(uint32_t)) {
        return StreamTurn{leaves, relabels && in_frame(index), relabels && index > 0 && in_frame(index - 1)};
    };
    voxels_.plan(near, turn(many.blocks && turn_of(index) == kLeaveTurn, SegmentationStage::sweeps));
    if (!records_) return {voxels_.coming_blocks(), 0, 0};
    const bool may_leave = !stages_.segmentation || stages_.segmentation->may_lose_records(index);
    if (may_leave) records_->note_choice(near);
    records_->plan(near,
                   turn(many.records && may_leave && turn_of(index) == kRecordsLeaveTurn, SegmentationStage::relabels));
    return {voxels_.coming_blocks(), records_->coming_blocks(), records_->coming_places()};
}

void Streaming::move_surplus() {
    voxels_.move_surplus();
    if (records_) records_->move_surplus();
}

void Streaming::add(graph::FrameGraph& graph) {
    voxels_.add(graph);
    if (records_) records_->add(graph);
}

std::span<const uint32_t> Streaming::labels_away(uint32_t index) {
    labels_away_.clear();
    if (stages_.segmentation && SegmentationStage::sweeps(index) && block_store_.blocks() > 0)
        labels_away_ =
            block_store_.count_labels(SegmentationStage::swept_part(index), stages_.segmentation->table().capacity());
    return labels_away_;
}

void Streaming::await_sweep(graph::FrameGraph& graph, uint32_t index) {
    if (!stages_.segmentation) return;
    const uint32_t part = SegmentationStage::swept_part(index);
    const auto parents = [&] { return stages_.segmentation->table().import(graph).parents; };
    if (SegmentationStage::sweeps(index)) voxels_.await_relabelling(graph, part, parents());
    if (records_ && SegmentationStage::relabels(index)) records_->await_relabelling(graph, part, parents());
}

void Streaming::note_submitted() {
    voxels_.note_submitted();
    if (records_) records_->note_submitted();
}

std::vector<glm::ivec3> Streaming::coordinates(BlockStream& stream) {
    const gpu::VoxelGrid& grid = stages_.geometry.map().grid();
    std::vector<glm::ivec3> blocks;
    for (const uint32_t key : stream.keys()) blocks.push_back(block_of_key(grid, key));
    return blocks;
}

std::vector<glm::ivec3> Streaming::observed_blocks() {
    return records_ ? coordinates(*records_) : std::vector<glm::ivec3>();
}

bool Streaming::any_blocks_away() {
    voxels_.collect();
    return block_store_.blocks() > 0;
}

bool Streaming::any_records_away() {
    if (records_) records_->collect();
    return record_store_.blocks() > 0;
}

StreamCounts Streaming::block_counts() {
    voxels_.collect();
    return {block_store_.blocks(), voxels_.left(), voxels_.returned(), voxels_.awaited(), block_store_.filed()};
}

StreamCounts Streaming::record_counts() {
    if (!records_) return {};
    records_->collect();
    return {record_store_.voxels(), records_->left(), records_->returned(), records_->awaited(), record_store_.filed()};
}

std::string Streaming::problem() const {
    const std::string& reason = block_store_.problem().empty() ? record_store_.problem() : block_store_.problem();
    if (reason.empty()) return "";
    return text("what is away from the device stays in memory, ",
                (block_store_.bytes_in_memory() + record_store_.bytes_in_memory()) >> 20, " MiB where map.host_mib is ",
                stages_.settings.host_mib, ": ", reason);
}

void Streaming::prepare_visit() {
    if (records_) records_->bring_samples_back();
}

void Streaming::visit(graph::StateVisitor& visitor) {
    voxels_.visit(visitor, "streaming.blocks");
    if (records_) records_->visit(visitor, "streaming.records");
}

}  // namespace patina
