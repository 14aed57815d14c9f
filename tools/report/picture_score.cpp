#include "tools/report/picture_score.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/core/error.h"
#include "tools/report/drawing.h"

namespace patina {

namespace {

double psnr_db(double squared_error, size_t values) {
    constexpr double kMost_db = 100;
    if (values == 0) return 0;
    const double mean = squared_error / static_cast<double>(values);
    return mean > 0 ? std::min(-10 * std::log10(mean), kMost_db) : kMost_db;
}

double squared(glm::dvec3 v) { return glm::dot(v, v); }

double median_of(std::span<const PictureScore> scores, double PictureScore::*member) {
    std::vector<double> values;
    for (const PictureScore& score : scores) values.push_back(score.*member);
    std::sort(values.begin(), values.end());
    return values.empty() ? 0 : (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

}  // namespace

PictureScore score_picture(const Image<glm::vec3>& seen, const Image<glm::vec4>& predicted) {
    if (seen.extent() != predicted.extent()) {
        throw Error("a picture of ", seen.extent(), " cannot be scored against one of ", predicted.extent());
    }
    double linear = 0, srgb = 0;
    size_t known = 0;
    for (size_t i = 0; i < seen.pixels().size(); ++i) {
        const glm::vec4& pixel = predicted.pixels()[i];
        if (!(pixel.a > 0)) continue;
        ++known;
        const glm::vec3 guess = glm::clamp(glm::vec3(pixel), 0.0f, 1.0f);
        const glm::vec3 truth = glm::clamp(seen.pixels()[i], 0.0f, 1.0f);
        linear += squared(glm::dvec3(guess) - glm::dvec3(truth));
        srgb += squared((glm::dvec3(color_pixel(guess)) - glm::dvec3(color_pixel(truth))) / 255.0);
    }
    return {static_cast<double>(known) / static_cast<double>(std::max<size_t>(seen.pixels().size(), 1)),
            psnr_db(linear, 3 * known), psnr_db(srgb, 3 * known)};
}

glm::vec3 gain_between(const Image<glm::vec3>& seen, const Image<glm::vec4>& predicted) {
    constexpr float kDarkest = 0.015f, kBrightest = 0.9f;
    constexpr size_t kFewest = 100;
    glm::vec3 gain(1);
    for (glm::length_t c = 0; c < 3; ++c) {
        std::vector<float> ratios;
        for (size_t i = 0; i < seen.pixels().size(); ++i) {
            const float a = seen.pixels()[i][c], b = predicted.pixels()[i][c];
            const bool counts = predicted.pixels()[i].a > 0 && std::min(a, b) > kDarkest && std::max(a, b) < kBrightest;
            if (counts) ratios.push_back(a / b);
        }
        if (ratios.size() < kFewest) continue;
        const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
        std::nth_element(ratios.begin(), middle, ratios.end());
        gain[c] = *middle;
    }
    return gain;
}

PictureScore median_of(std::span<const PictureScore> scores) {
    return {median_of(scores, &PictureScore::coverage), median_of(scores, &PictureScore::psnr_linear_db),
            median_of(scores, &PictureScore::psnr_srgb_db)};
}

}  // namespace patina
