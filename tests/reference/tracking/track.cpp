#include "tests/reference/tracking/track.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

namespace patina::reference {

namespace {

constexpr double kMostShade = 4094.0 / 2047;
const double kLeastCosine = 0.17;

double shade_of(glm::dvec3 linear) {
    const double light = 0.2126 * linear.r + 0.7152 * linear.g + 0.0722 * linear.b;
    return std::min(std::sqrt(std::max(light, 0.0)), kMostShade);
}

glm::dvec3 ray_of(const Intrinsics& camera, double x, double y) {
    return {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1};
}

glm::dvec2 pixel_of(const Intrinsics& camera, glm::dvec3 point_m) {
    return {point_m.x / point_m.z * camera.fx + camera.cx, point_m.y / point_m.z * camera.fy + camera.cy};
}

template <class Pixel>
Pixel pixel_or(const Image<Pixel>& image, int x, int y, Pixel outside) {
    return image.extent().contains(x, y) ? image.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y)) : outside;
}

/// Calls visit(x, y) for every pixel.
template <class Visit>
void for_each_pixel(Extent2D extent, Visit&& visit) {
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) visit(x, y);
    }
}

double shade_seen(const TrackPicture& picture, glm::dvec3 point_m) {
    const glm::dvec3 seen(picture.color_from_depth * glm::dvec4(point_m, 1));
    if (seen.z <= 0) return -1;
    const glm::dvec2 at = pixel_of(picture.camera, seen);
    const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
        const double share = (i & 1 ? at.x - x : 1 - (at.x - x)) * (i & 2 ? at.y - y : 1 - (at.y - y));
        const glm::vec4 color = pixel_or(picture.linear, x + (i & 1), y + (i >> 1), glm::vec4(0));
        if (share > 1e-3 && color.a != 1) return -1;
        sum += share * shade_of(glm::dvec3(color));
    }
    return sum;
}

/// Geman and McClure's.
double robust(double share) { return 1 / ((1 + share * share) * (1 + share * share)); }

}  // namespace

Image<TrackReading> pack_frame(const Image<float>& depth_m, const Intrinsics& camera,
                               const std::optional<TrackPicture>& color, double max_depth_m, bool half,
                               const TrackJump& jump) {
    Image<TrackReading> packed(depth_m.extent());
    for_each_pixel(depth_m.extent(), [&](uint32_t x, uint32_t y) {
        const double z = depth_m.at(x, y);
        if (!(z > 0 && z <= max_depth_m)) return;
        const int px = static_cast<int>(x), py = static_cast<int>(y);
        for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
            const double there = pixel_or(depth_m, px + dx, py + dy, 0.0f);
            if (there != 0 && std::abs(there - z) > jump.floor_m + jump.slope * z) return;
        }
        packed.at(x, y).depth_m = z;
    });
    if (half) packed = halve_frame(packed, jump);
    const double each = half ? 2 : 1;
    for_each_pixel(packed.extent(), [&](uint32_t x, uint32_t y) {
        TrackReading& reading = packed.at(x, y);
        const glm::dvec3 ray = ray_of(camera, each * (x + 0.5) - 0.5, each * (y + 0.5) - 0.5);
        if (color && reading.depth_m > 0) reading.shade = shade_seen(*color, reading.depth_m * ray);
    });
    return packed;
}

Image<TrackReading> halve_frame(const Image<TrackReading>& fine, const TrackJump& jump) {
    Image<TrackReading> coarse(Extent2D{fine.extent().width / 2, fine.extent().height / 2});
    for_each_pixel(coarse.extent(), [&](uint32_t x, uint32_t y) {
        std::vector<double> depths, shades;
        for (uint32_t i = 0; i < 4; ++i) {
            const TrackReading part = fine.at(2 * x + (i & 1), 2 * y + (i >> 1));
            if (part.depth_m > 0) depths.push_back(part.depth_m);
            if (part.depth_m > 0 && part.shade >= 0) shades.push_back(part.shade);
        }
        if (depths.size() < 3) return;
        std::sort(depths.begin(), depths.end());
        if (depths.back() - depths.front() > jump.floor_m + 2 * jump.slope * depths.front()) return;
        double depth = 0, shade = 0;
        for (const double part : depths) depth += part / static_cast<double>(depths.size());
        for (const double part : shades) shade += part / static_cast<double>(shades.size());
        coarse.at(x, y) = {depth, shades.size() >= 3 ? shade : -1};
    });
    return coarse;
}

Image<TrackSurface> pack_model(const Image<glm::vec4>& position_m, const Image<glm::vec4>& normal,
                               const std::optional<Image<glm::vec4>>& color, const Intrinsics& camera,
                               const RigidTransform& world_from_camera, const TrackJump& jump) {
    const glm::dmat3 camera_from_world(rigid_inverse(world_from_camera));
    Image<TrackSurface> packed(position_m.extent());
    for_each_pixel(position_m.extent(), [&](uint32_t x, uint32_t y) {
        const double z = position_m.at(x, y).w;
        const glm::dvec3 n = camera_from_world * glm::dvec3(normal.at(x, y)), ray = ray_of(camera, x, y);
        if (!(z > 0) || -glm::dot(n, ray) < kLeastCosine * glm::length(ray)) return;
        TrackSurface& surface = packed.at(x, y);
        surface.depth_m = z;
        surface.normal = n;
        if (!color) return;
        const auto shade_at = [&](int dx, int dy) {
            const int px = static_cast<int>(x) + dx, py = static_cast<int>(y) + dy;
            const glm::vec4 seen = pixel_or(*color, px, py, glm::vec4(0));
            const double there = pixel_or(position_m, px, py, glm::vec4(0)).w;
            const bool known = seen.a > 0 && std::abs(there - z) <= jump.floor_m + jump.slope * z;
            return known ? shade_of(glm::dvec3(seen)) : -1;
        };
        const double left = shade_at(-1, 0), right = shade_at(1, 0), up = shade_at(0, -1), down = shade_at(0, 1);
        if (std::min({left, right, up, down, shade_at(0, 0)}) < 0) return;
        surface.shade = shade_at(0, 0);
        surface.shade_per_px = glm::dvec2(right - left, down - up) / 2.0;
    });
    return packed;
}

Image<TrackSurface> halve_model(const Image<TrackSurface>& fine, const TrackJump& jump) {
    Image<TrackSurface> coarse(Extent2D{fine.extent().width / 2, fine.extent().height / 2});
    for_each_pixel(coarse.extent(), [&](uint32_t x, uint32_t y) {
        std::array<TrackSurface, 4> parts;
        for (uint32_t i = 0; i < 4; ++i) parts[i] = fine.at(2 * x + i % 2, 2 * y + i / 2);
        const auto [least, most] = std::minmax_element(
            parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.depth_m < b.depth_m; });
        if (!(least->depth_m > 0)) return;
        if (most->depth_m - least->depth_m > jump.floor_m + 2 * jump.slope * least->depth_m) return;
        TrackSurface mean{0, glm::dvec3(0), glm::dvec2(0), 0};
        bool shaded = true;
        for (const TrackSurface& part : parts) {
            mean.depth_m += part.depth_m / 4;
            mean.normal += part.normal;
            mean.shade += part.shade / 4;
            mean.shade_per_px += part.shade_per_px / 2.0;
            shaded = shaded && part.shade >= 0;
        }
        if (glm::dot(mean.normal, mean.normal) <= 8) return;
        mean.normal = glm::normalize(mean.normal);
        if (!shaded) mean.shade = -1, mean.shade_per_px = glm::dvec2(0);
        coarse.at(x, y) = mean;
    });
    return coarse;
}

namespace {

void add_row(TrackEquations& sums, glm::dvec3 along, glm::dvec3 lever, double residual, double weight) {
    const glm::dvec3 around = glm::cross(lever, along);
    const std::array<double, 6> row{along.x, along.y, along.z, around.x, around.y, around.z};
    for (size_t i = 0; i < 6; ++i) {
        for (size_t j = 0; j < 6; ++j) sums.matrix[i][j] += weight * row[i] * row[j];
        sums.right[i] += weight * row[i] * residual;
    }
}

}  // namespace

TrackEquations track_equations(const Image<TrackReading>& frame, const Intrinsics& frame_camera,
                               const Image<TrackSurface>& model, const Intrinsics& model_camera, const TrackPose& pose,
                               const TrackComparison& comparison) {
    TrackEquations sums;
    for_each_pixel(frame.extent(), [&](uint32_t x, uint32_t y) {
        const TrackReading reading = frame.at(x, y);
        const double z = reading.depth_m;
        if (z <= 0) return;
        sums.readings += 1;
        sums.depth += z;
        const glm::dvec3 point(pose.model_from_frame * glm::dvec4(z * ray_of(frame_camera, x, y), 1));
        if (point.z <= 0.05) return;
        const glm::dvec2 at = pixel_of(model_camera, point), nearest = glm::floor(at + 0.5);
        const TrackSurface found =
            pixel_or(model, static_cast<int>(nearest.x), static_cast<int>(nearest.y), TrackSurface{});
        if (found.depth_m <= 0) return;
        const glm::dvec3 apart = point - found.depth_m * ray_of(model_camera, nearest.x, nearest.y);
        if (glm::length(apart) > comparison.gate_m + comparison.gate_slope * z) return;
        const double distance = glm::dot(found.normal, apart);
        const double sigma = comparison.noise_floor_m + comparison.noise_per_m * z * z;
        const double trust = robust(distance / sigma / comparison.robust_sigmas);
        const glm::dvec3 lever = (point - glm::dvec3(0, 0, pose.center_m)) / pose.lever_m;
        add_row(sums, found.normal, lever, distance, trust / sigma / sigma);
        sums.pairs += trust;
        sums.squares += trust * distance * distance / sigma / sigma;
        sums.weight += trust / sigma / sigma;

        if (comparison.shade_sigma <= 0 || found.shade < 0 || reading.shade < 0) return;
        const double expected = found.shade + glm::dot(found.shade_per_px, at - nearest);
        const double difference = pose.gain * reading.shade - expected;
        const double shade_trust = trust * robust(difference / comparison.robust_shade);
        // How the model's shade at the point's projection changes with the point, negated as in the difference.
        const double gx = found.shade_per_px.x * model_camera.fx, gy = found.shade_per_px.y * model_camera.fy;
        const glm::dvec3 along(-gx / point.z, -gy / point.z, (gx * point.x + gy * point.y) / (point.z * point.z));
        add_row(sums, along, lever, difference, shade_trust / comparison.shade_sigma / comparison.shade_sigma);
        sums.shades += shade_trust;
        sums.shade_squares += shade_trust * difference * difference;
        sums.shade_product += shade_trust * reading.shade * expected;
        sums.shade_own += shade_trust * reading.shade * reading.shade;
    });
    return sums;
}

namespace {

using Matrix6 = std::array<std::array<double, 6>, 6>;

/// Diagonalises a symmetric matrix, each time at its largest entry beside the diagonal. Columns of the result are the
/// eigenvectors.
Matrix6 diagonalise(Matrix6& a) {
    Matrix6 v{};
    for (size_t i = 0; i < 6; ++i) v[i][i] = 1;
    for (int rotation = 0; rotation < 300; ++rotation) {
        size_t p = 0, q = 1;
        for (size_t i = 0; i < 6; ++i) {
            for (size_t j = i + 1; j < 6; ++j) {
                if (std::abs(a[i][j]) > std::abs(a[p][q])) p = i, q = j;
            }
        }
        if (std::abs(a[p][q]) < 1e-30) break;
        const double angle = 0.5 * std::atan2(2 * a[p][q], a[q][q] - a[p][p]);
        const double c = std::cos(angle), s = std::sin(angle);
        for (Matrix6* matrix : {&a, &v}) {
            for (size_t k = 0; k < 6; ++k) {
                const double kp = (*matrix)[k][p], kq = (*matrix)[k][q];
                (*matrix)[k][p] = c * kp - s * kq;
                (*matrix)[k][q] = s * kp + c * kq;
            }
        }
        for (size_t k = 0; k < 6; ++k) {
            const double pk = a[p][k], qk = a[q][k];
            a[p][k] = c * pk - s * qk;
            a[q][k] = s * pk + c * qk;
        }
    }
    return v;
}

}  // namespace

TrackStep track_step(const TrackEquations& equations, const TrackPose& pose, double held_share) {
    Matrix6 values = equations.matrix;
    for (auto& row : values) {
        for (double& entry : row) entry /= equations.weight;
    }
    const Matrix6 vectors = diagonalise(values);
    TrackStep step;
    glm::dvec3 along(0), around(0);
    for (size_t e = 0; e < 6; ++e) {
        step.eigenvalues[e] = values[e][e];
        if (values[e][e] < held_share) {
            ++step.held;
            continue;
        }
        double right = 0;
        for (size_t i = 0; i < 6; ++i) right += vectors[i][e] * equations.right[i] / equations.weight;
        for (int i = 0; i < 3; ++i) {
            along[i] -= right / values[e][e] * vectors[static_cast<size_t>(i)][e];
            around[i] -= right / values[e][e] * vectors[static_cast<size_t>(i) + 3][e];
        }
    }
    std::sort(step.eigenvalues.begin(), step.eigenvalues.end());
    around /= pose.lever_m;
    const glm::dvec3 center(0, 0, pose.center_m);
    RigidTransform motion = glm::translate(RigidTransform(1.0), center + along);
    if (glm::length(around) > 0) motion = glm::rotate(motion, glm::length(around), glm::normalize(around));
    motion = glm::translate(motion, -center);
    step.model_from_frame = motion * pose.model_from_frame;
    return step;
}

}  // namespace patina::reference
