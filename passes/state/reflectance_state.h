#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "engine/graph/frame_graph.h"
#include "engine/graph/state_visitor.h"
#include "engine/vulkan/device.h"
#include "passes/state/observation_map.h"
#include "shared/reflectance/far_field.h"
#include "shared/reflectance/reflectance.h"
#include "shared/reflectance/surroundings.h"

namespace patina {

/// Versions of the state's buffers within one frame.
struct ReflectanceStateIds {
    graph::BufferId status;        ///< gpu::RecordStatus per record
    graph::BufferId gathered;      ///< gpu::RecordSurroundings per record
    graph::BufferId windows;       ///< gpu::RefreshWindow[gpu::kWindows]
    graph::BufferId surroundings;  ///< gpu::FarFieldTexel[gpu::kFarFieldTexels],
                                   ///< gpu::OpeningTexel[gpu::kOpeningTexels], gpu::SurroundingsCounts, two
                                   ///< gpu::Occupancy, of the cells and of the map's blocks, and
                                   ///< gpu::SurroundingsCell[gpu::kSurroundingsCells]
};

// Where parts of ReflectanceStateIds::surroundings begin, bytes.
constexpr uint64_t kOpeningsAt = gpu::kFarFieldTexels * sizeof(gpu::FarFieldTexel);
constexpr uint64_t kSurroundingsCountsAt = kOpeningsAt + gpu::kOpeningTexels * sizeof(gpu::OpeningTexel);
constexpr uint64_t kCellsInUseAt = kSurroundingsCountsAt + sizeof(gpu::SurroundingsCounts);
constexpr uint64_t kBlocksInUseAt = kCellsInUseAt + sizeof(gpu::Occupancy);
constexpr uint64_t kSurroundingsCellsAt = kBlocksInUseAt + sizeof(gpu::Occupancy);
constexpr uint64_t kSurroundingsBytes = kSurroundingsCellsAt + gpu::kSurroundingsCells * sizeof(gpu::SurroundingsCell);

/// What the visibility and the albedo of an observation map's records were computed from, which of them have their turn
/// next, the light that reaches them from what is around, and the albedo of the surface around, 56 bytes a record; and
/// light from far away. Lives as long as the map.
class ReflectanceState {
  public:
    /// Throws Error when memory runs out.
    ReflectanceState(vulkan::Device& device, const ObservationMap& map);

    /// Nothing is up to date; the first thing done with it, and whenever the map is reset. What surroundings were taken
    /// from frames of low exposure stays.
    void reset(graph::FrameGraph& frame);

    /// The surroundings, empty before the first frame of low exposure; they outlive the frame.
    graph::BufferId import_surroundings(graph::FrameGraph& frame);

    /// Replaces what is around by what arrives from far away alone: radiance per gpu::FarFieldTexel, or nothing, with
    /// which no direction is known. Keep it.
    static void replace_surroundings(graph::FrameGraph& frame, ReflectanceStateIds& ids,
                                     std::span<const glm::vec3> far_field);

    /// Announces that the map's pool grows to `records`; nothing is up to date of the new ones.
    void enlarge(graph::Enlargement& enlargement, uint32_t records);

    ReflectanceStateIds import(graph::FrameGraph& frame) const;
    static void keep(graph::FrameGraph& frame, const ReflectanceStateIds& ids);

    void visit(graph::StateVisitor& visitor);

    /// Counts updates; the first is 1.
    uint32_t next_stamp() { return ++stamp_; }

  private:
    vulkan::BufferRef status_, gathered_, windows_, surroundings_;
    uint32_t stamp_ = 0;
    bool has_low_exposure_ = false;
};

}  // namespace patina
