#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "patina/source.h"
#include "reconstruction/pipeline.h"

namespace patina {

/// What the frames of a sequence without poses are found by.
struct LocaliseOptions {
    ReconstructionSettings settings;  ///< of the main sequence's reconstruction; only its geometry is used
    uint32_t frames = 0;              ///< at most so many of the main sequence; 0 takes all
    bool track = false;               ///< the main sequence's poses too, where it has some
    std::function<void(const char* what, uint32_t done, uint32_t total)> on_frame{};  ///< may throw; may be empty
};

/// The poses of a sequence's frames, by index, world_from_depth; empty for frames that were not found.
using FoundPoses = std::vector<std::optional<RigidTransform>>;

/// Finds where the frames of `sequence`, which has no poses, were taken in the world of `main`, a recording of the same
/// room: fuses the main sequence's geometry with keyframes, relocalises the sequence's frames against these by their
/// depth (their exposure may be any), and tracks from there on, forwards and then backwards. Frames that are found are
/// fused too, so that the camera may go on to what the main sequence does not show. Holds the sequence's depth pictures
/// in memory. Throws Error when no frame of `main` can be used, or none of `sequence` is found.
FoundPoses localise(vulkan::Device& device, Source& main, Source& sequence, const LocaliseOptions& options);

}  // namespace patina
