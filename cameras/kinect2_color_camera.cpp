#include "cameras/kinect2_color_camera.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/calib3d.hpp>

#include "engine/core/error.h"
#include "passes/kinect2/register_color.h"

namespace patina::cameras {

namespace {

/// Points of the depth camera, metres, and where the colour camera shows them.
struct Pairs {
    std::vector<cv::Point3f> points_m;
    std::vector<cv::Point2f> places_px;
};

Pairs pairs_of(const kinect2::HostTables& tables) {
    constexpr uint32_t kStep = 16;  // pixels; polynomials of third degree bend little within them
    const Intrinsics& depth = tables.depth;
    Pairs pairs;
    for (const double z : {0.5, 0.75, 1.2, 2.0, 4.5}) {
        for (uint32_t y = 0; y < depth.extent.height; y += kStep) {
            for (uint32_t x = 0; x < depth.extent.width; x += kStep) {
                const double column = tables.place_x.at(x, y) + tables.shift_px_m / z, row = tables.place_y.at(x, y);
                if (!kinect2::kColorExtent.contains(static_cast<int>(column), static_cast<int>(row))) continue;
                pairs.points_m.emplace_back((x - depth.cx) / depth.fx * z, (y - depth.cy) / depth.fy * z, z);
                pairs.places_px.emplace_back(column, row);
            }
        }
    }
    return pairs;
}

Intrinsics intrinsics_of(const cv::Mat1d& matrix, const cv::Mat1d& distortion) {
    Intrinsics camera{kinect2::kColorExtent, matrix(0, 0), matrix(1, 1), matrix(0, 2), matrix(1, 2), {}};
    std::copy_n(distortion.begin(), camera.distortion.size(), camera.distortion.begin());
    return camera;
}

RigidTransform transform_of(const cv::Mat& rotation_vector, const cv::Mat& translation) {
    cv::Mat1d rotation;
    cv::Rodrigues(rotation_vector, rotation);
    RigidTransform transform(1.0);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) transform[column][row] = rotation(row, column);
        transform[3][row] = translation.at<double>(row);
    }
    return transform;
}

FittedColorCamera fit(const Pairs& pairs) {
    constexpr double kFocal = 1080;  // to begin with: near that of all devices
    cv::Mat1d matrix = (cv::Mat1d(3, 3) << kFocal, 0, 959.5, 0, kFocal, 539.5, 0, 0, 1);
    cv::Mat1d distortion = cv::Mat1d::zeros(5, 1);
    std::vector<cv::Mat> rotations, translations;
    const std::vector<std::vector<cv::Point3f>> views_m{pairs.points_m};
    const std::vector<std::vector<cv::Point2f>> views_px{pairs.places_px};
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12);
    cv::calibrateCamera(views_m, views_px, cv::Size(1920, 1080), matrix, distortion, rotations, translations,
                        cv::CALIB_USE_INTRINSIC_GUESS, until);
    FittedColorCamera fitted;
    fitted.color = intrinsics_of(matrix, distortion);
    fitted.color_from_depth = transform_of(rotations.front(), translations.front());
    return fitted;
}

/// How far the camera is from the polynomials.
void measure(FittedColorCamera& fitted, const Pairs& pairs) {
    double squares = 0;
    for (size_t i = 0; i < pairs.points_m.size(); ++i) {
        const cv::Point3f p = pairs.points_m[i];
        const glm::dvec4 point = fitted.color_from_depth * glm::dvec4(p.x, p.y, p.z, 1);
        const glm::dvec2 place(pairs.places_px[i].x, pairs.places_px[i].y);
        const double off_px = glm::length(project(fitted.color, glm::dvec3(point)) - place);
        squares += off_px * off_px;
        fitted.max_px = std::max(fitted.max_px, off_px);
    }
    fitted.rms_px = std::sqrt(squares / static_cast<double>(pairs.points_m.size()));
}

}  // namespace

FittedColorCamera fit_color_camera(const kinect2::HostTables& tables) {
    const Pairs pairs = pairs_of(tables);
    constexpr size_t kLeast = 100;  // a sixth of the grid at one distance
    if (pairs.points_m.size() < kLeast)
        throw Error("the Kinect's colour polynomials lead to ", pairs.points_m.size(),
                    " places in its colour picture, ", kLeast, " are needed");
    FittedColorCamera fitted;
    try {
        fitted = fit(pairs);
    } catch (const cv::Exception& error) {
        throw Error("no lens and pose fit the Kinect's colour polynomials: ", error.err);
    }
    measure(fitted, pairs);
    if (!std::isfinite(fitted.rms_px)) throw Error("no lens and pose fit the Kinect's colour polynomials");
    return fitted;
}

}  // namespace patina::cameras
