#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <glm/glm.hpp>

#include "patina/camera.h"
#include "patina/image.h"

namespace patina::eval {

/// What a depth camera saw in one frame.
struct DepthView {
    Image<float> depth_m;  ///< along the camera's z axis; 0 where there is no reading
    Intrinsics camera;
    RigidTransform world_from_camera{1.0};
};

/// In how many frames surface points were seen. Points are pooled in cells of kCell_m, each represented by the first
/// point in it; a frame sees a cell when that point, projected into the depth picture, lies between the readings
/// around it, kTolerance_m before the nearest or behind the farthest at most. So a frame counts once, and a surface at
/// a grazing angle has no gaps, however far apart its readings are.
class SeenSurface {
  public:
    static constexpr double kCell_m = 0.02;
    static constexpr double kTolerance_m = 0.02;  ///< for the camera's noise, and the cell's extent

    /// A surface is seen once this many frames, at least 1, have seen it.
    explicit SeenSurface(uint32_t least_frames) : least_frames_(least_frames) {}

    /// Adds a point in the world (m), before any frame is counted.
    void add(glm::dvec3 point_m);

    /// Counts a frame. Frames come in rising order.
    void count(uint32_t frame, const DepthView& view);

    /// True where the surface at a point that was added has been seen in enough frames up to and including this one.
    bool is_seen(glm::dvec3 point_m, uint32_t frame) const;

  private:
    struct Cell {
        glm::dvec3 point_m;
        uint32_t frames = 0;
        uint32_t seen_since = kNever;
    };
    static constexpr uint32_t kNever = ~0u;

    uint32_t least_frames_;
    std::unordered_map<uint64_t, uint32_t> index_of_;  ///< into cells_
    std::vector<Cell> cells_;
    std::vector<uint32_t> unseen_;  ///< the cells that have not been seen often enough yet
};

}  // namespace patina::eval
