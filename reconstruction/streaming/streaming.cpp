#include "reconstruction/streaming/streaming.h"

#include <algorithm>
#include <cmath>

#include "passes/segmentation/sweep_away.h"
#include "passes/state/block_keys.h"

namespace patina {

namespace {

constexpr uint32_t kMostLeaving = 2048;    // blocks at once, 12 MiB
constexpr uint32_t kMostRounds = 8;        // so often at once besides, while a camera moves fast
constexpr uint32_t kMostReturning = 1024;  // in one frame

// Metres beyond what a frame looks at: blocks come back from within the one, and leave from outside the other. The
// smallest is more than what float and double differ by.
constexpr double kNeeded_m = 0.01, kAhead_m = 0.3, kLeave_m = 0.6;

// Blocks leave in one of the frames between two sweeps: the host has them before the next one.
constexpr uint32_t kLeaveTurn = 2;

/// Few sizes of lists, so that frames keep their shape.
uint32_t padded(size_t blocks) {
    uint32_t size = 64;
    while (size < blocks) size *= 4;
    return size;
}

template <class T>
graph::BufferId upload_padded(graph::FrameGraph& graph, const char* name, const std::vector<T>& values, uint64_t size) {
    const graph::BufferId id = graph.create_buffer(name, size * sizeof(T));
    return graph.upload_bytes(id, 0, std::as_bytes(std::span(values)), true);
}

/// The words of the block that stands at a place in a read-back.
std::span<const uint32_t> words_at(const graph::Readback& read, size_t place) {
    const auto* words = reinterpret_cast<const uint32_t*>(read.bytes().data());
    return {words + place * gpu::kBlockVoxels, gpu::kBlockVoxels};
}

}  // namespace

Streaming::Streaming(graph::Runner& runner, Stages& stages)
    : runner_(runner), stages_(stages), store_(uint64_t{stages.settings.host_mib} << 20) {}

void Streaming::reset() {
    store_.clear();
    pending_.clear();
    declared_.clear();
    coming_.clear();
    keeps_.reset();
    left_outside_ = 0;
    short_ = false;
    left_ = returned_ = awaited_ = 0;
}

template <class Kind>
bool Streaming::pends() const {
    return std::any_of(pending_.begin(), pending_.end(),
                       [](const Event& e) { return std::holds_alternative<Kind>(e); });
}

/// Whether the frame may need blocks that are on their way to the host: it is not where they left, or looks elsewhere.
bool Streaming::would_miss(const StreamRegion& near) const {
    return std::any_of(pending_.begin(), pending_.end(), [&](const Event& event) {
        const auto* leaving = std::get_if<Leaving>(&event);
        if (!leaving) return false;
        // Of the ball and of what the cone reaches, which turns.
        const double moved_m = glm::distance(leaving->center_m, near.center_m);
        const double turned_m = near.far_m * glm::distance(leaving->axis, near.axis);
        return moved_m + (near.far_m > near.radius_m ? turned_m : 0) > 0.9 * (kLeave_m - kNeeded_m);
    });
}

uint32_t Streaming::plan(const StreamRegion& near, uint32_t index, bool many) {
    collect();
    store_.make_room(map().grid(), near.center_m);
    const bool sweeps = SegmentationStage::sweeps(index);
    // What the device may refuse again has to be known, too.
    if (would_miss(near) || (sweeps && pends<Leaving>()) || (short_ && pends<Returning>())) collect_all();
    keeps_.reset();
    if (many && (index + 1) % gpu::kSweepEvery == kLeaveTurn) keeps_ = near.grown(kLeave_m);

    coming_ = store_.keys(map().grid(), near.grown(kAhead_m));
    const StreamRegion needed = near.grown(kNeeded_m);
    const auto is_needed = [&](uint32_t key) { return needed.holds(map().grid(), block_of_key(map().grid(), key)); };
    const auto first_ahead = std::stable_partition(coming_.begin(), coming_.end(), is_needed);
    const auto at_once = static_cast<size_t>(first_ahead - coming_.begin());
    awaited_ += at_once;
    // What the last sweep replaced is not known yet: what need not come waits for it.
    const bool after_sweep = index > 0 && SegmentationStage::sweeps(index - 1);
    const size_t with_ahead = std::max(at_once, std::min<size_t>(coming_.size(), kMostReturning));
    coming_.resize(after_sweep ? at_once : with_ahead);
    if (!coming_.empty() && pends<Swept>()) collect_all();
    return static_cast<uint32_t>(coming_.size());
}

void Streaming::move_surplus() {
    if (keeps_) {
        const uint32_t rounds = std::min(left_outside_ / kMostLeaving, kMostRounds);
        for (uint32_t i = 0; i < rounds; ++i) {
            graph::FrameGraph graph = runner_.begin();
            add_leaving(graph, *keeps_);
            submit(std::move(graph));
        }
    }
    while (coming_.size() > kMostReturning) {
        graph::FrameGraph graph = runner_.begin();
        add_returning(graph, std::span(coming_).first(kMostReturning));
        submit(std::move(graph));
        coming_.erase(coming_.begin(), coming_.begin() + kMostReturning);
    }
}

void Streaming::add(graph::FrameGraph& graph) {
    if (keeps_) add_leaving(graph, *keeps_);
    keeps_.reset();
    if (!coming_.empty()) add_returning(graph, coming_);
    coming_.clear();
}

/// Returns what the blocks outside are counted in.
graph::Readback Streaming::add_leaving(graph::FrameGraph& graph, const StreamRegion& region) {
    VoxelMapIds voxels = map().import(graph);
    std::optional<LabelMapIds> labels;
    if (stages_.segmentation) labels = stages_.segmentation->labels().import(graph);
    const LeavingBlocks blocks =
        add_leave_blocks(graph, map(), voxels, labels ? &*labels : nullptr, region.gpu(), kMostLeaving);
    Leaving leaving;
    leaving.center_m = region.center_m;
    leaving.axis = region.axis;
    leaving.counts = graph.read_back(blocks.counts, 0, gpu::kLeavingBins * sizeof(uint32_t));
    leaving.count = graph.read_back(blocks.count);
    leaving.blocks = graph.read_back(blocks.blocks);
    leaving.tsdf = graph.read_back(blocks.tsdf);
    leaving.color = graph.read_back(blocks.color);
    if (labels) leaving.labels = graph.read_back(blocks.labels);
    declared_.push_back(leaving);
    return leaving.counts;
}

/// The blocks of these keys leave the store; what the device has no room for is put back into it.
void Streaming::add_returning(graph::FrameGraph& graph, std::span<const uint32_t> keys) {
    const bool labelled = stages_.segmentation.has_value();
    std::vector<gpu::StreamedBlock> blocks;
    std::vector<uint32_t> tsdf(keys.size() * gpu::kBlockVoxels), color(tsdf.size()), words(labelled ? tsdf.size() : 0);
    const auto part = [](std::vector<uint32_t>& all, size_t i) {
        return all.empty() ? std::span<uint32_t>() : std::span(all).subspan(i * gpu::kBlockVoxels, gpu::kBlockVoxels);
    };
    for (size_t i = 0; i < keys.size(); ++i)
        blocks.push_back(store_.read(keys[i], part(tsdf, i), part(color, i), part(words, i)));
    const uint32_t size = padded(keys.size());
    ReturningBlocks list;
    list.count = static_cast<uint32_t>(keys.size());
    list.blocks = upload_padded(graph, "streaming.blocks", blocks, size);
    list.tsdf = upload_padded(graph, "streaming.tsdf", tsdf, uint64_t{size} * gpu::kBlockVoxels);
    list.color = upload_padded(graph, "streaming.color", color, uint64_t{size} * gpu::kBlockVoxels);
    if (labelled) list.labels = upload_padded(graph, "streaming.labels", words, uint64_t{size} * gpu::kBlockVoxels);

    VoxelMapIds voxels = map().import(graph);
    std::optional<LabelMapIds> labels;
    if (labelled) labels = stages_.segmentation->labels().import(graph);
    // What the device has, the host forgets when it knows that.
    auto& returning = std::get<Returning>(declared_.emplace_back(Returning{}));
    returning.kept.reserve(keys.size());
    returning.blocks = graph.read_back(add_return_blocks(graph, map(), voxels, labels ? &*labels : nullptr, list));
    for (const uint32_t key : keys) returning.kept.emplace_back(key, store_.take(key));
}

std::span<const uint32_t> Streaming::labels_away(uint32_t index) {
    labels_away_.clear();
    if (stages_.segmentation && SegmentationStage::sweeps(index) && store_.blocks() > 0)
        labels_away_ =
            store_.count_labels(SegmentationStage::swept_part(index), stages_.segmentation->table().capacity());
    return labels_away_;
}

void Streaming::await_sweep(graph::FrameGraph& graph, uint32_t index) {
    if (labels_away_.empty()) return;
    const SegmentTableIds table = stages_.segmentation->table().import(graph);
    declared_.push_back(Swept{SegmentationStage::swept_part(index), graph.read_back(table.parents)});
}

void Streaming::note_submitted() {
    for (Event& event : declared_) pending_.push_back(std::move(event));
    declared_.clear();
}

/// A graph of its own.
void Streaming::submit(graph::FrameGraph graph) {
    VoxelMap::keep(graph, map().import(graph));
    if (stages_.segmentation) LabelMap::keep(graph, stages_.segmentation->labels().import(graph));
    runner_.submit(std::move(graph));
    note_submitted();
}

/// The graph that was declared last was not submitted: what was to come back with it is still away.
void Streaming::roll_back() {
    for (Event& event : declared_) {
        auto* returning = std::get_if<Returning>(&event);
        if (!returning) continue;
        for (; !returning->kept.empty(); returning->kept.pop_back())
            store_.put_back(returning->kept.back().first, std::move(returning->kept.back().second));
    }
    declared_.clear();
}

void Streaming::collect() {
    roll_back();
    const auto ready = [](const Event& event) {
        if (const auto* leaving = std::get_if<Leaving>(&event)) return leaving->count.ready();
        if (const auto* returning = std::get_if<Returning>(&event)) return returning->blocks.ready();
        return std::get<Swept>(event).parents.ready();
    };
    for (; !pending_.empty() && ready(pending_.front()); pending_.pop_front())
        std::visit([this](auto& event) { note(event); }, pending_.front());
}

void Streaming::collect_all() {
    if (!pending_.empty()) runner_.wait();
    collect();
}

void Streaming::note(const Leaving& leaving) {
    const uint32_t count = leaving.count.as<uint32_t>().front();
    const auto blocks = leaving.blocks.as<gpu::StreamedBlock>();
    for (uint32_t i = 0; i < count; ++i) {
        const auto labels = stages_.segmentation ? words_at(leaving.labels, i) : std::span<const uint32_t>();
        store_.put(blocks[i], {words_at(leaving.tsdf, i), words_at(leaving.color, i), labels});
    }
    left_ += count;
    left_outside_ = leaving.counts.as<uint32_t>()[gpu::kLeavingOutside] - count;
}

/// One by one, so that it can go on where memory ran out.
void Streaming::note(Returning& returning) {
    const auto blocks = returning.blocks.as<gpu::StreamedBlock>();
    short_ = std::any_of(blocks.begin(), blocks.begin() + static_cast<std::ptrdiff_t>(returning.kept.size()),
                         [](const gpu::StreamedBlock& block) { return block.block == gpu::kNoBlock; });
    for (; !returning.kept.empty(); returning.kept.pop_back()) {
        auto& [key, kept] = returning.kept.back();
        if (blocks[returning.kept.size() - 1].block == gpu::kNoBlock) {
            store_.put_back(key, std::move(kept));
        } else {
            ++returned_;
        }
    }
}

void Streaming::note(const Swept& swept) { store_.relabel(swept.part, swept.parents.as<uint32_t>()); }

void Streaming::require(const StreamRegion& wanted) {
    const StreamRegion region = wanted.grown(kNeeded_m);
    collect_all();
    store_.make_room(map().grid(), region.middle_m(map().grid()));
    const std::vector<uint32_t> needed = store_.keys(map().grid(), region);
    if (needed.empty()) return;
    make_room(region, needed.size());
    for (std::span<const uint32_t> rest(needed); !rest.empty();) {
        const size_t count = std::min<size_t>(rest.size(), kMostReturning);
        graph::FrameGraph graph = runner_.begin();
        add_returning(graph, rest.first(count));
        submit(std::move(graph));
        rest = rest.subspan(count);
    }
    collect_all();
}

/// Blocks outside the region leave until so many fit, or none is left.
void Streaming::make_room(const StreamRegion& region, size_t blocks) {
    const auto read_free = [&](graph::FrameGraph graph) {
        const graph::Readback counters = graph.read_back(map().import(graph).counters);
        submit(std::move(graph));
        runner_.wait();
        return counters.as<gpu::MapCounters>().front().free_blocks;
    };
    uint32_t before = 0, free = read_free(runner_.begin()), outside = 1;
    for (bool first = true; free < blocks && outside > 0 && (first || free > before); first = false) {
        before = free;
        graph::FrameGraph graph = runner_.begin();
        const graph::Readback counts = add_leaving(graph, region);
        free = read_free(std::move(graph));
        outside = counts.as<uint32_t>()[gpu::kLeavingOutside];
        collect_all();
    }
}

std::vector<uint32_t> Streaming::keys_on_device() {
    graph::FrameGraph graph = runner_.begin();
    const graph::Readback read = graph.read_back(map().import(graph).block_keys);
    runner_.submit(std::move(graph));
    runner_.wait();
    std::vector<uint32_t> keys = read.as<uint32_t>();
    std::erase(keys, gpu::kEmptyKey);
    return keys;
}

std::vector<glm::ivec3> Streaming::blocks() {
    collect_all();
    std::vector<glm::ivec3> blocks;
    for (const uint32_t key : keys_on_device()) blocks.push_back(block_of_key(map().grid(), key));
    for (const uint32_t key : store_.keys(map().grid(), {})) blocks.push_back(block_of_key(map().grid(), key));
    return blocks;
}

StreamCounts Streaming::counts() {
    collect();
    return {store_.blocks(), left_, returned_, awaited_, store_.filed()};
}

std::string Streaming::problem() const {
    if (store_.problem().empty()) return "";
    return text("voxel blocks that are away stay in memory, ", store_.bytes_in_memory() >> 20,
                " MiB where map.host_mib is ", stages_.settings.host_mib, ": ", store_.problem());
}

bool Streaming::any_away() {
    collect();
    return store_.blocks() > 0;
}

void Streaming::visit(graph::StateVisitor& visitor) {
    collect();  // all are there
    store_.visit(visitor, map().grid());
    visitor.value("streaming.left_outside", left_outside_);
    visitor.value("streaming.short", short_);
    visitor.value("streaming.left", left_);
    visitor.value("streaming.returned", returned_);
    visitor.value("streaming.awaited", awaited_);
}

}  // namespace patina
