#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "tools/eval/result.h"

namespace patina::eval {

struct Settings {
    /// Materials and colours are compared where the surface had been seen in this many frames of the sequence by then;
    /// 1 takes every pixel that has truth, and needs nothing of the sequence but that.
    uint32_t seen_frames = 5;
    double light_radius_m = 0.5;  ///< a light of the run farther from a true one does not stand for it
    std::function<void(size_t done, size_t total)> on_frame = {};  ///< called after each frame; may be empty
};

/// Measures the run in folder `run` against the truth of the sequence in folder `sequence`, as docs/guide/evaluation.md
/// defines it. Frames are read one by one. Throws Error when the sequence has no truth/frames, the run no frames, the
/// two no frame in common, extents or channels disagree, a file is damaged, or the frames that saw a surface are to be
/// counted and SeenPixels cannot be made.
Evaluation evaluate(const std::filesystem::path& sequence, const std::filesystem::path& run,
                    const Settings& settings = {});

}  // namespace patina::eval
