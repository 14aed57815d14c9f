#include "tools/eval/lights.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/core/error.h"

namespace patina::eval {
namespace {

void match(LightErrors& errors) {
    std::vector<std::tuple<double, size_t, size_t>> pairs;  // distance first: sorts nearest first, ties by index
    for (size_t t = 0; t < errors.truth.size(); ++t) {
        for (size_t r = 0; r < errors.run.size(); ++r) {
            const double distance_m = glm::distance(errors.truth[t].position_m, errors.run[r].position_m);
            if (distance_m <= errors.radius_m) pairs.emplace_back(distance_m, t, r);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<bool> found(errors.truth.size()), used(errors.run.size());
    for (const auto& [distance_m, t, r] : pairs) {
        if (found[t] || used[r]) continue;
        found[t] = used[r] = true;
        errors.matches.push_back({t, r, distance_m, {}, {}});
    }
    for (size_t t = 0; t < found.size(); ++t) {
        if (!found[t]) errors.missed.push_back(t);
    }
    for (size_t r = 0; r < used.size(); ++r) {
        if (!used[r]) errors.invented.push_back(r);
    }
    std::sort(errors.matches.begin(), errors.matches.end(),
              [](const LightMatch& a, const LightMatch& b) { return a.truth < b.truth; });
}

/// The geometric mean of run / truth over all channels that are positive in both; 1 without any.
double common_factor(const LightErrors& errors) {
    double sum = 0;
    int count = 0;
    for (const LightMatch& each : errors.matches) {
        for (int i = 0; i < 3; ++i) {
            const double truth = errors.truth[each.truth].intensity[i], run = errors.run[each.run].intensity[i];
            if (!(truth > 0 && run > 0)) continue;
            sum += std::log(run / truth);
            ++count;
        }
    }
    return count > 0 ? std::exp(sum / count) : 1;
}

/// |run - truth| / truth per channel: infinite for light in a channel that truly has none.
glm::dvec3 relative_error(glm::dvec3 truth, glm::dvec3 run) {
    glm::dvec3 error(0);
    for (int i = 0; i < 3; ++i) {
        if (run[i] != truth[i]) error[i] = std::abs(run[i] - truth[i]) / truth[i];
    }
    return error;
}

}  // namespace

LightErrors compare_lights(std::span<const Light> truth, std::span<const Light> run, double radius_m) {
    LightErrors errors;
    errors.radius_m = radius_m;
    errors.truth.assign(truth.begin(), truth.end());
    errors.run.assign(run.begin(), run.end());
    match(errors);
    errors.common_factor = common_factor(errors);
    for (LightMatch& each : errors.matches) {
        const glm::dvec3 true_intensity = errors.truth[each.truth].intensity;
        const glm::dvec3 intensity = errors.run[each.run].intensity;
        each.intensity_error = relative_error(true_intensity, intensity);
        each.intensity_error_after_factor = relative_error(true_intensity, intensity / errors.common_factor);
    }
    return errors;
}

}  // namespace patina::eval
