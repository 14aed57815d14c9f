#include "tests/reference/photometry/estimate_gains.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace patina::reference {

namespace {

struct Sample {
    double stops;
    double weight;
};

bool same_plane(const ComparedColors& frame, glm::ivec2 at, glm::ivec2 there) {
    if (!frame.position_m.extent().contains(there.x, there.y)) return false;
    const auto load = [](const auto& image, glm::ivec2 p) {
        return glm::dvec4(image.at(static_cast<uint32_t>(p.x), static_cast<uint32_t>(p.y)));
    };
    const glm::dvec4 here = load(frame.position_m, at), other = load(frame.position_m, there);
    const double off = glm::dot(glm::dvec3(load(frame.normal, at)), glm::dvec3(other) - glm::dvec3(here));
    return other.w > 0 && std::abs(off) <= 0.01 + 0.01 * here.w;
}

/// The four pixels of the picture around the centre of a pixel of the cast, and their mean by distance.
struct Pixels {
    std::array<glm::dvec4, 4> all{};
    glm::dvec4 mean{0};
};

Pixels pixels_at(const ComparedColors& frame, glm::uvec2 at) {
    const Extent2D cast = frame.position_m.extent(), extent = frame.color.extent();
    const glm::dvec2 center((at.x + 0.5) * extent.width / cast.width - 0.5,
                            (at.y + 0.5) * extent.height / cast.height - 0.5);
    Pixels pixels;
    for (size_t i = 0; i < 4; ++i) {
        const glm::ivec2 p = glm::ivec2(glm::floor(center)) + glm::ivec2(i % 2, i / 2);
        if (!extent.contains(p.x, p.y)) continue;
        const glm::dvec2 share = 1.0 - glm::abs(center - glm::dvec2(p));
        pixels.all[i] = glm::dvec4(frame.color.at(static_cast<uint32_t>(p.x), static_cast<uint32_t>(p.y)));
        pixels.mean += share.x * share.y * pixels.all[i];
    }
    return pixels;
}

void add_samples(std::array<std::vector<Sample>, 3>& samples, const ComparedColors& frame, glm::uvec2 at,
                 double least_cosine) {
    const glm::dvec4 point(frame.position_m.at(at.x, at.y)), model(frame.model_color.at(at.x, at.y));
    const glm::dvec3 normal(frame.normal.at(at.x, at.y)), toward = frame.camera_m - glm::dvec3(point);
    if (point.w <= 0 || model.a <= 0 || glm::dot(normal, toward) < least_cosine * glm::length(toward)) return;
    const glm::ivec2 here(at);
    for (const glm::ivec2 side : {glm::ivec2(-1, 0), {1, 0}, {0, -1}, {0, 1}}) {
        if (!same_plane(frame, here, here + side)) return;
    }
    const Pixels pixels = pixels_at(frame, at);
    for (const glm::dvec4& pixel : pixels.all) {
        if (pixel.a != 1) return;
    }
    for (glm::length_t c = 0; c < 3; ++c) {
        const auto channel = [&](const auto& a, const auto& b) { return a[c] < b[c]; };
        const auto [low, high] = std::minmax_element(pixels.all.begin(), pixels.all.end(), channel);
        if (std::min((*low)[c], model[c]) < 0.015 || std::max((*high)[c], model[c]) > 0.7) continue;
        if ((*high)[c] > 1.25 * (*low)[c]) continue;
        const double mean = pixels.mean[c];
        const double stops = std::log2(mean / model[c]);
        if (std::abs(stops) < 2)
            samples[static_cast<size_t>(c)].push_back({stops, 64 * std::sqrt(mean * model[c]) + 0.5});
    }
}

double quantile(const std::vector<Sample>& sorted, double share) {
    double total = 0, sum = 0;
    for (const Sample& s : sorted) total += s.weight;
    for (const Sample& s : sorted) {
        sum += s.weight;
        if (sum >= share * total) return s.stops;
    }
    return sorted.back().stops;
}

double robust_center(std::vector<Sample> samples) {
    std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.stops < b.stops; });
    double center = quantile(samples, 0.5);
    const double reach = std::max(3.5 * (quantile(samples, 0.65) - quantile(samples, 0.35)), 6 / 128.0);
    for (int step = 0; step < 3; ++step) {
        double sum = 0, weights = 0;
        for (const Sample& s : samples) {
            const double scaled = (s.stops - center) / reach;
            const double weight = std::abs(scaled) < 1 ? s.weight * std::pow(1 - scaled * scaled, 2) : 0;
            sum += weight * (s.stops - center);
            weights += weight;
        }
        center += sum / std::max(weights, 1.0);
    }
    return center;
}

}  // namespace

std::array<ChannelGain, 3> estimate_gains(const ComparedColors& frame, glm::dvec3 before, double max_angle_degrees,
                                          size_t min_samples) {
    std::array<std::vector<Sample>, 3> samples;
    for (uint32_t y = 0; y < frame.position_m.extent().height; ++y) {
        for (uint32_t x = 0; x < frame.position_m.extent().width; ++x)
            add_samples(samples, frame, {x, y}, std::cos(glm::radians(max_angle_degrees)));
    }
    std::array<ChannelGain, 3> gains;
    for (size_t c = 0; c < 3; ++c) {
        const bool enough = samples[c].size() >= min_samples;
        gains[c] = {enough ? std::exp2(robust_center(samples[c])) : before[static_cast<glm::length_t>(c)],
                    samples[c].size()};
    }
    return gains;
}

}  // namespace patina::reference
