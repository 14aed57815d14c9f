#include "tools/eval/trajectory.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>
#include <opencv2/core.hpp>

#include "engine/core/error.h"
#include "sensor/associate.h"
#include "sensor/files/text_file.h"

namespace patina::eval {
namespace {

constexpr double kSecondSteps_s = 1;

glm::dvec3 position(const RigidTransform& pose) { return glm::dvec3(pose[3]); }

/// The rotation R that maximises trace(R^T m): Umeyama's, and the one nearest to m.
glm::dmat3 nearest_rotation(const glm::dmat3& m) {
    cv::Matx33d matrix;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) matrix(row, column) = m[column][row];
    }
    cv::Matx33d u, vt;
    cv::Vec3d singular_values;
    cv::SVD::compute(matrix, singular_values, u, vt);
    const double sign = cv::determinant(u) * cv::determinant(vt) < 0 ? -1 : 1;
    const cv::Matx33d rotation = u * cv::Matx33d::diag({1, 1, sign}) * vt;
    glm::dmat3 result;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) result[column][row] = rotation(row, column);
    }
    return result;
}

/// The mean position of truth and run.
std::pair<glm::dvec3, glm::dvec3> centres(std::span<const PosePair> pairs) {
    glm::dvec3 truth(0), run(0);
    for (const PosePair& pair : pairs) {
        truth += position(pair.truth);
        run += position(pair.run);
    }
    const auto count = static_cast<double>(pairs.size());
    return {truth / count, run / count};
}

/// The transform with this rotation that maps one centre to the other.
RigidTransform with_centres(const glm::dmat3& rotation, std::span<const PosePair> pairs) {
    const auto [truth, run] = centres(pairs);
    RigidTransform transform(rotation);
    transform[3] = glm::dvec4(truth - rotation * run, 1.0);
    return transform;
}

/// Root mean square, median and maximum of errors.
struct Spread {
    double rmse = 0;
    double median = 0;
    double max = 0;
};

/// Of an even number of values the mean of the middle two.
double median_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

Spread spread_of(const std::vector<double>& errors) {
    Spread spread;
    spread.median = median_of(errors);
    for (const double error : errors) {
        spread.rmse += error * error;
        spread.max = std::max(spread.max, error);
    }
    spread.rmse = std::sqrt(spread.rmse / static_cast<double>(errors.size()));
    return spread;
}

Spread position_errors(std::span<const PosePair> pairs, const RigidTransform& truth_from_run) {
    std::vector<double> errors_m;
    for (const PosePair& pair : pairs) {
        errors_m.push_back(glm::distance(position(pair.truth), position(truth_from_run * pair.run)));
    }
    return spread_of(errors_m);
}

double angle_deg(const RigidTransform& transform) {
    // The sine, from the antisymmetric part, is exact for small angles, where the cosine is flat.
    const glm::dvec3 sine(transform[1][2] - transform[2][1], transform[2][0] - transform[0][2],
                          transform[0][1] - transform[1][0]);
    return glm::degrees(std::atan2(glm::length(sine), transform[0][0] + transform[1][1] + transform[2][2] - 1));
}

using IndexPairs = std::vector<std::pair<size_t, size_t>>;

std::optional<RelativePoseError> relative_error(std::span<const PosePair> poses, const IndexPairs& steps) {
    if (steps.empty()) return std::nullopt;
    std::vector<double> translations_m, rotations_deg;
    RelativePoseError error;
    for (const auto& [from, to] : steps) {
        const RigidTransform true_step = rigid_inverse(poses[from].truth) * poses[to].truth;
        const RigidTransform run_step = rigid_inverse(poses[from].run) * poses[to].run;
        const RigidTransform difference = rigid_inverse(true_step) * run_step;
        translations_m.push_back(glm::length(position(difference)));
        rotations_deg.push_back(angle_deg(difference));
        error.step_s += poses[to].timestamp_s - poses[from].timestamp_s;
    }
    error.pairs = steps.size();
    error.step_s /= static_cast<double>(steps.size());
    const Spread translation = spread_of(translations_m), rotation = spread_of(rotations_deg);
    error.translation_rmse_m = translation.rmse;
    error.translation_median_m = translation.median;
    error.translation_max_m = translation.max;
    error.rotation_rmse_deg = rotation.rmse;
    error.rotation_median_deg = rotation.median;
    error.rotation_max_deg = rotation.max;
    return error;
}

IndexPairs neighbours(std::span<const PosePair> poses) {
    IndexPairs steps;
    for (size_t i = 1; i < poses.size(); ++i) steps.emplace_back(i - 1, i);
    return steps;
}

/// Each pose with the one that is nearest to a second later, where that is at most half a mean step off.
IndexPairs a_second_apart(std::span<const PosePair> poses) {
    IndexPairs steps;
    const double duration_s = poses.back().timestamp_s - poses.front().timestamp_s;
    const double tolerance_s = 0.5 * duration_s / static_cast<double>(std::max<size_t>(poses.size() - 1, 1));
    for (size_t from = 0, to = 0; from < poses.size(); ++from) {
        const auto miss_s = [&](size_t i) {
            return std::abs(poses[i].timestamp_s - poses[from].timestamp_s - kSecondSteps_s);
        };
        while (to + 1 < poses.size() && miss_s(to + 1) <= miss_s(to)) ++to;
        // Timestamps are decimals, whose rounding must not decide.
        if (to > from && miss_s(to) <= tolerance_s + 1e-6) steps.emplace_back(from, to);
    }
    return steps;
}

}  // namespace

std::vector<PosePair> pair_poses(std::span<const sensor::StampedPose> truth, std::span<const sensor::StampedPose> run,
                                 double limit_s) {
    const auto timestamps = [](std::span<const sensor::StampedPose> poses) {
        std::vector<double> values;
        for (const sensor::StampedPose& pose : poses) values.push_back(pose.timestamp_s);
        return values;
    };
    const auto partners = sensor::associate(timestamps(truth), timestamps(run), limit_s);
    std::vector<PosePair> pairs;
    for (size_t i = 0; i < truth.size(); ++i) {
        if (!partners[i]) continue;
        pairs.push_back({i, truth[i].timestamp_s, truth[i].world_from_camera, run[*partners[i]].world_from_camera});
    }
    return pairs;
}

RigidTransform align_positions(std::span<const PosePair> pairs) {
    const auto [truth_centre, run_centre] = centres(pairs);
    glm::dmat3 covariance(0);
    for (const PosePair& pair : pairs) {
        covariance += glm::outerProduct(position(pair.truth) - truth_centre, position(pair.run) - run_centre);
    }
    return with_centres(nearest_rotation(covariance), pairs);
}

RigidTransform align_worlds(std::span<const PosePair> pairs) {
    glm::dmat3 sum(0);
    for (const PosePair& pair : pairs) sum += glm::dmat3(pair.truth) * glm::transpose(glm::dmat3(pair.run));
    return with_centres(nearest_rotation(sum), pairs);
}

TrajectoryErrors trajectory_errors(std::span<const PosePair> pairs, size_t truth_poses, size_t run_poses) {
    PATINA_ASSERT(!pairs.empty(), "truth poses ", truth_poses, ", run poses ", run_poses);
    TrajectoryErrors errors;
    errors.truth_poses = truth_poses;
    errors.run_poses = run_poses;
    errors.poses = pairs.size();
    const Spread aligned = position_errors(pairs, align_positions(pairs));
    errors.ate_rmse_m = aligned.rmse;
    errors.ate_max_m = aligned.max;
    errors.unaligned_rmse_m = position_errors(pairs, RigidTransform(1.0)).rmse;
    errors.per_frame = relative_error(pairs, neighbours(pairs));
    errors.per_second = relative_error(pairs, a_second_apart(pairs));
    return errors;
}

}  // namespace patina::eval
