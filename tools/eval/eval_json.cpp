#include "tools/eval/eval_json.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace patina::eval {
namespace {

using Json = nlohmann::ordered_json;

/// Members of one struct, so that each conversion finds all others whatever their order.
struct Convert {
    static Json to_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

    /// An infinite PSNR becomes null: JSON has no infinity.
    static Json to_json(const Scores& scores) {
        Json json = {{"mad", scores.mad}, {"rmse", scores.rmse}, {"psnr_db", scores.psnr_db}, {"ssim", scores.ssim}};
        if (scores.psnr_srgb_db) json["psnr_srgb_db"] = *scores.psnr_srgb_db;
        return json;
    }

    template <class Value>
    static Json or_null(const std::optional<Value>& value) {
        return value ? to_json(*value) : Json();
    }

    static Json to_json(const Comparison& comparison) {
        return {{"coverage", comparison.coverage},
                {"all", to_json(comparison.all)},
                {"filled", or_null(comparison.filled)},
                {"seen", or_null(comparison.seen)}};
    }

    static Json to_json(const Averages& averages) {
        return {{"mean", to_json(averages.mean)}, {"final", to_json(averages.at_end)}};
    }

    /// What `value` gives for each frame, as one list.
    template <class Points, class ValueOf>
    static Json column(const Points& points, ValueOf&& value_of) {
        Json list = Json::array();
        for (const auto& point : points) list.push_back(value_of(point));
        return list;
    }

    /// One list per score instead of one object per frame: short, and what a plot needs.
    static Json score_columns(const std::vector<FramePoint>& frames, Pixels pixels) {
        const auto list = [&](const auto& value_of) {
            return column(frames, [&](const FramePoint& point) {
                const Scores* scores = point.comparison.over(pixels);
                return scores ? Json(value_of(*scores)) : Json();
            });
        };
        Json json = {{"mad", list([](const Scores& scores) { return scores.mad; })},
                     {"rmse", list([](const Scores& scores) { return scores.rmse; })},
                     {"psnr_db", list([](const Scores& scores) { return scores.psnr_db; })},
                     {"ssim", list([](const Scores& scores) { return scores.ssim; })}};
        if (!frames.empty() && frames.front().comparison.all.psnr_srgb_db) {
            json["psnr_srgb_db"] =
                list([](const Scores& scores) { return scores.psnr_srgb_db ? Json(*scores.psnr_srgb_db) : Json(); });
        }
        return json;
    }

    static Json to_json(const std::vector<FramePoint>& frames) {
        Json json = {
            {"frame", column(frames, [](const FramePoint& point) { return Json(point.frame); })},
            {"truth_mean", column(frames, [](const FramePoint& point) { return to_json(point.truth_mean); })},
            {"run_mean", column(frames, [](const FramePoint& point) { return or_null(point.run_mean); })},
            {"coverage", column(frames, [](const FramePoint& point) { return Json(point.comparison.coverage); })}};
        for (const Pixels pixels : kPixels) json[name_of(pixels)] = score_columns(frames, pixels);
        return json;
    }

    static Json to_json(const ObjectQuantity& quantity) {
        Json json = to_json(static_cast<const Averages&>(quantity));
        json["frames"] = to_json(quantity.frames);
        return json;
    }

    template <class Value>
    static Json to_json(const PerQuantity<std::optional<Value>>& values) {
        Json object = Json::object();
        for (const Quantity quantity : kQuantities) object[name_of(quantity)] = or_null(values[quantity]);
        return object;
    }

    static Json to_json(const ObjectSegmentation& segmentation) {
        return {{"best_label", segmentation.best_label ? Json(*segmentation.best_label) : Json()},
                {"iou", segmentation.iou},
                {"best_label_share", segmentation.best_label_share},
                {"labels", segmentation.labels},
                {"foreign_share", segmentation.foreign_share}};
    }

    static Json to_json(const IntervalHits& hits) {
        if (hits.values == 0) return Json();
        return {{"covered", hits.within}, {"total", hits.values}, {"mean_width", hits.mean_width()}};
    }

    static Json to_json(const IntervalCounts& counts) {
        return {{"probability", counts.probability},
                {"kd", to_json(counts.kd)},
                {"ks", to_json(counts.ks)},
                {"alpha", to_json(counts.alpha)}};
    }

    static Json to_json(const ObjectIntervals& intervals) {
        return {{"confidence", intervals.confidence ? Json(*intervals.confidence) : Json()},
                {"levels", list_of(intervals.levels)}};
    }

    static Json to_json(const ObjectResult& object) {
        return {{"id", object.id},
                {"name", object.name},
                {"pixels", object.pixels},
                {"seen_pixels", object.seen_pixels},
                {"quantities", to_json(object.quantities)},
                {"segmentation", or_null(object.segmentation)},
                {"intervals", or_null(object.intervals)}};
    }

    static Json to_json(const SegmentationResult& segmentation) {
        return {{"iou", segmentation.iou},
                {"best_label_share", segmentation.best_label_share},
                {"labels", segmentation.labels},
                {"foreign_share", segmentation.foreign_share}};
    }

    static Json to_json(const PixelErrors& errors) {
        return {{"pixels", errors.pixels}, {"coverage", errors.coverage}, {"median", errors.median},
                {"mean", errors.mean},     {"p90", errors.p90},           {"rmse", errors.rmse}};
    }

    static Json to_json(const RelativePoseError& error) {
        return {{"pairs", error.pairs},
                {"step_s", error.step_s},
                {"translation_rmse_m", error.translation_rmse_m},
                {"translation_median_m", error.translation_median_m},
                {"translation_max_m", error.translation_max_m},
                {"rotation_rmse_deg", error.rotation_rmse_deg},
                {"rotation_median_deg", error.rotation_median_deg},
                {"rotation_max_deg", error.rotation_max_deg}};
    }

    static Json to_json(const TrajectoryErrors& errors) {
        return {{"truth_poses", errors.truth_poses},
                {"run_poses", errors.run_poses},
                {"poses", errors.poses},
                {"ate_rmse_m", errors.ate_rmse_m},
                {"ate_max_m", errors.ate_max_m},
                {"unaligned_rmse_m", errors.unaligned_rmse_m},
                {"per_frame", or_null(errors.per_frame)},
                {"per_second", or_null(errors.per_second)}};
    }

    static Json to_json(const FrameStates& states) {
        return {{"tracking", states.tracking}, {"weak", states.weak}, {"lost", states.lost}};
    }

    static Json to_json(const Light& light) {
        Json json{{"position", to_json(light.position_m)}, {"intensity", to_json(light.intensity)}};
        if (is_flat(light)) json["axis"] = to_json(light.axis);
        return json;
    }

    static Json to_json(const LightMatch& match) {
        return {{"truth", match.truth},
                {"run", match.run},
                {"position_error_m", match.position_error_m},
                {"intensity_error", to_json(match.intensity_error)},
                {"intensity_error_after_factor", to_json(match.intensity_error_after_factor)}};
    }

    template <class Value>
    static Json list_of(const std::vector<Value>& values) {
        return column(values, [](const Value& value) { return to_json(value); });
    }

    static Json to_json(const Views& views) {
        return {{"frames", views.frames},
                {"objects", list_of(views.objects)},
                {"object_means", to_json(views.object_means)},
                {"depth_mm", or_null(views.depth_mm)},
                {"normal_deg", or_null(views.normal_deg)}};
    }

    static Json to_json(const LightErrors& lights) {
        return {{"radius_m", lights.radius_m},          {"truth", list_of(lights.truth)}, {"run", list_of(lights.run)},
                {"matches", list_of(lights.matches)},   {"missed", lights.missed},        {"invented", lights.invented},
                {"common_factor", lights.common_factor}};
    }
};

bool is_list_of_lists(const Json& json) {
    return json.is_array() &&
           std::ranges::all_of(json, [](const Json& item) { return item.is_primitive() || is_list_of_lists(item); });
}

/// What reads best on one line: lists of numbers, and objects that hold nothing but single values.
bool is_line(const Json& json) {
    return json.is_primitive() || is_list_of_lists(json) ||
           (json.is_object() && std::ranges::all_of(json, [](const Json& item) { return item.is_primitive(); }));
}

std::string line_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

void append(std::string& text, const Json& json, const std::string& indent) {
    if (is_line(json)) {
        text += line_of(json);
        return;
    }
    const std::string inner = indent + "  ";
    text += json.is_object() ? '{' : '[';
    const char* separator = "\n";
    for (const auto& [key, value] : json.items()) {
        text += separator + inner;
        if (json.is_object()) text += line_of(Json(key)) + ": ";
        append(text, value, inner);
        separator = ",\n";
    }
    text += '\n' + indent + (json.is_object() ? '}' : ']');
}

}  // namespace

std::string eval_json(const Evaluation& evaluation) {
    const Json json = {{"format", "patina-eval"},
                       {"version", 2},
                       {"sequence", evaluation.sequence},
                       {"run", evaluation.run},
                       {"width", evaluation.extent.width},
                       {"height", evaluation.extent.height},
                       {"frames", evaluation.frames},
                       {"truth_frames", evaluation.truth_frames},
                       {"run_frames", evaluation.run_frames},
                       {"seen_frames", evaluation.seen_frames},
                       {"seen_share", evaluation.seen_share},
                       {"objects", Convert::list_of(evaluation.objects)},
                       {"object_means", Convert::to_json(evaluation.object_means)},
                       {"depth_mm", Convert::or_null(evaluation.depth_mm)},
                       {"normal_deg", Convert::or_null(evaluation.normal_deg)},
                       {"segmentation", Convert::or_null(evaluation.segmentation)},
                       {"intervals", evaluation.intervals.empty() ? Json() : Convert::list_of(evaluation.intervals)},
                       {"trajectory", Convert::or_null(evaluation.trajectory)},
                       {"states", Convert::or_null(evaluation.states)},
                       {"lights", Convert::or_null(evaluation.lights)},
                       {"finished_model", Convert::or_null(evaluation.finished)},
                       {"novel", Convert::or_null(evaluation.novel)},
                       {"relit", Convert::or_null(evaluation.relit)}};
    std::string text;
    append(text, json, "");
    return text + '\n';
}

}  // namespace patina::eval
