#include "passes/state/light_tracks.h"

#include "shared/lighting/find_lights.h"

namespace patina {

LightTracks::LightTracks(vulkan::Device& device)
    : tracks_(device.create_buffer({.name = "light tracks", .bytes = gpu::kMaxLights * sizeof(gpu::LightTrack)})),
      history_(device.create_buffer(
          {.name = "light sightings", .bytes = gpu::kMaxLights * gpu::kMaxSightings * sizeof(gpu::LightSighting)})) {}

void LightTracks::reset(graph::FrameGraph& frame) const {
    LightTrackIds ids = import(frame);
    ids.tracks = frame.fill(ids.tracks, 0);
    ids.history = frame.fill(ids.history, 0);
    keep(frame, ids);
}

LightTrackIds LightTracks::import(graph::FrameGraph& frame) const {
    return {frame.import(tracks_), frame.import(history_)};
}

void LightTracks::keep(graph::FrameGraph& frame, const LightTrackIds& ids) {
    frame.keep(ids.tracks);
    frame.keep(ids.history);
}

}  // namespace patina
