#include <algorithm>
#include <span>

#include "engine/core/error.h"
#include "engine/graph/plan/plan.h"

// The checker knows how a frame executes and nothing of how a plan is made. With compile() it shares only the
// vocabulary: the types of plan.h and scope_of().
//
// Memory is cut into cells: one for each imported resource, and one for each stretch of an arena in which no placement
// begins or ends. Each cell is simulated on its own. For every past access to it the simulation holds
//   ordered    the stages whose later commands wait for the access,
//   available  whether what it wrote has left the caches,
//   visible    the accesses that will see what it wrote.
// A barrier reaches a past access if its source has the access's own stages, or a stage already ordered behind the
// access (a chain). It then orders its destination stages behind the access. It makes a write available if its source
// names the write itself, and makes an available write visible to its destination accesses. Of two accesses to one cell
// of which one writes, the later must be ordered behind the earlier, and see it if that one wrote.
//
// All barriers before one pass are one command, so they do not chain with each other. A barrier on a resource acts on
// that resource's memory alone. A layout transition is a write in the middle of its barrier: it must be reached by
// every past access, and is itself ordered and visible to the barrier's destination. Everything earlier frames did is
// one past access to every cell, in all stages; they may have used the memory through other resources, so only the
// frame boundary, which names none, orders an access behind them.

namespace patina::graph {
namespace {

uint32_t accesses_of(uint32_t stages) {
    uint32_t accesses = kAccessNone;
    if (stages & kStageCompute) {
        accesses |= kAccessStorageRead | kAccessStorageWrite | kAccessSampledRead | kAccessUniformRead;
    }
    if (stages & kStageTransfer) accesses |= kAccessTransferRead | kAccessTransferWrite;
    if (stages & kStageIndirect) accesses |= kAccessIndirectRead;
    return accesses;
}

bool contains(uint32_t set, uint32_t subset) { return (subset & ~set) == 0; }

// ---- the plan's form ----

void find_order_problems(const Description& description, const Plan& plan, std::vector<std::string>& problems) {
    std::vector<uint32_t> all = plan.order;
    all.insert(all.end(), plan.culled.begin(), plan.culled.end());
    std::ranges::sort(all);
    for (uint32_t i = 0; i < all.size(); ++i) {
        if (all[i] == i) continue;
        problems.push_back(text("the plan misses pass ", i, " or has it twice"));
        return;
    }
    if (all.size() != description.passes.size()) {
        problems.push_back(text("the plan has ", all.size(), " passes of ", description.passes.size()));
    }
}

void find_placement_problems(const Description& description, const Plan& plan, std::vector<std::string>& problems) {
    if (plan.placements.size() != description.resources.size()) {
        problems.push_back(text("the plan has placements for ", plan.placements.size(), " resources of ",
                                description.resources.size()));
        return;
    }
    for (uint32_t index : plan.order) {
        for (const Access& access : description.passes[index].accesses) {
            const Resource& resource = description.resources[access.resource];
            const std::optional<Placement>& placement = plan.placements[access.resource];
            if (resource.imported) continue;
            const MemoryNeed& arena = resource.kind == ResourceKind::kImage ? plan.image_arena : plan.buffer_arena;
            const bool fits = placement && placement->bytes >= resource.need.bytes &&
                              placement->offset % resource.need.alignment == 0 &&
                              placement->offset + placement->bytes <= arena.bytes;
            if (!fits) problems.push_back(text("'", resource.name, "' has no fitting place in its arena"));
        }
    }
}

void find_barrier_problems(const Description& description, const Plan& plan, std::vector<std::string>& problems) {
    for (size_t i = 0; i < plan.barriers.size(); ++i) {
        const Barrier& barrier = plan.barriers[i];
        const bool known = barrier.before < plan.order.size() &&
                           (!barrier.resource || *barrier.resource < description.resources.size());
        const bool sorted = i == 0 || plan.barriers[i - 1].before <= barrier.before;
        if (!known) problems.push_back(text("barrier ", i, " names a pass or resource that the plan lacks"));
        if (!sorted) problems.push_back(text("barrier ", i, " is out of order"));
        if (known && barrier.discard &&
            (!barrier.resource || description.resources[*barrier.resource].kind != ResourceKind::kImage)) {
            problems.push_back(text("barrier ", i, " discards something that is no image"));
        }
    }
}

/// What makes a plan impossible to simulate.
std::vector<std::string> find_form_problems(const Description& description, const Plan& plan) {
    std::vector<std::string> problems;
    find_order_problems(description, plan, problems);
    if (problems.empty()) find_placement_problems(description, plan, problems);
    find_barrier_problems(description, plan, problems);
    return problems;
}

// ---- memory ----

/// Resources that share one stretch of memory, as a set over Description::resources.
using Cell = std::vector<bool>;

void add_arena_cells(const Description& description, const Plan& plan, ResourceKind kind, std::vector<Cell>& cells) {
    std::vector<uint32_t> residents;
    std::vector<uint64_t> cuts;
    for (uint32_t index = 0; index < description.resources.size(); ++index) {
        const std::optional<Placement>& placement = plan.placements[index];
        if (description.resources[index].kind != kind || description.resources[index].imported || !placement) continue;
        residents.push_back(index);
        cuts.push_back(placement->offset);
        cuts.push_back(placement->offset + placement->bytes);
    }
    std::ranges::sort(cuts);
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    for (size_t i = 0; i + 1 < cuts.size(); ++i) {
        Cell cell(description.resources.size());
        for (uint32_t index : residents) {
            const Placement& placement = *plan.placements[index];
            cell[index] = placement.offset <= cuts[i] && cuts[i + 1] <= placement.offset + placement.bytes;
        }
        cells.push_back(std::move(cell));
    }
}

std::vector<Cell> find_cells(const Description& description, const Plan& plan) {
    std::vector<Cell> cells;
    for (uint32_t index = 0; index < description.resources.size(); ++index) {
        if (!description.resources[index].imported) continue;
        cells.emplace_back(description.resources.size())[index] = true;
    }
    add_arena_cells(description, plan, ResourceKind::kBuffer, cells);
    add_arena_cells(description, plan, ResourceKind::kImage, cells);
    return cells;
}

// ---- execution ----

/// The barriers recorded before the pass at `position`.
std::span<const Barrier> command_before(const Plan& plan, uint32_t position) {
    const auto begin = std::ranges::lower_bound(plan.barriers, position, {}, &Barrier::before);
    const auto end = std::ranges::upper_bound(plan.barriers, position, {}, &Barrier::before);
    return {begin, end};
}

/// Runs the frame for one cell and notes what goes wrong.
class CellSimulation {
  public:
    CellSimulation(const Description& description, const Plan& plan, const Cell& cell,
                   std::vector<std::string>& problems)
        : description_(description), plan_(plan), cell_(cell), problems_(problems) {
        const uint32_t all_stages = kStageCompute | kStageTransfer | kStageIndirect;
        past_.push_back({Kind::kEarlierFrames, nullptr, 0, {all_stages, accesses_of(all_stages)}});
        for (uint32_t resource = 0; resource < cell.size(); ++resource) {
            if (cell[resource] && description.resources[resource].imported) content_ = {resource, 0};
        }
    }

    void run() {
        for (uint32_t position = 0; position < plan_.order.size(); ++position) {
            const Pass& pass = description_.passes[plan_.order[position]];
            execute(command_before(plan_, position), pass);
            for (const Access& access : pass.accesses) {
                if (cell_[access.resource]) execute(access, pass);
            }
        }
        for (const Keep& keep : description_.kept) {
            if (!cell_[keep.resource] || content_ == Content{keep.resource, keep.version}) continue;
            report("version ", keep.version, " of '", name(keep.resource), "' is kept, but the frame ends with ",
                   content_text(), " in its memory");
        }
    }

  private:
    enum class Kind : uint8_t { kEarlierFrames, kTransition, kAccess };
    /// Something that happened to the cell.
    struct Past {
        Kind kind = Kind::kAccess;
        const Pass* pass = nullptr;  ///< the pass that made the access, or that follows the transition
        uint32_t resource = 0;       ///< through which it happened
        Scope scope;                 ///< no stages for a transition, which happens between them
        uint32_t ordered = kStageNone;
        bool available = false;
        uint32_t visible = kAccessNone;
    };
    /// A version of a resource.
    struct Content {
        uint32_t resource = 0;
        uint32_t version = 0;
        bool operator==(const Content&) const = default;
    };

    /// Whether the source of `barrier` has the stages of `past` itself; a transition is reached by chains only.
    static bool reaches_directly(const Past& past, const Barrier& barrier) {
        return past.kind != Kind::kTransition && contains(barrier.source.stages, past.scope.stages);
    }

    /// The state of `past` behind `barrier`, as far as that barrier alone goes.
    static Past advanced(const Past& past, const Barrier& barrier) {
        const bool direct = reaches_directly(past, barrier);
        if (!direct && !(barrier.source.stages & past.ordered)) return past;
        Past next = past;
        next.ordered |= barrier.destination.stages;
        next.available |= direct && contains(barrier.source.accesses, past.scope.accesses & kAllWrites);
        if (next.available) next.visible |= barrier.destination.accesses & accesses_of(barrier.destination.stages);
        return next;
    }

    /// Whether the layout transition in the middle of `barrier` comes after `past`.
    static bool reaches_transition(const Past& past, const Barrier& barrier) {
        const bool direct = reaches_directly(past, barrier);
        const bool ordered = direct || (barrier.source.stages & past.ordered);
        const uint32_t written = past.scope.accesses & kAllWrites;
        return ordered &&
               (past.available || written == kAccessNone || (direct && contains(barrier.source.accesses, written)));
    }

    void execute(std::span<const Barrier> command, const Pass& pass) {
        std::vector<Past> next = past_;
        for (const Barrier& barrier : command) {
            if (barrier.resource && !cell_[*barrier.resource]) continue;
            for (size_t i = 0; i < past_.size(); ++i) {
                if (past_[i].kind == Kind::kEarlierFrames && barrier.resource) continue;
                const Past after = advanced(past_[i], barrier);
                next[i].ordered |= after.ordered;
                next[i].available |= after.available;
                next[i].visible |= after.visible;
            }
            if (barrier.discard) next.push_back(transition(barrier, pass));
        }
        past_ = std::move(next);
    }

    /// Discards the cell's content and checks that this comes after all that happened before.
    Past transition(const Barrier& barrier, const Pass& pass) {
        Past now{Kind::kTransition, &pass, *barrier.resource, {kStageNone, kAllWrites}};
        for (const Past& past : past_) {
            if (!reaches_transition(past, barrier)) report(describe(now), " does not wait for ", describe(past));
        }
        content_.reset();
        layout_of_ = barrier.resource;
        now.ordered = barrier.destination.stages;
        now.available = true;
        now.visible = barrier.destination.accesses & accesses_of(barrier.destination.stages);
        return now;
    }

    void execute(const Access& access, const Pass& pass) {
        const Past now{Kind::kAccess, &pass, access.resource, scope_of(access.use)};
        for (const Past& past : past_) check_pair(past, now);
        check_layout(now);
        if (reads(access.use)) check_content(now, {access.resource, access.version});
        if (writes(access.use)) content_ = Content{access.resource, access.version + 1};
        past_.push_back(now);
    }

    void check_pair(const Past& past, const Past& now) {
        const uint32_t written = past.scope.accesses & kAllWrites;
        if (!written && !(now.scope.accesses & kAllWrites)) return;
        if (!contains(past.ordered, now.scope.stages)) {
            report(describe(now), ", does not wait for ", describe(past));
        } else if (written && !contains(past.visible, now.scope.accesses)) {
            report(describe(now), ", waits for ", describe(past), ", but does not see what that wrote");
        }
    }

    void check_layout(const Past& now) {
        const Resource& resource = description_.resources[now.resource];
        if (resource.kind != ResourceKind::kImage || resource.imported || layout_of_ == now.resource) return;
        report(describe(now), ", finds it in an undefined layout");
    }

    void check_content(const Past& now, const Content& wanted) {
        if (content_ == wanted) return;
        report(describe(now), ", wants version ", wanted.version, " of it and finds ", content_text());
    }

    std::string describe(const Past& past) const {
        if (past.kind == Kind::kEarlierFrames) return "earlier frames";
        if (past.kind == Kind::kTransition) {
            return text("the transition of '", name(past.resource), "' before pass '", past.pass->name, "'");
        }
        const char* verb = past.scope.accesses & kAllWrites ? "writes" : "reads";
        return text("pass '", past.pass->name, "', which ", verb, " '", name(past.resource), "'");
    }

    std::string content_text() const {
        if (!content_) return "nothing defined";
        return text("version ", content_->version, " of '", name(content_->resource), "'");
    }

    const std::string& name(uint32_t resource) const { return description_.resources[resource].name; }

    /// Notes a problem once; the cells of one resource often have the same.
    template <class... Parts>
    void report(const Parts&... parts) {
        std::string problem = text(parts...);
        if (std::ranges::find(problems_, problem) == problems_.end()) problems_.push_back(std::move(problem));
    }

    const Description& description_;
    const Plan& plan_;
    const Cell& cell_;
    std::vector<std::string>& problems_;
    std::vector<Past> past_;
    std::optional<Content> content_;     ///< what the cell holds; empty where that is undefined
    std::optional<uint32_t> layout_of_;  ///< the transient image whose layout the cell is in
};

}  // namespace

std::vector<std::string> check(const Description& description, const Plan& plan) {
    std::vector<std::string> problems = find_form_problems(description, plan);
    if (!problems.empty()) return problems;
    for (const Cell& cell : find_cells(description, plan)) CellSimulation(description, plan, cell, problems).run();
    return problems;
}

}  // namespace patina::graph
