#include "tests/reference/reflectance/surface_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace patina::reference {

namespace {

using SumKey = std::array<int, 7>;  // kind of sum, then what it is of

struct Mean {
    glm::dvec3 reflected{0}, light{0};
    double records = 0, impossible = 0, asked = 0;
};

struct Place {
    std::array<double, 4> at{};  // position, brightness
    std::array<double, 2> tint{};
    int side = 0;
};

int nearest(double value) { return static_cast<int>(std::lround(value)); }

Place place_of(const ToldAlbedo& record) {
    Place place;
    const glm::dvec3 size = glm::abs(record.normal), reflected = record.raw_kd * record.light;
    int axis = 2;
    if (size.x >= std::max(size.y, size.z))
        axis = 0;
    else if (size.y >= size.z)
        axis = 1;
    place.side = 2 * axis + (record.normal[axis] < 0 ? 1 : 0);
    std::array<double, 3> logs{};
    for (int c = 0; c < 3; ++c) logs[static_cast<size_t>(c)] = std::log(reflected[c] + 0.01);
    for (int i = 0; i < 3; ++i) place.at[static_cast<size_t>(i)] = record.point_m[i] / 0.16;
    place.at[3] = std::accumulate(logs.begin(), logs.end(), 0.0) / 3 / 0.25;
    place.tint = {(logs[0] - logs[1]) / 0.3, (logs[2] - logs[1]) / 0.3};
    return place;
}

double mean(glm::dvec3 v) { return (v.x + v.y + v.z) / 3; }

double asked_of(const ToldAlbedo& record) { return mean(record.raw_kd * record.light) / mean(record.light); }

bool is_impossible(const ToldAlbedo& record) { return record.sure && asked_of(record) > 2; }

bool tells(const ToldAlbedo& record) {
    const glm::dvec3 reflected = record.raw_kd * record.light;
    return record.sure && std::max({reflected.x, reflected.y, reflected.z}) < 0.95;
}

/// The mean over the corners of a cell of so many dimensions around a place, those that there are.
template <size_t N>
Mean interpolated(const std::map<SumKey, Mean>& sums, const std::array<double, N>& at, SumKey cell, size_t first) {
    Mean all;
    for (size_t corner = 0; corner < size_t{1} << N; ++corner) {
        double share = 1;
        for (size_t i = 0; i < N; ++i) {
            const double low = std::floor(at[i]), t = at[i] - low;
            const bool high = (corner >> i & 1) != 0;
            cell[first + i] = static_cast<int>(low) + (high ? 1 : 0);
            share *= high ? t : 1 - t;
        }
        const auto found = sums.find(cell);
        if (found == sums.end()) continue;
        all.reflected += share * found->second.reflected;
        all.light += share * found->second.light;
        all.records += share * found->second.records;
        all.impossible += share * found->second.impossible;
        all.asked += share * found->second.asked;
    }
    return all;
}

constexpr int kLook = 0, kTint = 1, kLight = 2;

}  // namespace

std::vector<glm::dvec3> surface_albedo(const std::vector<ToldAlbedo>& records) {
    std::map<SumKey, Mean> sums;
    for (const ToldAlbedo& record : records) {
        const Place place = place_of(record);
        const int x = nearest(place.at[0]), y = nearest(place.at[1]), z = nearest(place.at[2]);
        const int red = nearest(place.tint[0]), blue = nearest(place.tint[1]);
        const bool impossible = is_impossible(record);
        if (tells(record) || impossible) {
            Mean& light = sums[{kLight, x, y, z, place.side, 0, 0}];
            light.records += 1;
            light.impossible += impossible ? 1 : 0;
            light.asked += impossible ? asked_of(record) : 0;
        }
        if (!tells(record) || impossible) continue;
        Mean& look = sums[{kLook, x, y, z, nearest(place.at[3]), place.side, 64 * (red + 16) + blue + 16}];
        look.reflected += record.raw_kd * record.light;
        look.light += record.light;
        Mean& tint = sums[{kTint, red, blue, static_cast<int>(record.label), 0, 0, 0}];
        tint.reflected += glm::min(record.raw_kd, 1.0);
        tint.light += glm::dvec3(1);
        tint.records += 1;
    }
    std::vector<glm::dvec3> around;
    for (const ToldAlbedo& record : records) {
        around.emplace_back(0);
        const bool impossible = is_impossible(record);
        if (!tells(record) && !impossible) continue;
        const Place place = place_of(record);
        const std::array<double, 3> at{place.at[0], place.at[1], place.at[2]};
        const Mean light = interpolated(sums, at, {kLight, 0, 0, 0, place.side, 0, 0}, 1);
        const bool missing = light.impossible >= 0.05 * light.records && light.impossible >= 1;
        const double more = missing ? std::max(light.asked / light.impossible / 0.8, 1.0) : 1.0;
        const int tint = 64 * (nearest(place.tint[0]) + 16) + nearest(place.tint[1]) + 16;
        const Mean look = interpolated(sums, place.at, {kLook, 0, 0, 0, 0, place.side, tint}, 1);
        const Mean alike = interpolated(sums, place.tint, {kTint, 0, 0, static_cast<int>(record.label), 0, 0, 0}, 1);
        for (int c = 0; c < 3; ++c) {
            const double told = impossible ? record.raw_kd[c] : std::min(look.reflected[c] / look.light[c], 1.0);
            const double near = told / more, deviation = (0.3 + 0.3 * (more - 1)) * near + 0.015;
            const double own = 1 / (deviation * deviation);
            const double weight = record.label != 0 && alike.records >= 3 ? 100 : 0;
            const double segment = weight > 0 ? alike.reflected[c] / alike.light[c] : 0;
            around.back()[c] = std::clamp((own * near + weight * segment) / (own + weight), 0.0, 1.0);
        }
    }
    return around;
}

}  // namespace patina::reference
