#include "tests/reference/kinect2/decode.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patina::reference::kinect2 {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr uint32_t kWidth = 512, kHeight = 424;
constexpr Extent2D kExtent{kWidth, kHeight};
constexpr double kMultiplier = 0.6666667;

struct Camera {
    double fx, fy, cx, cy, k1, k2, p1, p2, k3;
};

/// With the device's own coordinates, in which the centre of the top left pixel is (0.5, 0.5).
Camera camera_of(const CameraModel& model) {
    const Intrinsics& depth = model.depth;
    return {depth.fx,
            depth.fy,
            depth.cx + 0.5,
            depth.cy + 0.5,
            depth.distortion[0],
            depth.distortion[1],
            depth.distortion[2],
            depth.distortion[3],
            depth.distortion[4]};
}

glm::dvec2 distorted(const Camera& c, double x, double y) {
    const double r2 = x * x + y * y;
    const double kr = 1 + c.k1 * r2 + c.k2 * std::pow(r2, 2) + c.k3 * std::pow(r2, 3);
    return {x * kr + c.p2 * (r2 + 2 * x * x) + 2 * c.p1 * x * y, y * kr + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y};
}

/// The ray of a pixel of the sensor, by fixed-point iteration.
glm::dvec2 ray_of(const Camera& c, uint32_t x, uint32_t y) {
    const glm::dvec2 wanted((x + 0.5 - c.cx) / c.fx, (y + 0.5 - c.cy) / c.fy);
    glm::dvec2 ray = wanted;
    for (int i = 0; i < 60; ++i) ray += wanted - distorted(c, ray.x, ray.y);
    return ray;
}

/// The code of a pixel, from 16-bit words as they are transmitted.
uint32_t code_at(std::span<const uint8_t> sub_image, uint32_t x, uint32_t y) {
    if (x == 0 || x == kWidth - 1) return 0;
    const uint32_t row = y < 212 ? y : 635 - y;
    const uint32_t index = (x >> 2) + ((x & 3) << 7), bit = 11 * index;
    const auto word = [&](uint32_t w) -> uint32_t {
        const size_t at = row * 704 + 2 * w;
        return sub_image[at] | static_cast<uint32_t>(sub_image[at + 1]) << 8;
    };
    return (word(bit >> 4) >> (bit & 15) | word((bit >> 4) + 1) << (16 - (bit & 15))) & 0x7ff;
}

double wrapped(double angle) { return angle - 2 * kPi * std::floor(angle / (2 * kPi)); }

double log_residual_limit(double amplitude, Exponentials exponentials) {
    constexpr double kSlope = -0.5330578, kOffset = 0.7694894;
    if (exponentials == Exponentials::kBase2)
        return std::exp2((std::log2(amplitude) * 0.30103 * kSlope + kOffset) * 3.321928);
    return std::exp((std::log(amplitude) * 0.30103 * kSlope + kOffset) * 3.321928);
}

/// The depth of one pixel from three phasors.
double depth_of(const std::array<glm::dvec2, 3>& phasor, glm::dvec2 ray, Exponentials exponentials) {
    double phase[3], amplitude[3];
    for (int f = 0; f < 3; ++f) {
        phase[f] = wrapped(std::atan2(phasor[f].y, phasor[f].x));
        amplitude[f] = kMultiplier * glm::length(phasor[f]);
    }
    const double least = std::min({amplitude[0], amplitude[1], amplitude[2]});
    const double most = std::max({amplitude[0], amplitude[1], amplitude[2]});
    if (least < 3 || amplitude[0] + amplitude[1] + amplitude[2] < 10) return 0;

    const double t0 = phase[0] / (2 * kPi) * 3, t2 = phase[2] / (2 * kPi) * 2;
    double t1 = phase[1] / (2 * kPi) * 15;
    double t5 = 3 * std::floor((t1 - t0) / 3 + 0.5) + t0;
    const double e = std::fmod(std::abs(t5 - t2), 2.0);
    if (e > 0.5 && e < 1.5) {
        t5 += 15;
        t1 += 15;
    }
    const glm::dvec3 cycles(t5 / 3, t1 / 15, (2 * std::floor((t5 - t2) / 2 + 0.5) + t2) / 2);
    const double mean = std::max((cycles.x + cycles.y + cycles.z) / 3, 0.0);
    const glm::dvec3 off = glm::cross(2 * kPi * cycles, glm::normalize(glm::dvec3(80, 16, 120)));
    const double limit = std::clamp(log_residual_limit(most, exponentials), 0.3490659, 0.6108653);
    if (limit * limit < glm::dot(off, off)) return 0;

    const double x_table = 8192 * ray.x;
    const double z_table = 6250.0 / 3 / std::sqrt(1 + ray.x * ray.x + ray.y * ray.y);
    const double dl = z_table * mean, d = 2 * 2083.333 * mean;
    if (dl == 0 || d == 0) return dl;
    return std::max(dl / (1 - dl * x_table * 90 / (d * d * 8192)), 0.0);
}

bool is_border(uint32_t x, uint32_t y) { return x == 0 || y == 0 || x == kWidth - 1 || y == kHeight - 1; }

/// Calls visit(x, y) for the pixel and its eight neighbours.
template <class Visit>
void around(uint32_t x, uint32_t y, Visit visit) {
    for (uint32_t row = y - 1; row <= y + 1; ++row) {
        for (uint32_t column = x - 1; column <= x + 1; ++column) visit(column, row);
    }
}

/// One frequency of smooth_phases at an inner pixel; returns the sum of the distances in phase.
double smooth_pixel(const Image<glm::dvec2>& phasors, uint32_t x, uint32_t y, Exponentials exponentials,
                    glm::dvec2& result) {
    const glm::dvec2 center = phasors.at(x, y);
    const double n = glm::length(center);
    const bool bright = n * n >= 9 / (kMultiplier * kMultiplier);
    const double threshold = bright ? 9 / (kMultiplier * kMultiplier) : 0, exponent = bright ? 5 : 0;
    double distances = 0, weights = 0;
    glm::dvec2 sum(0);
    around(x, y, [&](uint32_t column, uint32_t row) {
        const glm::dvec2 other = phasors.at(column, row);
        const double length = glm::length(other);
        if (length * length < threshold) return;
        const double cosine = n > 0 && length > 0 ? glm::dot(center, other) / (n * length) : 1;
        const double distance = (1 - cosine) / 2;
        const uint32_t sides = (column != x) + (row != y);
        const double gauss = sides == 0 ? 0.1195716 : sides == 1 ? 0.1131098 : 0.1069973;
        const double weight = exponentials == Exponentials::kBase2 ? std::exp2(-1.442695 * exponent * distance)
                                                                   : std::exp(-1.442695 * exponent * distance);
        distances += distance;
        weights += gauss * weight;
        sum += gauss * weight * other;
    });
    result = weights > 0 ? sum / weights : glm::dvec2(0);
    return distances;
}

bool between_surfaces(const Unwrapped& depth, uint32_t x, uint32_t y) {
    const double z = depth.depth_mm.at(x, y);
    double sum = 0, squares = 0, nearest = z, farthest = z;
    around(x, y, [&](uint32_t column, uint32_t row) {
        const double amplitude = depth.amplitude.at(column, row), other = depth.depth_mm.at(column, row);
        sum += amplitude;
        squares += amplitude * amplitude;
        if (other > 0) nearest = std::min(nearest, other);
        if (other > 0) farthest = std::max(farthest, other);
    });
    const double deviation = std::sqrt(std::max(9 * squares - sum * sum, 0.0)) / 9 / std::max(sum / 9, 50.0);
    const double near_step = std::abs(z - nearest), far_step = std::abs(z - farthest);
    return deviation >= 0.05 && near_step > 50 && far_step > 30 && std::max(near_step, far_step) > 100;
}

double cubic(const std::array<double, 10>& c, double x, double y) {
    return c[0] * std::pow(x, 3) + c[1] * std::pow(y, 3) + c[2] * x * x * y + c[3] * x * y * y + c[4] * x * x +
           c[5] * y * y + c[6] * x * y + c[7] * x + c[8] * y + c[9];
}

}  // namespace

int measurement(uint32_t code) {
    if (code == 1024) return 32767;
    if (code > 1024) return -measurement(code - 1024);
    int value = 0;
    for (uint32_t c = 0; c < code; ++c) {
        constexpr int kSteps[] = {1, 1, 2, 4, 8, 16, 32, 64};
        value += kSteps[c / 128];
    }
    return value;
}

Measured measure_phases(const CameraModel& model, std::span<const uint8_t> infrared) {
    constexpr double kMultipliers[] = {1.322581, 1.0, 1.612903};
    std::vector<int> values(2048);
    for (uint32_t code = 0; code < 2048; ++code) values[code] = measurement(code);
    Measured measured;
    for (auto& image : measured.phasors) image = Image<glm::dvec2>(kExtent);
    measured.infrared = Image<double>(kExtent);
    for (uint32_t y = 0; y < kHeight; ++y) {
        for (uint32_t x = 0; x < kWidth; ++x) {
            double lengths = 0;
            for (uint32_t f = 0; f < 3; ++f) {
                const double offset = -2 * kPi * model.p0[f][size_t{y} * kWidth + x] / 65536;
                glm::dvec2 phasor(0);
                bool saturated = false;
                for (uint32_t k = 0; k < 3; ++k) {
                    const int m = values[code_at(infrared.subspan((3 * f + k) * 298496, 298496), x, y)];
                    const double theta[] = {0, 2.094395, 4.18879};
                    saturated |= m == 32767;
                    phasor +=
                        static_cast<double>(m) * glm::dvec2(std::cos(offset + theta[k]), -std::sin(offset + theta[k]));
                }
                phasor = saturated ? glm::dvec2(0) : kMultipliers[f] * phasor;
                measured.phasors[f].at(x, y) = phasor;
                lengths += saturated ? 65535 : glm::length(phasor);
            }
            measured.infrared.at(x, y) = std::min(lengths / 3 * kMultiplier * 16, 65535.0);
        }
    }
    return measured;
}

Smoothed smooth_phases(const Phasors& phasors, Exponentials exponentials) {
    Smoothed smoothed{phasors, Image<uint8_t>(kExtent, 1)};
    for (uint32_t y = 1; y + 1 < kHeight; ++y) {
        for (uint32_t x = 1; x + 1 < kWidth; ++x) {
            for (size_t f = 0; f < 3; ++f) {
                const double distances = smooth_pixel(phasors[f], x, y, exponentials, smoothed.phasors[f].at(x, y));
                if (distances >= 2.5) smoothed.even.at(x, y) = 0;
            }
        }
    }
    return smoothed;
}

Unwrapped unwrap_phases(const CameraModel& model, const Phasors& phasors, Exponentials exponentials) {
    const Camera camera = camera_of(model);
    Unwrapped unwrapped{Image<double>(kExtent), Image<double>(kExtent)};
    for (uint32_t y = 0; y < kHeight; ++y) {
        for (uint32_t x = 0; x < kWidth; ++x) {
            const std::array<glm::dvec2, 3> at{phasors[0].at(x, y), phasors[1].at(x, y), phasors[2].at(x, y)};
            unwrapped.depth_mm.at(x, y) = depth_of(at, ray_of(camera, x, y), exponentials);
            unwrapped.amplitude.at(x, y) = kMultiplier * (glm::length(at[0]) + glm::length(at[1]) + glm::length(at[2]));
        }
    }
    return unwrapped;
}

Image<double> filter_edges(const Unwrapped& depth, const Image<uint8_t>& even, const DecodeSettings& settings) {
    Image<double> filtered = depth.depth_mm;
    for (uint32_t y = 0; y < kHeight; ++y) {
        for (uint32_t x = 0; x < kWidth; ++x) {
            double& z = filtered.at(x, y);
            const bool in_range = z >= 1000.0 * settings.min_m && z <= 1000.0 * settings.max_m;
            const bool at_edge =
                settings.drop_edges && !is_border(x, y) && (!even.at(x, y) || between_surfaces(depth, x, y));
            if (!in_range || at_edge) z = 0;
        }
    }
    return filtered;
}

Image<double> undistort(const CameraModel& model, const Image<double>& picture) {
    const Camera c = camera_of(model);
    Image<double> straight(kExtent);
    for (uint32_t y = 0; y < kHeight; ++y) {
        for (uint32_t x = 0; x < kWidth; ++x) {
            const glm::dvec2 at = distorted(c, (x + 0.5 - c.cx) / c.fx, (y + 0.5 - c.cy) / c.fy);
            const auto column = static_cast<int>(std::floor(at.x * c.fx + c.cx));
            const auto row = static_cast<int>(std::floor(at.y * c.fy + c.cy));
            if (!kExtent.contains(column, row)) continue;
            straight.at(kWidth - 1 - x, y) = picture.at(static_cast<uint32_t>(column), static_cast<uint32_t>(row));
        }
    }
    return straight;
}

Image<double> decode(const CameraModel& model, std::span<const uint8_t> infrared, const DecodeSettings& settings) {
    const Measured measured = measure_phases(model, infrared);
    const Smoothed smoothed = settings.smooth_phases ? smooth_phases(measured.phasors, settings.exponentials)
                                                     : Smoothed{measured.phasors, Image<uint8_t>(kExtent, 1)};
    const Unwrapped unwrapped = unwrap_phases(model, smoothed.phasors, settings.exponentials);
    Image<double> depth_m = undistort(model, filter_edges(unwrapped, smoothed.even, settings));
    for (double& z : depth_m.pixels()) z *= 0.001;
    return depth_m;
}

glm::dvec2 color_place(const CameraModel& model, uint32_t x, uint32_t y, double z_m) {
    const auto& color = model.color;
    const double u = (kWidth - 1.0 - x - (model.depth.cx + 0.5)) * 0.01, v = (y - (model.depth.cy + 0.5)) * 0.01;
    const double rx = cubic(color.mx, u, v) / (color.f * 0.002199) - color.shift_m / color.shift_d;
    const double column = (rx + color.shift_m / (1000 * z_m)) * color.f + color.cx;
    return {1919 - column, cubic(color.my, u, v) / 0.002199 + color.cy};
}

Image<uint32_t> register_color(const CameraModel& model, const Image<float>& depth_m, const Image<SrgbPixel>& color) {
    const Extent2D extent = color.extent();
    Image<float> nearest(extent, 1e9f);
    Image<glm::ivec2> places(kExtent, glm::ivec2(-1));
    for (uint32_t y = 0; y < kHeight; ++y) {
        for (uint32_t x = 0; x < kWidth; ++x) {
            const float z = depth_m.at(x, y);
            if (z == 0) continue;
            const glm::ivec2 at(glm::floor(color_place(model, x, y, z) + 0.5));
            if (!extent.contains(at.x, at.y)) continue;
            places.at(x, y) = at;
            for (int row = at.y - 1; row <= at.y + 1; ++row) {
                for (int column = at.x - 2; column <= at.x + 2; ++column) {
                    if (!extent.contains(column, row)) continue;
                    float& least = nearest.at(static_cast<uint32_t>(column), static_cast<uint32_t>(row));
                    least = std::min(least, z);
                }
            }
        }
    }
    Image<uint32_t> registered(kExtent);
    for (size_t i = 0; i < registered.pixels().size(); ++i) {
        const glm::ivec2 at = places.pixels()[i];
        if (at.x < 0) continue;
        const float z = depth_m.pixels()[i],
                    least = nearest.at(static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.y));
        const SrgbPixel rgb = color.at(static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.y));
        if ((z - least) / z <= 0.01f)
            registered.pixels()[i] = rgb.r | uint32_t{rgb.g} << 8 | uint32_t{rgb.b} << 16 | 255u << 24;
    }
    return registered;
}

}  // namespace patina::reference::kinect2
