#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/vulkan/device.h"
#include "patina/source.h"

namespace patina::bench {

/// Which frames to measure on.
struct RecordingOptions {
    std::string sequence;            ///< folder of a sequence, or synthetic:SCENE
    std::string format;              ///< see cameras::open_sequence
    std::optional<Extent2D> extent;  ///< of colour and depth; empty keeps what was recorded
    uint32_t frames = 0;             ///< usable ones, from the first on
};

/// Decoded frames in memory, so that reading files does not disturb what is measured. All have poses.
struct Recording {
    SequenceInfo info;
    std::vector<Frame> frames;

    uint64_t bytes() const;  ///< of the pictures
};

/// Loads the first `options.frames` usable frames; synthetic ones are rendered, and a camera's raw ones decoded,
/// on a device of their own, closed before this returns. Throws Error where the sequence has fewer, or no poses.
Recording load(const RecordingOptions& options, const vulkan::DeviceOptions& device);

/// Writes the frames for other programs: depth_m.f32 and, for 8-bit colour, color.u8 with all pictures one after the
/// other, row by row, and recording.json with sizes, intrinsics and poses (row-major). Throws Error where that fails.
void dump(const Recording& recording, const std::filesystem::path& folder);

}  // namespace patina::bench
