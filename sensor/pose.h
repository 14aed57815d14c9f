#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "patina/camera.h"
#include "sensor/files/text_file.h"

namespace patina::sensor {

/// The largest rotation_defect that is repaired; beyond it a pose is taken for damaged rather than imprecise.
inline constexpr double kRepairablePoseDefect = 1e-2;

/// A recorded pose made exactly rigid, and how far it was from it.
struct CheckedPose {
    RigidTransform transform{1.0};
    double defect = 0;
};

/// Re-orthonormalises a recorded transform. `where` names its file in messages. Throws Error when an entry is not
/// finite (nothing but infinities mean that tracking was lost) or the transform is too far from rigid.
CheckedPose checked_pose(const RigidTransform& recorded, const std::string& where);

/// A 4 x 4 matrix from its 16 entries, row by row.
RigidTransform matrix_from_rows(std::span<const double> rows);

/// Reads a 4 x 4 matrix, row by row, from a text file of exactly 16 numbers. Throws Error when there are others; inf
/// and nan pass.
RigidTransform read_matrix(const std::filesystem::path& file);

/// The poses of a sequence's frames, from a trajectory in TUM's format, 'timestamp tx ty tz qx qy qz qw'. Each frame
/// has the pose that associate() pairs with its timestamp. Poses are checked when asked for, so that a damaged one
/// concerns its frame only.
class FramePoses {
  public:
    /// No frame has a pose.
    FramePoses() = default;

    /// Reads a trajectory. Throws Error when the file cannot be read, a line has other columns or words that are no
    /// numbers, a timestamp is not finite, or no frame gets a pose.
    FramePoses(const std::filesystem::path& file, std::span<const double> frame_timestamps_s, double limit_s);

    bool empty() const { return lines_.empty(); }

    /// The frame's pose, world_from_camera; empty where it has none. Throws Error, naming file and line, when it is
    /// damaged.
    std::optional<CheckedPose> of_frame(uint32_t frame) const;

  private:
    std::vector<TextLine> lines_;
    std::vector<std::optional<size_t>> line_of_frame_;
};

struct StampedPose {
    double timestamp_s = 0;
    RigidTransform world_from_camera{1.0};
};

/// Writes poses in TUM's format, with as many digits as reading back the same numbers takes.
void write_trajectory(const std::filesystem::path& file, std::span<const StampedPose> poses);

/// All poses of a trajectory in TUM's format, in its order. Throws Error when the file is missing, has no poses or is
/// damaged.
std::vector<StampedPose> read_trajectory(const std::filesystem::path& file);

}  // namespace patina::sensor
