#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/source.h"

namespace patina::sensor {

/// Finds out whether poses follow another convention than camera-to-world with axes x right, y down, z forward: moves
/// depth readings from frame to frame by the poses, and by what they would be if they were inverted or axes were turned
/// over, and counts which of these agree with what the other frame measured.
class PoseConventionCheck {
  public:
    explicit PoseConventionCheck(const SequenceInfo& info);

    /// Frames without a pose are left out.
    void add(const Frame& frame);

    /// One sentence when another convention explains the depth clearly better: what looks wrong, and what to do.
    std::optional<std::string> complaint() const;

  private:
    /// Any of the three axes turned over or not, poses inverted or not.
    static constexpr size_t kConventions = 16;

    struct Kept {
        RigidTransform world_from_camera{1.0};
        std::vector<glm::dvec3> points_m;  ///< readings, in camera coordinates
        double mean_depth_m = 0;
    };

    std::optional<Kept> kept_of(const Frame& frame) const;
    void compare(const Kept& from, const Kept& to);
    /// What the frame that is compared with measured where a point should be.
    enum class Measured { kAgrees, kDisagrees, kNothing };
    Measured measured_at(glm::dvec3 point_m) const;
    void remember_depth(const Frame& frame);

    SequenceInfo info_;
    std::optional<Kept> last_;
    Image<float> depth_m_;  ///< of the frame that is compared with; 0: no reading
    uint32_t pairs_ = 0;
    struct Count {
        size_t agreeing = 0, comparable = 0;  ///< points; where nothing was measured they are left out
        double share() const {
            return comparable > 0 ? static_cast<double>(agreeing) / static_cast<double>(comparable) : 0;
        }
    };
    std::array<Count, kConventions> counts_{};
};

}  // namespace patina::sensor
