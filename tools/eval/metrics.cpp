#include "tools/eval/metrics.h"

#include <algorithm>
#include <cmath>

#include "engine/core/srgb.h"
#include "tools/eval/ssim.h"

namespace patina::eval {
namespace {

/// Sums of squared deviations, in linear values and sRGB-encoded ones.
struct Deviations {
    uint64_t count = 0;
    double absolute = 0;
    double squared = 0;
    double squared_srgb = 0;
};

double psnr_db_of(double squared, uint64_t count) { return -10 * std::log10(squared / static_cast<double>(count)); }

/// Over a mask's pixels; where the run has no value it counts as 0.
Deviations deviations_of(const ObjectPictures& pictures, const Image<uint8_t>& mask) {
    Deviations sums;
    for (size_t channel = 0; channel < pictures.truth.size(); ++channel) {
        const std::vector<float>&truth = pictures.truth[channel].pixels(), &run = pictures.run[channel].pixels();
        for (size_t i = 0; i < truth.size(); ++i) {
            if (!mask.pixels()[i]) continue;
            const double value = pictures.filled.pixels()[i] ? static_cast<double>(run[i]) : 0.0;
            const double deviation = value - truth[i];
            ++sums.count;
            sums.absolute += std::abs(deviation);
            sums.squared += deviation * deviation;
            if (!pictures.is_rgb || deviation == 0) continue;
            const double encoded = srgb_encoded(value) - srgb_encoded(truth[i]);
            sums.squared_srgb += encoded * encoded;
        }
    }
    return sums;
}

Scores scores_of(const ObjectPictures& pictures, const Image<uint8_t>& mask, double ssim) {
    const Deviations sums = deviations_of(pictures, mask);
    const auto count = static_cast<double>(sums.count);
    Scores scores{sums.absolute / count, std::sqrt(sums.squared / count), psnr_db_of(sums.squared, sums.count), ssim};
    if (pictures.is_rgb) scores.psnr_srgb_db = psnr_db_of(sums.squared_srgb, sums.count);
    return scores;
}

template <class Element>
double mean_member(std::span<const Element> elements, double Element::*member) {
    double sum = 0;
    for (const Element& element : elements) sum += element.*member;
    return sum / static_cast<double>(elements.size());
}

double mean_psnr_db(const std::vector<double>& psnrs_db) {
    double sum = 0;
    for (const double each : psnrs_db) sum += std::min(each, kPsnrCap_db);
    const bool all_infinite =
        std::all_of(psnrs_db.begin(), psnrs_db.end(), [](double each) { return std::isinf(each); });
    return all_infinite ? std::numeric_limits<double>::infinity() : sum / static_cast<double>(psnrs_db.size());
}

size_t pixels_in(const Image<uint8_t>& mask) {
    return static_cast<size_t>(std::count(mask.pixels().begin(), mask.pixels().end(), 1));
}

/// Over the filled pixels of a part of the region.
std::optional<Scores> seen_scores(const ObjectPictures& pictures) {
    if (pixels_in(pictures.seen) < kSmallestRegion) return std::nullopt;
    const auto similarity = ssim(pictures.truth, pictures.run, pictures.seen, pictures.seen).filled;
    return scores_of(pictures, pictures.seen, similarity.value());
}

}  // namespace

Comparison compare(const ObjectPictures& pictures) {
    const SsimScores similarity = ssim(pictures.truth, pictures.run, pictures.region, pictures.filled);
    Comparison comparison;
    comparison.coverage =
        static_cast<double>(pixels_in(pictures.filled)) / static_cast<double>(pixels_in(pictures.region));
    comparison.all = scores_of(pictures, pictures.region, similarity.all);
    if (similarity.filled) comparison.filled = scores_of(pictures, pictures.filled, *similarity.filled);
    comparison.seen = pictures.seen.empty() ? comparison.filled : seen_scores(pictures);
    return comparison;
}

std::optional<glm::dvec3> mean_over(const Image<uint8_t>& mask, std::span<const Image<float>> channels) {
    const auto pixels = static_cast<double>(pixels_in(mask));
    if (pixels == 0) return std::nullopt;
    glm::dvec3 mean(0);
    for (int i = 0; i < 3; ++i) {
        const std::vector<float>& values = channels[channels.size() == 1 ? 0 : static_cast<size_t>(i)].pixels();
        for (size_t pixel = 0; pixel < values.size(); ++pixel) {
            if (mask.pixels()[pixel]) mean[i] += values[pixel];
        }
    }
    return mean / pixels;
}

Scores mean_of(std::span<const Scores> scores) {
    std::vector<double> linear, srgb;
    for (const Scores& each : scores) {
        linear.push_back(each.psnr_db);
        if (each.psnr_srgb_db) srgb.push_back(*each.psnr_srgb_db);
    }
    Scores mean{mean_member(scores, &Scores::mad), mean_member(scores, &Scores::rmse), mean_psnr_db(linear),
                mean_member(scores, &Scores::ssim)};
    if (!srgb.empty()) mean.psnr_srgb_db = mean_psnr_db(srgb);
    return mean;
}

Comparison mean_of(std::span<const Comparison> comparisons) {
    std::vector<Scores> all, filled, seen;
    for (const Comparison& comparison : comparisons) {
        all.push_back(comparison.all);
        if (comparison.filled) filled.push_back(*comparison.filled);
        if (comparison.seen) seen.push_back(*comparison.seen);
    }
    Comparison mean;
    mean.coverage = mean_member(comparisons, &Comparison::coverage);
    mean.all = mean_of(std::span<const Scores>(all));
    if (!filled.empty()) mean.filled = mean_of(std::span<const Scores>(filled));
    if (!seen.empty()) mean.seen = mean_of(std::span<const Scores>(seen));
    return mean;
}

Averages averages_of(std::span<const FramePoint> frames) {
    std::vector<Comparison> comparisons;
    for (const FramePoint& point : frames) comparisons.push_back(point.comparison);
    const std::span<const Comparison> all(comparisons);
    return {mean_of(all), mean_of(all.last((all.size() + kLastShare - 1) / kLastShare))};
}

Averages mean_of(std::span<const Averages> objects) {
    std::vector<Comparison> mean, at_end;
    for (const Averages& object : objects) {
        mean.push_back(object.mean);
        at_end.push_back(object.at_end);
    }
    return {mean_of(std::span<const Comparison>(mean)), mean_of(std::span<const Comparison>(at_end))};
}

}  // namespace patina::eval
