#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/graph/enlargement.h"
#include "engine/graph/runner.h"
#include "passes/state/pool_demand.h"
#include "reconstruction/stages/reflectance_stage.h"
#include "reconstruction/stages/segmentation_stage.h"
#include "reconstruction/stages/specular_stage.h"

namespace patina {

/// What keeps a pool from growing further.
enum class PoolLimit : uint8_t {
    kNone,
    kSetting,  ///< the limit in the settings
    kBuffers,  ///< what shaders can address through the buffers that the device binds
    kMemory,   ///< the device's memory, or the part of it that may be used
};

/// A pool as the host knows it.
struct PoolState {
    const char* name;     ///< of what it holds, in the plural: "voxel blocks"
    const char* setting;  ///< the key of its limit
    uint32_t capacity = 0, used = 0;
    uint32_t refused = 0;  ///< requests that found it full and did not come again after a growth; one that is refused
                           ///< again after a removal counts again
    uint32_t growths = 0;
    PoolLimit limit = PoolLimit::kNone;  ///< what the last attempt to grow met

    /// Whether something is missing in the model because the pool had no room for it.
    bool is_full() const { return refused > 0; }
};

/// The pools' counters after a frame, as they arrive.
struct PoolReadbacks {
    graph::Readback voxels{};                               ///< gpu::MapCounters
    graph::Readback observed_blocks{}, observed_records{};  ///< gpu::MapCounters, with reflectance
    graph::Readback labels{};                               ///< gpu::SegmentCounters, with segmentation
};

/// Places that are taken besides with a frame, by what comes back to the device.
struct ComingPlaces {
    uint32_t voxel_blocks = 0, observed_blocks = 0, observed_records = 0;
};

/// How much stays on the device while there is much; 0: all. Beyond it, pools grow by small steps, as what is far away
/// leaves then.
struct ResidentPlaces {
    uint32_t voxel_blocks = 0, observed_records = 0;
};

/// Lets the pools of a reconstruction grow between frames. What is decided before frame n follows from the counters of
/// frame n - 2 (before the first frames: of frame 0), so that every run decides alike, whenever the device answers.
class GrowingPools {
  public:
    /// All but the map may be null. All must outlive this.
    GrowingPools(vulkan::Device& device, VoxelMap& map, SegmentationStage* segmentation, ReflectanceStage* reflectance,
                 SpecularStage* specular, ResidentPlaces resident);

    /// Nothing was asked for yet; whenever the map is reset.
    void reset();

    /// Takes note of what a frame's counters will be; frames are numbered from 0, each once, in order.
    void await(uint32_t index, const PoolReadbacks& counters);

    /// Enlarges what is short for frame `index`, in a frame of its own, and returns true; or returns false where
    /// nothing is short or nothing can be had. Waits for frame `index` - 2. Throws as Runner::submit() does; then the
    /// pools are as before. `coming`: with that frame.
    bool grow(graph::Runner& runner, uint32_t index, ComingPlaces coming = {});

    /// Before frame `index`: whether more are in use than should stay, or their pools cannot grow. Frame `index` - 2
    /// must have finished.
    bool has_many_blocks(uint32_t index);
    bool has_many_records(uint32_t index);

    /// Whether frame 0 found a pool full that can grow. It must have finished.
    bool first_was_refused();

    /// The device must have finished.
    void visit(graph::StateVisitor& visitor);

    /// As of the last frame that finished.
    std::vector<PoolState> states() const;

  private:
    struct Pool {
        PoolState state;
        uint32_t limit_setting = 0;  ///< 0: none
        PoolDemand demand{};
        uint32_t grown_at = 0;  ///< the frame before which it grew last: what was refused before came again
        uint32_t try_at = 0;    ///< the frame from which on memory may be asked for
        uint32_t came_again = 0;
        /// Places that are taken besides with the frame that it may grow for, and were with the two before it, whose
        /// counters are not known yet.
        std::array<uint32_t, 1 + PoolDemand::kFramesAhead> coming{};
        std::function<uint32_t()> capacity{};
        std::function<uint32_t()> most{};  ///< that it may grow to
        std::function<uint32_t()> step{};  ///< by which it grows at most, unless more is asked for
        std::function<void(graph::Enlargement&, uint32_t)> enlarge{};
        uint64_t reserve = 0;  ///< bytes a place that other work will take in the end
        std::function<void(graph::FrameGraph&, uint32_t)> add_grow{};  ///< with the capacity before
        std::function<void(graph::FrameGraph&)> keep{};  ///< all that add_grow wrote, in the versions it has by now
        std::function<PoolCount(const PoolReadbacks&)> count{};
    };
    /// A frame whose counters no decision has followed from yet.
    struct Pending {
        uint32_t frame = 0;
        PoolReadbacks counters{};
        std::vector<PoolCount> counts{};  ///< by pool; empty until they are taken from the counters

        bool ready() const { return !counts.empty() || counters.voxels.ready(); }
    };

    void add_voxel_pool(VoxelMap& map, SegmentationStage* segmentation);
    void add_observation_pools(ReflectanceStage& reflectance);
    void add_label_pool(SegmentationStage& segmentation, ReflectanceStage* reflectance, SpecularStage* specular);
    /// The counts of a frame that is ready, by pool.
    std::vector<PoolCount> counts_of(const Pending& pending) const;
    static void note(Pool& pool, uint32_t frame, const PoolCount& count);
    void note_until(uint32_t frame);
    void note_before(uint32_t index);
    std::optional<graph::Enlargement> grow(graph::FrameGraph& frame, Pool& pool, uint32_t index);
    std::optional<graph::Enlargement> try_capacity(graph::FrameGraph& frame, const Pool& pool, uint32_t capacity);

    /// Whether more are in use than should stay, or the pool cannot grow.
    static bool has_many(const Pool& pool, uint32_t resident);

    vulkan::Device& device_;
    ResidentPlaces resident_;
    std::vector<Pool> pools_;  ///< voxel blocks first; then, with reflectance, observed blocks and observed voxels
    std::deque<Pending> pending_;
};

}  // namespace patina
