#include <algorithm>
#include <utility>

#include "engine/core/error.h"
#include "engine/graph/plan/arena.h"
#include "engine/graph/plan/plan.h"

namespace patina::graph {
namespace {

/// What any earlier frame may have done: its reads need only be waited for, its writes made available too.
constexpr Scope kEarlierFrames{kStageCompute | kStageTransfer | kStageIndirect, kAllWrites};

Scope& operator|=(Scope& scope, const Scope& other) {
    scope.stages |= other.stages;
    scope.accesses |= other.accesses;
    return scope;
}

// ---- wiring ----

void reject_bad_needs(const Description& description) {
    for (const Resource& resource : description.resources) {
        if (resource.imported || (resource.need.bytes > 0 && resource.need.alignment > 0)) continue;
        throw Error("transient resource '", resource.name, "' asks for ", resource.need.bytes, " bytes at alignment ",
                    resource.need.alignment, "; both must be at least 1");
    }
}

/// `last_user` holds, per resource, the last pass that was looked at and uses it.
void reject_repeated_resources(const Description& description, const Pass& pass, std::vector<const Pass*>& last_user) {
    for (size_t i = 0; i < pass.accesses.size(); ++i) {
        const uint32_t resource = pass.accesses[i].resource;
        if (resource >= description.resources.size()) {
            throw Error("pass '", pass.name, "' uses resource ", resource, ", but the frame has ",
                        description.resources.size());
        }
        if (last_user[resource] == &pass) {
            const auto first = std::ranges::find(pass.accesses, resource, &Access::resource);
            throw Error("pass '", pass.name, "' uses '", description.resources[resource].name,
                        "' twice, in its accesses ", first - pass.accesses.begin(), " and ", i);
        }
        last_user[resource] = &pass;
    }
}

void reject_wrong_version(const Resource& resource, const Pass& pass, const Access& access, uint32_t current) {
    const char* verb = reads(access.use) ? "reads" : "replaces";
    if (access.version > current) {
        throw Error("pass '", pass.name, "' ", verb, " version ", access.version, " of '", resource.name,
                    "' before it was written: its current version is ", current);
    }
    if (access.version < current) {
        throw Error("pass '", pass.name, "' ", verb, " version ", access.version, " of '", resource.name,
                    "', which is stale: its current version is ", current);
    }
    if (reads(access.use) && !resource.imported && current == 0) {
        throw Error("pass '", pass.name, "' reads version 0 of transient resource '", resource.name,
                    "', which is undefined: its first written version is 1");
    }
}

void reject_unmade_keeps(const Description& description, const std::vector<uint32_t>& last_versions) {
    for (const Keep& keep : description.kept) {
        if (keep.resource >= description.resources.size()) {
            throw Error("resource ", keep.resource, " is kept, but the frame has ", description.resources.size());
        }
        const Resource& resource = description.resources[keep.resource];
        if (keep.version > last_versions[keep.resource]) {
            throw Error("version ", keep.version, " of '", resource.name, "' is kept, but its last written version is ",
                        last_versions[keep.resource]);
        }
        if (keep.version == 0 && !resource.imported) {
            throw Error("version 0 of transient resource '", resource.name,
                        "' is kept, but it is undefined: its first written version is 1");
        }
    }
}

/// Checks the wiring of all passes, the ones that will be culled too; returns each resource's last version.
std::vector<uint32_t> validate(const Description& description) {
    reject_bad_needs(description);
    std::vector<uint32_t> current(description.resources.size(), 0);
    std::vector<const Pass*> last_user(description.resources.size(), nullptr);
    for (const Pass& pass : description.passes) {
        reject_repeated_resources(description, pass, last_user);
        for (const Access& access : pass.accesses) {
            reject_wrong_version(description.resources[access.resource], pass, access, current[access.resource]);
            if (writes(access.use)) ++current[access.resource];
        }
    }
    reject_unmade_keeps(description, current);
    return current;
}

// ---- culling ----

/// A set of resource versions.
class VersionSet {
  public:
    explicit VersionSet(const std::vector<uint32_t>& last_versions) {
        size_t count = 0;
        for (uint32_t last : last_versions) {
            begin_.push_back(count);
            count += last + 1;
        }
        member_.resize(count);
    }
    void insert(uint32_t resource, uint32_t version) { member_[begin_[resource] + version] = true; }
    bool contains(uint32_t resource, uint32_t version) const { return member_[begin_[resource] + version]; }

  private:
    std::vector<size_t> begin_;  ///< per resource, where its versions begin in member_
    std::vector<bool> member_;
};

/// Sorts the passes into live and culled ones, backwards from what is kept. A pass that only writes needs nothing of
/// the version it replaces, so that version's producer may be culled.
void cull(const Description& description, const std::vector<uint32_t>& last_versions, Plan& plan) {
    VersionSet needed(last_versions);
    for (const Keep& keep : description.kept) needed.insert(keep.resource, keep.version);
    for (uint32_t index = static_cast<uint32_t>(description.passes.size()); index-- > 0;) {
        const std::vector<Access>& accesses = description.passes[index].accesses;
        const bool live = std::ranges::any_of(accesses, [&](const Access& access) {
            return writes(access.use) && needed.contains(access.resource, access.version + 1);
        });
        (live ? plan.order : plan.culled).push_back(index);
        if (!live) continue;
        for (const Access& access : accesses) {
            if (reads(access.use)) needed.insert(access.resource, access.version);
        }
    }
    std::ranges::reverse(plan.order);
    std::ranges::reverse(plan.culled);
}

/// There is one memory per resource: a kept version is lost when a later live pass writes the resource.
void reject_lost_keeps(const Description& description, const Plan& plan) {
    struct LastWrite {
        uint32_t version = 0;
        const Pass* pass = nullptr;
    };
    std::vector<LastWrite> last_writes(description.resources.size());
    for (uint32_t index : plan.order) {
        const Pass& pass = description.passes[index];
        for (const Access& access : pass.accesses) {
            if (writes(access.use)) last_writes[access.resource] = {access.version + 1, &pass};
        }
    }
    for (const Keep& keep : description.kept) {
        const LastWrite& last = last_writes[keep.resource];
        if (last.version == keep.version) continue;
        throw Error("version ", keep.version, " of '", description.resources[keep.resource].name,
                    "' is kept, but pass '", last.pass->name, "' replaces it by version ", last.version);
    }
}

// ---- memory ----

void find_lifetimes(const Description& description, Plan& plan) {
    plan.lifetimes.resize(description.resources.size());
    for (uint32_t position = 0; position < plan.order.size(); ++position) {
        for (const Access& access : description.passes[plan.order[position]].accesses) {
            std::optional<Lifetime>& lifetime = plan.lifetimes[access.resource];
            if (!lifetime) lifetime = Lifetime{position, position};
            lifetime->last = position;
        }
    }
    for (const Keep& keep : description.kept) {
        std::optional<Lifetime>& lifetime = plan.lifetimes[keep.resource];
        if (lifetime) lifetime->last = static_cast<uint32_t>(plan.order.size() - 1);
    }
}

MemoryNeed place(const Description& description, ResourceKind kind, Plan& plan) {
    std::vector<uint32_t> resources;
    std::vector<ArenaRequest> requests;
    for (uint32_t index = 0; index < description.resources.size(); ++index) {
        const Resource& resource = description.resources[index];
        if (resource.imported || resource.kind != kind || !plan.lifetimes[index]) continue;
        resources.push_back(index);
        requests.push_back({resource.need, *plan.lifetimes[index]});
    }
    const ArenaLayout layout = lay_out_arena(requests);
    for (size_t i = 0; i < resources.size(); ++i) plan.placements[resources[i]] = layout.placements[i];
    return layout.total;
}

// ---- barriers ----

/// Walks the live accesses in order and appends the barriers they need.
class BarrierBuilder {
  public:
    BarrierBuilder(const Description& description, Plan& plan)
        : description_(description), plan_(plan), histories_(description.resources.size()) {}

    void build() {
        if (plan_.order.empty()) return;
        plan_.barriers.push_back({0, std::nullopt, kEarlierFrames, {}, false});
        for (uint32_t position = 0; position < plan_.order.size(); ++position) {
            for (const Access& access : description_.passes[plan_.order[position]].accesses) add(position, access);
        }
    }

  private:
    /// What the frame did so far with one resource.
    struct History {
        bool used = false;
        Scope last_write;                     ///< its write accesses only; empty before the first write of the frame
        uint32_t reader_stages = kStageNone;  ///< since the last write
        size_t read_barrier = 0;              ///< what made the last write visible to its readers, once there are some
    };

    void add(uint32_t position, const Access& access) {
        const Scope scope = scope_of(access.use);
        plan_.barriers.front().destination |= scope;
        const bool first = !std::exchange(histories_[access.resource].used, true);
        if (first && !description_.resources[access.resource].imported) add_first_use(position, access.resource, scope);
        if (writes(access.use)) {
            add_write(position, access.resource, scope);
        } else {
            add_read(position, access.resource, scope);
        }
    }

    /// Waits for whoever used the memory earlier in the frame, and gives an image its layout.
    void add_first_use(uint32_t position, uint32_t resource, const Scope& scope) {
        const bool image = description_.resources[resource].kind == ResourceKind::kImage;
        ArenaOccupancy& occupancy = image ? image_occupancy_ : buffer_occupancy_;
        Scope source;
        for (uint32_t other : occupancy.claim(*plan_.placements[resource], resource)) {
            source |= last_accesses(histories_[other]);
        }
        // A layout transition writes the image, so it must come after earlier frames. The boundary's destination has
        // every stage of this frame: a source that names one of them chains onto it. At position 0 the boundary belongs
        // to the same command, which does not chain with itself; there the transition waits for the earlier frames on
        // its own.
        if (image && source.stages == kStageNone) {
            source = position == 0 ? kEarlierFrames : Scope{scope.stages, kAccessNone};
        }
        if (source.stages != kStageNone) plan_.barriers.push_back({position, resource, source, scope, image});
    }

    void add_write(uint32_t position, uint32_t resource, const Scope& scope) {
        History& history = histories_[resource];
        const Scope source = last_accesses(history);
        if (source.stages != kStageNone) plan_.barriers.push_back({position, resource, source, scope, false});
        history.last_write = {scope.stages, scope.accesses & kAllWrites};
        history.reader_stages = kStageNone;
    }

    /// All readers of one written version share the barrier in front of the first of them.
    void add_read(uint32_t position, uint32_t resource, const Scope& scope) {
        History& history = histories_[resource];
        const bool written = history.last_write.stages != kStageNone;
        if (written && history.reader_stages == kStageNone) {
            history.read_barrier = plan_.barriers.size();
            plan_.barriers.push_back({position, resource, history.last_write, {}, false});
        }
        if (written) plan_.barriers[history.read_barrier].destination |= scope;
        history.reader_stages |= scope.stages;
    }

    /// What the next writer of the resource, or of its memory, must wait for. Behind readers no access is named: the
    /// barrier in front of them, or the frame boundary, has made the write before them available.
    static Scope last_accesses(const History& history) {
        if (history.reader_stages != kStageNone) return {history.reader_stages, kAccessNone};
        return history.last_write;
    }

    const Description& description_;
    Plan& plan_;
    std::vector<History> histories_;  ///< per resource
    ArenaOccupancy buffer_occupancy_;
    ArenaOccupancy image_occupancy_;
};

}  // namespace

Plan compile(const Description& description) {
    Plan plan;
    const std::vector<uint32_t> last_versions = validate(description);
    cull(description, last_versions, plan);
    reject_lost_keeps(description, plan);
    find_lifetimes(description, plan);
    plan.placements.resize(description.resources.size());
    plan.buffer_arena = place(description, ResourceKind::kBuffer, plan);
    plan.image_arena = place(description, ResourceKind::kImage, plan);
    BarrierBuilder(description, plan).build();
    return plan;
}

}  // namespace patina::graph
