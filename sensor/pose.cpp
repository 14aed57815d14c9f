#include "sensor/pose.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "engine/core/error.h"
#include "sensor/associate.h"

namespace patina::sensor {
namespace {

constexpr const char* kTrajectoryColumns = "timestamp tx ty tz qx qy qz qw";

bool all_infinite(const RigidTransform& matrix) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isinf(matrix[column][row])) return false;
        }
    }
    return true;
}

void expect_finite(const RigidTransform& matrix, const std::string& where) {
    if (all_infinite(matrix)) throw Error(where, ": tracking was lost, every entry of the pose is infinite");
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            const double value = matrix[column][row];
            if (!std::isfinite(value)) {
                throw Error(where, ": row ", row + 1, ", column ", column + 1, " of the pose is ", value,
                            ", must be finite");
            }
        }
    }
}

[[noreturn]] void fail_not_rigid(const std::string& where, double defect) {
    throw Error(where, ": the pose is not rigid, its rotation is off by ", defect, ", at most ", kRepairablePoseDefect,
                " is accepted");
}

/// The pose in a line of a trajectory.
CheckedPose pose_in(const TextLine& line) {
    const auto infinite = [&](size_t column) { return std::isinf(line.number(column)); };
    if (infinite(1) && infinite(2) && infinite(3))
        throw Error(line.where(), ": tracking was lost, the position is infinite");
    const glm::dvec3 position(line.finite(1), line.finite(2), line.finite(3));
    const glm::dquat rotation(line.finite(7), line.finite(4), line.finite(5), line.finite(6));
    const double defect = std::abs(glm::dot(rotation, rotation) - 1);
    if (defect > kRepairablePoseDefect) fail_not_rigid(line.where(), defect);
    RigidTransform transform(glm::mat3_cast(glm::normalize(rotation)));
    transform[3] = glm::dvec4(position, 1.0);
    return {transform, defect};
}

}  // namespace

CheckedPose checked_pose(const RigidTransform& recorded, const std::string& where) {
    expect_finite(recorded, where);
    const double defect = rotation_defect(recorded);
    if (glm::determinant(glm::dmat3(recorded)) < 0)
        throw Error(
            where,
            ": the pose mirrors what it moves, as poses of a left-handed world or camera do; a rotation is needed");
    if (defect > kRepairablePoseDefect) fail_not_rigid(where, defect);
    for (int column = 0; column < 4; ++column) {
        const double expected = column == 3 ? 1 : 0;
        const double value = recorded[column][3];
        if (std::abs(value - expected) > kRepairablePoseDefect) {
            throw Error(where, ": row 4, column ", column + 1, " of the pose is ", value, ", must be ", expected);
        }
    }
    return {orthonormalised(recorded), defect};
}

RigidTransform read_matrix(const std::filesystem::path& file) { return matrix_from_rows(read_numbers(file, 16)); }

RigidTransform matrix_from_rows(std::span<const double> rows) {
    PATINA_ASSERT(rows.size() == 16, "numbers ", rows.size());
    RigidTransform matrix(1.0);
    for (int i = 0; i < 16; ++i) matrix[i % 4][i / 4] = rows[static_cast<size_t>(i)];
    return matrix;
}

FramePoses::FramePoses(const std::filesystem::path& file, std::span<const double> frame_timestamps_s, double limit_s)
    : lines_(read_lines(file)) {
    std::vector<double> timestamps_s;
    for (const TextLine& line : lines_) {
        line.expect_columns(kTrajectoryColumns);
        timestamps_s.push_back(line.finite(0));
        for (size_t column = 1; column < line.size(); ++column) line.number(column);
    }
    line_of_frame_ = associate(frame_timestamps_s, timestamps_s, limit_s);
    if (std::none_of(line_of_frame_.begin(), line_of_frame_.end(), [](auto line) { return line.has_value(); })) {
        throw Error(file.string(), " has ", lines_.size(), " poses, but none lies within ", limit_s,
                    " s of one of the ", frame_timestamps_s.size(), " frames' timestamps");
    }
}

std::optional<CheckedPose> FramePoses::of_frame(uint32_t frame) const {
    if (empty() || !line_of_frame_.at(frame)) return std::nullopt;
    return pose_in(lines_[*line_of_frame_[frame]]);
}

void write_trajectory(const std::filesystem::path& file, std::span<const StampedPose> poses) {
    std::string content = std::string("# ") + kTrajectoryColumns + "\n";
    for (const auto& [timestamp_s, world_from_camera] : poses) {
        const glm::dquat q = glm::quat_cast(glm::dmat3(world_from_camera));
        const glm::dvec4 t = world_from_camera[3];
        content += shortest(timestamp_s);
        for (const double value : {t.x, t.y, t.z, q.x, q.y, q.z, q.w}) content += " " + shortest(value);
        content += "\n";
    }
    write_bytes(file, content);
}

std::vector<StampedPose> read_trajectory(const std::filesystem::path& file) {
    std::vector<double> timestamps_s;
    for (const TextLine& line : read_lines(file)) timestamps_s.push_back(line.finite(0));
    if (timestamps_s.empty()) throw Error(file.string(), " has no poses");
    const FramePoses poses(file, timestamps_s, 0);
    std::vector<StampedPose> trajectory;
    // Its own timestamps being the frames', every frame has a pose.
    for (uint32_t i = 0; i < timestamps_s.size(); ++i) {
        trajectory.push_back({timestamps_s[i], poses.of_frame(i).value().transform});
    }
    return trajectory;
}

}  // namespace patina::sensor
