#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "engine/graph/plan/plan.h"

namespace patina::graph {

/// Describes frames for tests; keeps each resource's current version, so that well-wired frames read like a list of
/// uses.
class FrameBuilder {
  public:
    uint32_t import(const std::string& name, ResourceKind kind = ResourceKind::kBuffer) {
        return add({name, kind, true, {}});
    }
    uint32_t buffer(const std::string& name, uint64_t bytes, uint64_t alignment = 1) {
        return add({name, ResourceKind::kBuffer, false, {bytes, alignment}});
    }
    uint32_t image(const std::string& name, uint64_t bytes, uint64_t alignment = 1) {
        return add({name, ResourceKind::kImage, false, {bytes, alignment}});
    }

    /// Adds a pass that uses the current version of each resource.
    FrameBuilder& pass(const std::string& name, const std::vector<std::pair<uint32_t, Use>>& uses) {
        Pass pass{name, {}};
        for (const auto& [resource, use] : uses) pass.accesses.push_back({resource, versions_[resource], use});
        description_.passes.push_back(pass);
        for (const auto& [resource, use] : uses) versions_[resource] += writes(use) ? 1 : 0;
        return *this;
    }

    /// Keeps the current version.
    FrameBuilder& keep(uint32_t resource) {
        description_.kept.push_back({resource, versions_[resource]});
        return *this;
    }

    uint32_t version(uint32_t resource) const { return versions_[resource]; }
    const Description& description() const { return description_; }

  private:
    uint32_t add(const Resource& resource) {
        description_.resources.push_back(resource);
        versions_.push_back(0);
        return static_cast<uint32_t>(versions_.size() - 1);
    }

    Description description_;
    std::vector<uint32_t> versions_;
};

inline constexpr Scope kEarlierFrames{kStageCompute | kStageTransfer | kStageIndirect,
                                      kAccessStorageWrite | kAccessTransferWrite};
inline constexpr Scope kComputeStage{kStageCompute, kAccessNone};
inline constexpr Scope kTransferStage{kStageTransfer, kAccessNone};
inline constexpr Scope kStorageReads{kStageCompute, kAccessStorageRead};
inline constexpr Scope kStorageWrites{kStageCompute, kAccessStorageWrite};
inline constexpr Scope kStorageReadWrites{kStageCompute, kAccessStorageRead | kAccessStorageWrite};
inline constexpr Scope kSampledReads{kStageCompute, kAccessSampledRead};
inline constexpr Scope kIndirectReads{kStageIndirect, kAccessIndirectRead};
inline constexpr Scope kTransferReads{kStageTransfer, kAccessTransferRead};
inline constexpr Scope kTransferWrites{kStageTransfer, kAccessTransferWrite};

constexpr Scope operator|(const Scope& a, const Scope& b) { return {a.stages | b.stages, a.accesses | b.accesses}; }

}  // namespace patina::graph
