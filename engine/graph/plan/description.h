#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace patina::graph {

/// How a pass touches a resource. Stages, access masks and image layouts follow from it.
enum class Use : uint8_t {
    kStorageRead,       ///< readonly storage buffer or image, compute stage
    kStorageWrite,      ///< writeonly storage buffer or image, compute stage: earlier content is not needed
    kStorageReadWrite,  ///< storage buffer or image, compute stage; also writes that leave part of the earlier content
    kSampled,           ///< sampled image or uniform texel buffer, compute stage
    kUniform,           ///< uniform buffer, compute stage
    kIndirect,          ///< dispatch arguments
    kTransferRead,      ///< source of a copy
    kTransferWrite,     ///< destination of a fill, or of a copy over the whole resource
    kTransferModify,    ///< destination of a copy over a part of the resource
};

constexpr bool reads(Use use) { return use != Use::kStorageWrite && use != Use::kTransferWrite; }
constexpr bool writes(Use use) {
    return use == Use::kStorageWrite || use == Use::kStorageReadWrite || use == Use::kTransferWrite ||
           use == Use::kTransferModify;
}

/// Device memory that a transient resource asks for.
struct MemoryNeed {
    uint64_t bytes = 0;
    uint64_t alignment = 1;

    bool operator==(const MemoryNeed&) const = default;
};

enum class ResourceKind : uint8_t { kBuffer, kImage };

/// One resource of a frame. A transient one exists from its first to its last use within the frame and holds undefined
/// content before its first write; an imported one outlives the frame.
struct Resource {
    std::string name;
    ResourceKind kind = ResourceKind::kBuffer;
    bool imported = false;
    MemoryNeed need;  ///< transient resources only

    bool operator==(const Resource&) const = default;
};

/// One access of a pass. Version 0 of an imported resource is what it held before the frame; version 0 of a transient
/// one is undefined and cannot be read. Every write makes the next version.
struct Access {
    uint32_t resource = 0;  ///< index into Description::resources
    uint32_t version = 0;   ///< the version that the pass reads, or that it replaces when it only writes
    Use use = Use::kStorageRead;

    bool operator==(const Access&) const = default;
};

/// One pass in declared order. A resource appears once in a pass's accesses.
struct Pass {
    std::string name;
    std::vector<Access> accesses;

    bool operator==(const Pass&) const = default;
};

/// A resource version that must exist when the frame ends; what it needs is not culled.
struct Keep {
    uint32_t resource = 0;
    uint32_t version = 0;

    bool operator==(const Keep&) const = default;
};

/// A frame as declared: everything compile() needs and nothing of Vulkan. Two equal descriptions compile to equal
/// plans.
struct Description {
    std::vector<Resource> resources;
    std::vector<Pass> passes;
    std::vector<Keep> kept;

    bool operator==(const Description&) const = default;
};

}  // namespace patina::graph
