#include "reconstruction/streaming/block_stream.h"

#include <algorithm>
#include <cmath>

#include "passes/state/block_keys.h"

namespace patina {

namespace {

constexpr uint32_t kMostRounds = 8;  // graphs in which blocks leave besides, while a camera moves fast

// Metres beyond what a frame looks at: blocks come back from within the one, and leave from outside the other. The
// smallest is more than what float and double differ by.
constexpr double kNeeded_m = 0.01, kAhead_m = 0.3, kLeave_m = 0.6;

}  // namespace

BlockStream::BlockStream(graph::Runner& runner, const VoxelMap& map, Limits limits, BlockStore& store)
    : runner_(runner), map_(map), store_(store), limits_(limits) {}

void BlockStream::reset() {
    store_.clear();
    pending_.clear();
    declared_.clear();
    coming_.clear();
    keeps_.reset();
    left_outside_ = 0;
    disturbed_ = short_ = false;
    left_ = returned_ = awaited_ = 0;
}

template <class Kind>
bool BlockStream::pends() const {
    return std::any_of(pending_.begin(), pending_.end(),
                       [](const Event& event) { return std::holds_alternative<Kind>(event); });
}

/// Whether the frame may need blocks that are on their way to the host: it is not where they left, or looks elsewhere.
bool BlockStream::would_miss(const StreamRegion& near) const {
    return std::any_of(pending_.begin(), pending_.end(), [&](const Event& event) {
        const auto* leaving = std::get_if<Leaving>(&event);
        if (!leaving) return false;
        // Of the ball and of what the cone reaches, which turns.
        const double moved_m = glm::distance(leaving->center_m, near.center_m);
        const double turned_m = near.far_m * glm::distance(leaving->axis, near.axis);
        return moved_m + (near.far_m > near.radius_m ? turned_m : 0) > 0.9 * (kLeave_m - kNeeded_m);
    });
}

void BlockStream::plan(const StreamRegion& near, StreamTurn turn) {
    collect();
    if (disturbed_) {
        // What came back for others than frames may have the places that this one counts on.
        while (leave_now(near.grown(kLeave_m)) > 0) {
        }
        prepare_for_frame();
        disturbed_ = false;
    }
    store_.make_room(map_.grid(), near.center_m);
    // What the device may refuse again has to be known, too.
    if (would_miss(near) || (turn.relabels && pends<Leaving>()) || (short_ && pends<Returning>())) collect_all();
    keeps_.reset();
    if (turn.leaves) keeps_ = near.grown(kLeave_m);

    coming_ = store_.keys(map_.grid(), near.grown(kAhead_m));
    const StreamRegion needed = near.grown(kNeeded_m);
    const auto is_needed = [&](uint32_t key) { return needed.holds(map_.grid(), block_of_key(map_.grid(), key)); };
    const auto first_ahead = std::stable_partition(coming_.begin(), coming_.end(), is_needed);
    const auto now = static_cast<size_t>(first_ahead - coming_.begin());
    awaited_ += now;
    // What was replaced last is not known yet: what need not come waits for it.
    coming_.resize(turn.relabelled ? now : std::max(now, at_once(coming_)));
    if (!coming_.empty() && pends<Relabelled>()) collect_all();
}

uint32_t BlockStream::coming_places() const {
    uint32_t all = 0;
    for (const uint32_t key : coming_) all += places(key);
    return all;
}

size_t BlockStream::at_once(std::span<const uint32_t> keys) const {
    size_t count = 0;
    for (uint32_t taken = 0; count < keys.size(); ++count) {
        taken += places(keys[count]);
        if (taken > limits_.returning && count > 0) break;
    }
    return count;
}

void BlockStream::move_surplus() {
    if (keeps_) {
        const uint32_t rounds = std::min(left_outside_ / limits_.leaving, kMostRounds);
        for (uint32_t i = 0; i < rounds; ++i) {
            graph::FrameGraph graph = runner_.begin();
            add_leaving(graph, *keeps_);
            submit(std::move(graph));
        }
    }
    for (size_t first = at_once(coming_); first < coming_.size(); first = at_once(coming_)) {
        graph::FrameGraph graph = runner_.begin();
        add_returning(graph, std::span(coming_).first(first));
        submit(std::move(graph));
        coming_.erase(coming_.begin(), coming_.begin() + static_cast<std::ptrdiff_t>(first));
    }
}

void BlockStream::add(graph::FrameGraph& graph) {
    if (keeps_) add_leaving(graph, *keeps_);
    keeps_.reset();
    if (!coming_.empty()) add_returning(graph, coming_);
    coming_.clear();
}

void BlockStream::add_leaving(graph::FrameGraph& graph, const StreamRegion& region) {
    Leaving leaving = leave(graph, region.gpu(), limits_.leaving);
    leaving.center_m = region.center_m;
    leaving.axis = region.axis;
    declared_.emplace_back(std::in_place_type<Leaving>, std::move(leaving));
}

/// The blocks of these keys leave the store; what the device has no room for is put back into it.
void BlockStream::add_returning(graph::FrameGraph& graph, std::span<const uint32_t> keys) {
    const graph::BufferId blocks = bring_back(graph, keys);
    // What the device has, the host forgets when it knows that.
    auto& returning = std::get<Returning>(declared_.emplace_back(std::in_place_type<Returning>));
    returning.kept.reserve(keys.size());
    returning.blocks = graph.read_back(blocks);
    for (const uint32_t key : keys) returning.kept.emplace_back(key, store_.take(key));
}

void BlockStream::await_relabelling(graph::FrameGraph& graph, uint32_t part, graph::BufferId parents) {
    if (store_.blocks() == 0) return;
    const Relabelled relabelled{part, graph.read_back(parents)};
    declared_.emplace_back(std::in_place_type<Relabelled>, relabelled);
}

void BlockStream::note_submitted() {
    for (Event& event : declared_) pending_.push_back(std::move(event));
    declared_.clear();
}

/// A graph of its own.
void BlockStream::submit(graph::FrameGraph graph) {
    keep(graph);
    runner_.submit(std::move(graph));
    note_submitted();
}

/// The graph that was declared last was not submitted: what was to come back with it is still away.
void BlockStream::roll_back() {
    for (Event& event : declared_) {
        auto* returning = std::get_if<Returning>(&event);
        if (!returning) continue;
        for (; !returning->kept.empty(); returning->kept.pop_back())
            store_.put(returning->kept.back().first, std::move(returning->kept.back().second));
    }
    declared_.clear();
}

void BlockStream::collect() {
    roll_back();
    const auto ready = [](const Event& event) {
        if (const auto* leaving = std::get_if<Leaving>(&event)) return leaving->count.ready();
        if (const auto* returning = std::get_if<Returning>(&event)) return returning->blocks.ready();
        return std::get<Relabelled>(event).parents.ready();
    };
    for (; !pending_.empty() && ready(pending_.front()); pending_.pop_front())
        std::visit([this](auto& event) { note(event); }, pending_.front());
}

void BlockStream::collect_all() {
    if (!pending_.empty()) runner_.wait();
    collect();
}

void BlockStream::note(const Leaving& leaving) {
    const uint32_t places = keep_left(leaving);
    left_ += places;
    left_outside_ = leaving.counts.as<uint32_t>()[gpu::kLeavingOutside] - places;
}

/// One by one, so that it can go on where memory ran out.
void BlockStream::note(Returning& returning) {
    const auto blocks = returning.blocks.as<gpu::StreamedBlock>();
    short_ = std::any_of(blocks.begin(), blocks.begin() + static_cast<std::ptrdiff_t>(returning.kept.size()),
                         [](const gpu::StreamedBlock& block) { return block.block == gpu::kNoBlock; });
    for (; !returning.kept.empty(); returning.kept.pop_back()) {
        auto& [key, kept] = returning.kept.back();
        if (blocks[returning.kept.size() - 1].block == gpu::kNoBlock) {
            store_.put(key, std::move(kept));
        } else {
            ++returned_;
        }
    }
}

void BlockStream::note(const Relabelled& relabelled) {
    store_.relabel(relabelled.part, relabelled.parents.as<uint32_t>());
}

bool BlockStream::require(const StreamRegion& wanted) {
    const StreamRegion region = wanted.grown(kNeeded_m);
    collect_all();
    store_.make_room(map_.grid(), region.middle_m(map_.grid()));
    const std::vector<uint32_t> needed = store_.keys(map_.grid(), region);
    if (needed.empty()) return true;
    disturbed_ = true;
    make_room(region, needed);
    for (std::span<const uint32_t> rest(needed); !rest.empty();) {
        const size_t count = at_once(rest);
        graph::FrameGraph graph = runner_.begin();
        add_returning(graph, rest.first(count));
        submit(std::move(graph));
        rest = rest.subspan(count);
    }
    collect_all();
    return !short_;
}

/// Blocks outside the region leave until so many fit, or none is left.
void BlockStream::make_room(const StreamRegion& region, std::span<const uint32_t> keys) {
    while (!has_room(keys) && leave_now(region) > 0) {
    }
}

/// As many blocks outside a region leave as one graph takes along. Waits. Returns how many places are left outside; 0
/// if no block left.
uint32_t BlockStream::leave_now(const StreamRegion& region) {
    prepare_to_leave();
    graph::FrameGraph graph = runner_.begin();
    add_leaving(graph, region);
    submit(std::move(graph));
    const uint64_t before = left_;
    collect_all();
    return left_ > before ? left_outside_ : 0;
}

std::vector<uint32_t> BlockStream::keys() {
    collect_all();
    graph::FrameGraph graph = runner_.begin();
    const graph::Readback read = graph.read_back(keys_on_device(graph));
    runner_.submit(std::move(graph));
    runner_.wait();
    std::vector<uint32_t> keys = read.as<uint32_t>();
    std::erase(keys, gpu::kEmptyKey);
    const std::vector<uint32_t> away = store_.keys(map_.grid(), {});
    keys.insert(keys.end(), away.begin(), away.end());
    return keys;
}

void BlockStream::visit(graph::StateVisitor& visitor, const std::string& name) {
    collect();  // all are there
    store_.visit(visitor, map_.grid());
    visitor.value(name + ".left_outside", left_outside_);
    visitor.value(name + ".disturbed", disturbed_);
    visitor.value(name + ".short", short_);
    visitor.value(name + ".left", left_);
    visitor.value(name + ".returned", returned_);
    visitor.value(name + ".awaited", awaited_);
}

}  // namespace patina
