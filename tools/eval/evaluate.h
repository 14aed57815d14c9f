#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "sensor/pose.h"
#include "tools/eval/result.h"

namespace patina::eval {

struct Settings {
    /// Pixels::kSeen are those whose surface had been seen in this many frames of the sequence by then; 1: every pixel
    /// that has truth, for which nothing of the sequence is needed but that.
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

/// Measures pictures NNNNNN.exr, with the channels of a run's frames, against those frames of a sequence's truth that
/// have their numbers. `truth_from_run` turns the pictures' normals into truth's world. Throws Error as evaluate().
Views evaluate_views(const std::filesystem::path& sequence, const std::filesystem::path& pictures,
                     const glm::dmat3& truth_from_run = glm::dmat3(1));

/// truth_from_run of the worlds, by the poses that both have; the identity where one has none. Throws Error for a
/// trajectory that cannot be read.
RigidTransform world_of_run(const std::filesystem::path& sequence, const std::filesystem::path& run);

}  // namespace patina::eval
