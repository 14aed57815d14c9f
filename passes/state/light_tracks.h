#pragma once

#include "engine/graph/frame_graph.h"
#include "engine/vulkan/device.h"

namespace patina {

/// Versions of the tracks' buffers within one frame.
struct LightTrackIds {
    graph::BufferId tracks;   ///< gpu::LightTrack[kMaxLights]; sightings 0 ends the list
    graph::BufferId history;  ///< gpu::LightSighting[kMaxLights][kMaxSightings], each light's a ring
};

/// Lamps seen so far in a lighting sequence, with what each of the last frames said of them.
class LightTracks {
  public:
    /// Throws Error when memory runs out.
    explicit LightTracks(vulkan::Device& device);

    /// Forgets all lamps; the first thing done with it.
    void reset(graph::FrameGraph& frame) const;

    LightTrackIds import(graph::FrameGraph& frame) const;
    static void keep(graph::FrameGraph& frame, const LightTrackIds& ids);

  private:
    vulkan::BufferRef tracks_, history_;
};

}  // namespace patina
