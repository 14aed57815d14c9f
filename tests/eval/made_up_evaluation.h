#pragma once

#include <cmath>

#include "tools/eval/result.h"

namespace patina::test {

/// Errors of 0.01 times `error`, and what follows from them.
inline eval::Scores scores_of(double error) {
    return {0.01 * error, 0.0125 * error, 40 - error, 1 - 0.005 * error, {}};
}

/// As scores_of, on `coverage` of the object; the rest as zero costs 0.1 of what is missing. What was seen often is
/// half as wrong.
inline eval::Comparison comparison_of(double error, double coverage) {
    eval::Scores zeros = scores_of(error);
    zeros.mad += 0.1 * (1 - coverage);
    return {coverage, zeros, scores_of(error), scores_of(0.5 * error)};
}

/// At the end a fifth of the error is left.
inline eval::Averages averages_of(double error, double coverage) {
    return {comparison_of(error, coverage), comparison_of(0.2 * error, coverage)};
}

/// An object that is out of sight in a fifth of the frames, with a reconstruction that closes in on the truth.
inline eval::ObjectQuantity quantity_of(const std::vector<uint32_t>& frames, double truth, double error,
                                        double coverage) {
    eval::ObjectQuantity quantity{averages_of(error, coverage), {}};
    for (size_t i = 0; i < frames.size(); ++i) {
        if (i * 5 / frames.size() == 2) continue;
        const double wave = std::cos(static_cast<double>(i) / 4) / (1 + 0.1 * static_cast<double>(i));
        const double off = 0.01 * error * (1 + wave);
        eval::FramePoint point{frames[i], glm::dvec3(truth), glm::dvec3(truth + off),
                               comparison_of(100 * off, coverage)};
        if (i == 0) {  // seen, but not yet reconstructed
            point.run_mean.reset();
            point.comparison = {0, scores_of(100 * truth), {}, {}};
        }
        quantity.frames.push_back(point);
    }
    return quantity;
}

/// A result with something in every field, of so many objects in so many frames.
inline eval::Evaluation full_evaluation(size_t objects = 4, uint32_t frames = 40) {
    eval::Evaluation evaluation;
    evaluation.sequence = "recordings/bunnies";
    evaluation.run = "out/<b>run</b>";
    evaluation.extent = {512, 424};
    for (uint32_t i = 0; i < frames; ++i) evaluation.frames.push_back(10 * i);
    evaluation.truth_frames = frames;
    evaluation.run_frames = frames + 5;
    evaluation.seen_frames = 5;
    evaluation.seen_share = 0.953125;
    const std::vector<std::string> names = {"floor", "yellow <script> figure", "Küche & \"more\"", "orange figure"};
    for (size_t k = 0; k < objects; ++k) {
        eval::ObjectResult object;
        object.id = static_cast<uint32_t>(k + 1);
        object.name = k < names.size() ? names[k] : "chair " + std::to_string(k);
        object.pixels = 123456 + k;
        object.seen_pixels = 120000 + k;
        for (const eval::Quantity quantity : eval::kQuantities) {
            const double error = static_cast<double>(k) + 2 * static_cast<double>(quantity) + 1;
            object.quantities[quantity] =
                quantity_of(evaluation.frames, 0.1 + 0.2 * static_cast<double>(k % 4), error, 0.975);
        }
        object.segmentation = eval::ObjectSegmentation{7, 0.875, 0.9375, 2, 0.03125};
        evaluation.objects.push_back(std::move(object));
    }
    for (const eval::Quantity quantity : eval::kQuantities) {
        evaluation.object_means[quantity] = averages_of(3 + static_cast<double>(quantity), 0.975);
    }
    evaluation.depth_mm = eval::PixelErrors{5000, 0.984375, 1.5, 2.25, 4.75, 3.125};
    evaluation.normal_deg = eval::PixelErrors{5000, 0.984375, 0.5, 1.25, 2.75, 1.625};
    evaluation.segmentation = eval::SegmentationResult{0.875, 0.9375, 2.5, 0.03125};
    evaluation.trajectory =
        eval::TrajectoryErrors{40,
                               39,
                               39,
                               0.0125,
                               0.03,
                               0.5,
                               eval::RelativePoseError{38, 0.033, 0.001, 0.0008, 0.002, 0.01, 0.008, 0.02},
                               eval::RelativePoseError{9, 1.0, 0.004, 0.003, 0.005, 0.06, 0.05, 0.07}};
    evaluation.states = eval::FrameStates{36, 3, 1};
    evaluation.lights = eval::LightErrors{0.5,
                                          {{{1, -2, 3}, {4, 5, 6}}, {{-1, -2, 3}, {1, 1, 1}}},
                                          {{{9, 9, 9}, {1, 1, 1}}, {{1.02, -2, 3}, {8, 10, 12}}},
                                          {{0, 1, 0.02, {1, 1, 1}, {0.125, 0, 0}}},
                                          {1},
                                          {0},
                                          2};
    return evaluation;
}

/// What a run without materials gives: the refined colour, depth and normals.
inline eval::Evaluation geometry_only() {
    eval::Evaluation evaluation = full_evaluation();
    for (const eval::Quantity quantity : eval::kQuantities) {
        if (quantity == eval::Quantity::kRgb) continue;
        evaluation.object_means[quantity].reset();
        for (eval::ObjectResult& object : evaluation.objects) object.quantities[quantity].reset();
    }
    for (eval::ObjectResult& object : evaluation.objects) object.segmentation.reset();
    evaluation.segmentation.reset();
    evaluation.states.reset();
    evaluation.lights.reset();
    return evaluation;
}

}  // namespace patina::test
