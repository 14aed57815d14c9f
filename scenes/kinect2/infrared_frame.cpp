#include "scenes/kinect2/infrared_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "engine/core/undistort.h"

namespace patina::scenes::kinect2 {

namespace {

constexpr uint32_t kFrequencies = 3, kPhases = 3;
constexpr double kUnitMm = 1250;                     // of travel
constexpr double kWraps[kFrequencies] = {3, 15, 2};  // in that unit: 80, 16 and 120 MHz
constexpr double kEmitterBaselineMm = 90;            // twice its distance from the camera, along x
constexpr uint32_t kWidth = kInfraredExtent.width, kHeight = kInfraredExtent.height;

/// The values of the codes 0 to 1023: octaves of 128 steps of 1, 1, 2, 4, 8, 16, 32 and 64.
constexpr std::array<int, 1024> make_values() {
    std::array<int, 1024> values{};
    for (size_t code = 1; code < values.size(); ++code) {
        const size_t octave = (code - 1) / 128;
        values[code] = values[code - 1] + (octave == 0 ? 1 : 1 << (octave - 1));
    }
    return values;
}

void check(const InfraredSensor& sensor, const InfraredScene& scene) {
    const auto require = [](const char* what, Extent2D extent) {
        if (extent != kInfraredExtent)
            throw Error("an infrared frame needs a ", what, " of ", kInfraredExtent, ", not of ", extent);
    };
    require("camera", sensor.camera.extent);
    require("depth picture", scene.depth_m.extent());
    require("picture of amplitudes", scene.amplitude.extent());
    for (const auto& table : sensor.p0) {
        if (table.size() != kInfraredExtent.area())
            throw Error("an infrared frame needs ", kInfraredExtent.area(), " phase offsets, not ", table.size());
    }
}

/// Standard normal numbers, the same with every standard library (Box and Muller 1958).
class Normal {
  public:
    explicit Normal(uint64_t seed) : random_(seed) {}
    double operator()() {
        const double radius = std::sqrt(-2 * std::log(uniform()));
        return radius * std::cos(2 * std::numbers::pi * uniform());
    }

  private:
    /// In (0, 1].
    double uniform() { return (static_cast<double>(random_() >> 11) + 1) / 9007199254740992.0; }
    std::mt19937_64 random_;
};

using PixelCodes = std::array<uint16_t, kFrequencies * kPhases>;

/// The codes of one pixel: the modulated light, shifted by its travel, correlated with each phase of the sensor.
PixelCodes measure(const InfraredSensor& sensor, size_t pixel, double travel, double amplitude,
                   const MeasurementNoise& noise, Normal& normal) {
    const double sigma = std::sqrt(noise.floor + noise.per_amplitude * amplitude);
    PixelCodes codes{};
    for (uint32_t f = 0; f < kFrequencies; ++f) {
        const double turns = travel / kUnitMm / kWraps[f] - sensor.p0[f][pixel] / 65536.0;
        for (uint32_t k = 0; k < kPhases; ++k) {
            const double light = amplitude * std::cos(2 * std::numbers::pi * (turns + k / 3.0));
            codes[f * kPhases + k] = encode(sigma > 0 ? light + sigma * normal() : light);
        }
    }
    return codes;
}

/// The row of a sub-image in which a row of the picture is sent: the lower half comes bottom up.
uint32_t transmitted_row(uint32_t y) { return y < kHeight / 2 ? y : kHeight + kHeight / 2 - 1 - y; }

std::optional<glm::dvec2> ray_of(const Intrinsics& camera, uint32_t x, uint32_t y) {
    return undistort(camera, {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy});
}

}  // namespace

uint16_t encode(double measurement) {
    static constexpr std::array<int, 1024> kValues = make_values();
    const double magnitude = std::abs(measurement);
    if (!(magnitude <= kValues.back())) return kSaturatedCode;
    const auto above = std::lower_bound(kValues.begin(), kValues.end(), magnitude);
    const bool below_is_nearer = above != kValues.begin() && magnitude - *(above - 1) <= *above - magnitude;
    const auto code = static_cast<uint16_t>((below_is_nearer ? above - 1 : above) - kValues.begin());
    return measurement < 0 && code > 0 ? static_cast<uint16_t>(code + 1024) : code;
}

std::array<uint8_t, kRowBytes> pack_row(std::span<const uint16_t, 512> codes) {
    std::array<uint8_t, kRowBytes> bytes{};
    for (size_t x = 1; x + 1 < codes.size(); ++x) {
        const size_t first_bit = 11 * (x / 4 + x % 4 * 128);
        for (size_t bit = 0; bit < 11; ++bit) {
            const size_t at = first_bit + bit;
            bytes[at / 8] |= static_cast<uint8_t>((codes[x] >> bit & 1) << at % 8);
        }
    }
    return bytes;
}

double travel_mm(glm::dvec2 ray, double z_mm) {
    const double along = std::sqrt(1 + glm::dot(ray, ray)) * z_mm;
    return along + std::sqrt(along * along - kEmitterBaselineMm * z_mm * ray.x);
}

std::vector<uint8_t> infrared_frame(const InfraredSensor& sensor, const InfraredScene& scene,
                                    const MeasurementNoise& noise) {
    check(sensor, scene);
    std::vector<uint8_t> frame(kSubImages * kSubImageBytes);
    std::array<std::array<uint16_t, kWidth>, kFrequencies * kPhases> rows{};
    Normal normal(noise.seed);
    for (uint32_t y = 0; y < kHeight; ++y) {
        for (uint32_t x = 0; x < kWidth; ++x) {
            const auto ray = ray_of(sensor.camera, x, y);
            const double z_mm = 1000.0 * scene.depth_m.at(x, y);
            const bool lit = ray && z_mm > 0;
            const PixelCodes codes = measure(sensor, size_t{y} * kWidth + x, lit ? travel_mm(*ray, z_mm) : 0,
                                             lit ? scene.amplitude.at(x, y) : 0, noise, normal);
            for (size_t i = 0; i < codes.size(); ++i) rows[i][x] = codes[i];
        }
        for (size_t i = 0; i < rows.size(); ++i) {
            const auto packed = pack_row(rows[i]);
            std::copy(packed.begin(), packed.end(),
                      frame.begin() + static_cast<ptrdiff_t>(i * kSubImageBytes + transmitted_row(y) * kRowBytes));
        }
    }
    return frame;
}

Image<float> as_transmitted(const Intrinsics& sensor, const Image<float>& picture, const Intrinsics& pinhole) {
    Image<float> seen(sensor.extent);
    for (uint32_t y = 0; y < sensor.extent.height; ++y) {
        for (uint32_t x = 0; x < sensor.extent.width; ++x) {
            const auto ray = ray_of(sensor, x, y);
            if (!ray) continue;
            const glm::dvec2 at = project(pinhole, {-ray->x, ray->y, 1});
            const auto column = static_cast<int>(std::floor(at.x + 0.5)),
                       row = static_cast<int>(std::floor(at.y + 0.5));
            if (!picture.extent().contains(column, row)) continue;
            seen.at(x, y) = picture.at(static_cast<uint32_t>(column), static_cast<uint32_t>(row));
        }
    }
    return seen;
}

Image<float> lit_amplitude(const Image<float>& depth_m, const Image<float>& reflectance, double strength) {
    if (depth_m.extent() != reflectance.extent())
        throw Error("a depth picture of ", depth_m.extent(), " has reflectances of ", reflectance.extent());
    Image<float> amplitude(depth_m.extent());
    for (size_t i = 0; i < amplitude.pixels().size(); ++i) {
        const double z = depth_m.pixels()[i];
        if (z > 0) amplitude.pixels()[i] = static_cast<float>(strength * reflectance.pixels()[i] / (z * z));
    }
    return amplitude;
}

}  // namespace patina::scenes::kinect2
