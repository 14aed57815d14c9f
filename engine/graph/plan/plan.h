#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/graph/plan/description.h"

namespace patina::graph {

/// Pipeline stages as a bit set.
enum StageBits : uint32_t { kStageNone = 0, kStageCompute = 1, kStageTransfer = 2, kStageIndirect = 4 };

/// Memory accesses as a bit set. Each access bit belongs to the stages that can perform it.
enum AccessBits : uint32_t {
    kAccessNone = 0,
    kAccessStorageRead = 1,
    kAccessStorageWrite = 2,
    kAccessSampledRead = 4,
    kAccessUniformRead = 8,
    kAccessIndirectRead = 16,
    kAccessTransferRead = 32,
    kAccessTransferWrite = 64,
};

constexpr uint32_t kAllWrites = kAccessStorageWrite | kAccessTransferWrite;

/// Stages and accesses on one side of a barrier.
struct Scope {
    uint32_t stages = kStageNone;
    uint32_t accesses = kAccessNone;

    bool operator==(const Scope&) const = default;
};

/// The scope in which a pass performs `use`.
Scope scope_of(Use use);

/// One dependency, recorded directly before the pass at position `before` of Plan::order. It orders every earlier
/// command in `source` before every later one in `destination`, for one resource's memory, or for all memory where
/// `resource` is empty (the frame boundary). Barriers with the same `before` are one command: none of them relies on
/// another.
struct Barrier {
    uint32_t before = 0;               ///< position in Plan::order
    std::optional<uint32_t> resource;  ///< index into Description::resources
    Scope source;
    Scope destination;
    bool discard = false;  ///< image only: its content becomes undefined and its layout the general one

    bool operator==(const Barrier&) const = default;
};

/// Positions in Plan::order of a resource's first and last use; a kept resource lives to the last position.
struct Lifetime {
    uint32_t first = 0;
    uint32_t last = 0;

    bool operator==(const Lifetime&) const = default;
};

/// Where a transient resource lies in its arena. Buffers and images have an arena each.
struct Placement {
    uint64_t offset = 0;
    uint64_t bytes = 0;

    bool operator==(const Placement&) const = default;
};

/// What compile() derives from a description; plain data.
struct Plan {
    std::vector<uint32_t> order;                       ///< indices of live passes in execution order
    std::vector<uint32_t> culled;                      ///< indices of passes that feed nothing kept
    std::vector<std::optional<Lifetime>> lifetimes;    ///< per resource; empty where no live pass uses it
    std::vector<std::optional<Placement>> placements;  ///< per resource; transient and used ones only
    std::vector<Barrier> barriers;                     ///< sorted by `before`
    MemoryNeed buffer_arena;
    MemoryNeed image_arena;

    bool operator==(const Plan&) const = default;
};

/// Culls passes that feed nothing kept, keeps the declared order of the others (versions make it a valid one), finds
/// lifetimes, lets transient resources whose lifetimes do not overlap share memory, and derives the barriers: one at
/// the frame's start that orders it behind everything submitted before, and no more than needed for each read after
/// write, write after read, write after write, reuse of memory, and first use of a transient image. All images stay in
/// the general layout. Pure: no Vulkan call, same description, same plan. Throws Error on a version read before it was
/// written, a version written twice (a stale id), a read of an undefined transient, two accesses of one resource in one
/// pass, a transient that asks for no memory, and a kept version that no pass made or that a later live pass replaces.
Plan compile(const Description& description);

/// A pair of accesses that a plan leaves unordered or an image whose layout it leaves undefined, as one sentence naming
/// both passes and the resource; empty where the plan is right. Takes descriptions that compile() accepts. Shares no
/// code with compile(): it simulates the plan's barriers against the description's accesses, including those of memory
/// shared by aliasing and those of the frame before.
std::vector<std::string> check(const Description& description, const Plan& plan);

/// The frame as a Graphviz digraph: passes, versioned resources, culled passes dashed, barriers on their edges.
std::string to_dot(const Description& description, const Plan& plan);

/// The frame as JSON: passes with accesses, order, culled, lifetimes, placements, barriers, arena sizes.
std::string to_json(const Description& description, const Plan& plan);

}  // namespace patina::graph
