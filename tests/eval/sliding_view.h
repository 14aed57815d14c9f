#pragma once

#include <cstdint>
#include <filesystem>

#include "patina/frame.h"
#include "tests/eval/eval_rig.h"
#include "tools/eval/seen_surface.h"

namespace patina::test {

/// A camera that slides along a wall, two pixels a frame to the right, whose pixels are farther apart on the wall than
/// SeenSurface's cells: what pixel (x, y) of frame i shows was kStep k columns further right in frame i - k.
struct SlidingView {
    static constexpr Extent2D kExtent{48, 40};
    static constexpr float kWall_m = 2;
    static constexpr double kPixel_m = 0.05;  ///< between two pixels' points on the wall
    static constexpr uint32_t kStep = 2;      ///< pixels from frame to frame

    static Intrinsics camera() { return {kExtent, kWall_m / kPixel_m, kWall_m / kPixel_m, 23.5, 19.5, {}}; }
    static RigidTransform world_from_camera(uint32_t frame);

    /// The wall alone.
    static eval::DepthView view(uint32_t frame);

    /// The point on the wall that a pixel of a frame shows (world, m).
    static glm::dvec3 point(uint32_t x, uint32_t y, uint32_t frame);
};

/// SlidingView as a sequence of 12 frames of which every fourth is in truth/frames, and a run that repeats the truth.
/// The colour camera sits one pixel's width to the right of the depth camera, so that its pixel x shows what depth's
/// pixel x + 1 reads. The wall is object 1.
class SlidingRig {
  public:
    static constexpr uint32_t kFrames = 12;
    static constexpr uint32_t kEvery = 4;

    SlidingRig();

    std::filesystem::path sequence() const { return folder_ / "sequence"; }
    std::filesystem::path run() const { return folder_ / "run"; }
    static std::filesystem::path frame_file(const std::filesystem::path& folder, uint32_t index);
    static EvalFrame frame();

  private:
    TemporaryFolder folder_;
};

}  // namespace patina::test
