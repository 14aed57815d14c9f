#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "sensor/pose.h"
#include "tools/eval/exr_planes.h"
#include "tools/eval/seen_surface.h"

namespace patina::eval {

/// Tells the pixels of a sequence's true frames whose surface its depth camera had seen in enough frames by then. Knows
/// the sequence and its truth alone, nothing of a run.
class SeenPixels {
  public:
    /// Reads the frames of truth/frames named in `truth_frames` (files by index, at least one), and the sequence's
    /// depth pictures and true poses up to the last of them. Frames that cannot be used see nothing. Throws Error when
    /// the sequence cannot be read, has no true trajectory, or a true frame is damaged or not as large as its colour.
    SeenPixels(const std::filesystem::path& sequence, const std::map<uint32_t, std::filesystem::path>& truth_frames,
               uint32_t least_frames);

    /// 1 where a frame of those named has truth, and its surface was seen in at least `least_frames` frames up to and
    /// including this one; else 0.
    Image<uint8_t> mask(uint32_t frame, const ExrPlanes& truth) const;

  private:
    template <class Visit>
    void visit_surface(uint32_t frame, const ExrPlanes& truth, Visit visit) const;

    std::string trajectory_file_;
    std::vector<sensor::StampedPose> poses_;  ///< of the depth camera, one per frame of the sequence
    Intrinsics color_;
    RigidTransform depth_from_color_{1.0};
    SeenSurface surface_;
};

}  // namespace patina::eval
