#include "tools/eval/metrics.h"

#include <algorithm>
#include <cmath>

#include "tools/eval/ssim.h"

namespace patina::eval {
namespace {

/// Sums of deviations over pixels and channels.
struct Deviations {
    uint64_t count = 0;
    double absolute = 0;
    double squared = 0;

    void add(double deviation) {
        ++count;
        absolute += std::abs(deviation);
        squared += deviation * deviation;
    }
};

Scores scores_of(const Deviations& deviations, double ssim) {
    const auto count = static_cast<double>(deviations.count);
    const double mse = deviations.squared / count;
    return {deviations.absolute / count, std::sqrt(mse), -10 * std::log10(mse), ssim};
}

template <class Element>
double mean_member(std::span<const Element> elements, double Element::*member) {
    double sum = 0;
    for (const Element& element : elements) sum += element.*member;
    return sum / static_cast<double>(elements.size());
}

double mean_psnr_db(std::span<const Scores> scores) {
    double sum = 0;
    for (const Scores& each : scores) sum += std::min(each.psnr_db, kPsnrCap_db);
    const bool all_infinite =
        std::all_of(scores.begin(), scores.end(), [](const Scores& each) { return std::isinf(each.psnr_db); });
    return all_infinite ? std::numeric_limits<double>::infinity() : sum / static_cast<double>(scores.size());
}

double count(const Image<uint8_t>& mask) {
    return static_cast<double>(std::count(mask.pixels().begin(), mask.pixels().end(), 1));
}

}  // namespace

Comparison compare(const ObjectPictures& pictures) {
    Deviations filled, all;
    for (size_t channel = 0; channel < pictures.truth.size(); ++channel) {
        const std::vector<float>&truth = pictures.truth[channel].pixels(), &run = pictures.run[channel].pixels();
        for (size_t i = 0; i < truth.size(); ++i) {
            if (!pictures.region.pixels()[i]) continue;
            const bool has_value = pictures.filled.pixels()[i];
            const double deviation = (has_value ? static_cast<double>(run[i]) : 0.0) - truth[i];
            all.add(deviation);
            if (has_value) filled.add(deviation);
        }
    }
    const SsimScores similarity = ssim(pictures.truth, pictures.run, pictures.region, pictures.filled);
    Comparison comparison;
    comparison.coverage = count(pictures.filled) / count(pictures.region);
    comparison.unfilled_as_zero = scores_of(all, similarity.unfilled_as_zero);
    if (similarity.filled) comparison.filled = scores_of(filled, *similarity.filled);
    return comparison;
}

std::optional<glm::dvec3> mean_over(const Image<uint8_t>& mask, std::span<const Image<float>> channels) {
    const double pixels = count(mask);
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
    return {mean_member(scores, &Scores::mad), mean_member(scores, &Scores::rmse), mean_psnr_db(scores),
            mean_member(scores, &Scores::ssim)};
}

Comparison mean_of(std::span<const Comparison> comparisons) {
    std::vector<Scores> filled, all;
    for (const Comparison& comparison : comparisons) {
        if (comparison.filled) filled.push_back(*comparison.filled);
        all.push_back(comparison.unfilled_as_zero);
    }
    Comparison mean;
    mean.coverage = mean_member(comparisons, &Comparison::coverage);
    if (!filled.empty()) mean.filled = mean_of(std::span<const Scores>(filled));
    mean.unfilled_as_zero = mean_of(std::span<const Scores>(all));
    return mean;
}

}  // namespace patina::eval
