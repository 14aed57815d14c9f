#include "tools/eval/eval_json.h"

#include <limits>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/eval/made_up_evaluation.h"

namespace patina::eval::eval_json_test {
namespace {

using nlohmann::json;
using test::full_evaluation;
using testing::ElementsAre;
using testing::HasSubstr;

json parsed(const Evaluation& evaluation) { return json::parse(eval_json(evaluation)); }

template <class Json>
std::vector<std::string> keys_of(const Json& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.push_back(key);
    return keys;
}

void expect_equal(const json& got, const Scores& scores) {
    EXPECT_EQ(got["mad"], scores.mad);
    EXPECT_EQ(got["rmse"], scores.rmse);
    EXPECT_EQ(got["psnr_db"], scores.psnr_db);
    EXPECT_EQ(got["ssim"], scores.ssim);
}

void expect_equal(const json& got, const Comparison& comparison) {
    EXPECT_EQ(got["coverage"], comparison.coverage);
    expect_equal(got["all"], comparison.all);
    expect_equal(got["filled"], *comparison.filled);
    expect_equal(got["seen"], *comparison.seen);
}

void expect_equal(const json& got, const Averages& averages) {
    expect_equal(got["mean"], averages.mean);
    expect_equal(got["final"], averages.at_end);
}

json list_of(glm::dvec3 v) { return {v.x, v.y, v.z}; }

void expect_equal(const json& columns, size_t row, const FramePoint& point) {
    EXPECT_EQ(columns["frame"][row], point.frame);
    EXPECT_EQ(columns["truth_mean"][row], list_of(point.truth_mean));
    EXPECT_EQ(columns["run_mean"][row], point.run_mean ? list_of(*point.run_mean) : json());
    EXPECT_EQ(columns["coverage"][row], point.comparison.coverage);
    const auto& filled = point.comparison.filled;
    EXPECT_EQ(columns["filled"]["mad"][row], filled ? json(filled->mad) : json());
    EXPECT_EQ(columns["filled"]["ssim"][row], filled ? json(filled->ssim) : json());
    EXPECT_EQ(columns["all"]["rmse"][row], point.comparison.all.rmse);
    EXPECT_EQ(columns["all"]["psnr_db"][row], point.comparison.all.psnr_db);
}

TEST(EvalJson, ReadsBackAsMeasured) {
    const Evaluation evaluation = full_evaluation(3, 30);
    const json got = parsed(evaluation);
    EXPECT_EQ(got["run"], evaluation.run);
    EXPECT_EQ(got["frames"], json(evaluation.frames));
    EXPECT_EQ(got["seen_frames"], 5);
    EXPECT_EQ(got["seen_share"], 0.953125);
    ASSERT_EQ(got["objects"].size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
        const ObjectResult& object = evaluation.objects[i];
        EXPECT_EQ(got["objects"][i]["name"], object.name);
        EXPECT_EQ(got["objects"][i]["pixels"], object.pixels);
        EXPECT_EQ(got["objects"][i]["seen_pixels"], object.seen_pixels);
        EXPECT_EQ(got["objects"][i]["segmentation"]["foreign_share"], object.segmentation->foreign_share);
        for (const Quantity quantity : kQuantities) {
            const json& measured = got["objects"][i]["quantities"][name_of(quantity)];
            expect_equal(measured, static_cast<const Averages&>(*object.quantities[quantity]));
            const auto& frames = object.quantities[quantity]->frames;
            ASSERT_EQ(measured["frames"]["frame"].size(), frames.size());
            for (size_t row = 0; row < frames.size(); ++row) expect_equal(measured["frames"], row, frames[row]);
        }
    }
    for (const Quantity quantity : kQuantities) {
        expect_equal(got["object_means"][name_of(quantity)], *evaluation.object_means[quantity]);
    }
    EXPECT_EQ(got["depth_mm"]["p90"], 4.75);
    EXPECT_EQ(got["normal_deg"]["median"], 0.5);
    EXPECT_EQ(got["trajectory"]["run_poses"], 39);
    EXPECT_EQ(got["states"], (json{{"tracking", 36}, {"weak", 3}, {"lost", 1}}));
    EXPECT_EQ(got["trajectory"]["per_second"]["rotation_median_deg"], 0.05);
    EXPECT_EQ(got["trajectory"]["per_second"]["rotation_max_deg"], 0.07);
    EXPECT_EQ(got["trajectory"]["per_frame"]["translation_median_m"], 0.0008);
    EXPECT_EQ(got["segmentation"]["labels"], 2.5);
    EXPECT_EQ(got["lights"]["matches"][0]["intensity_error_after_factor"], (json{0.125, 0, 0}));
    EXPECT_EQ(got["lights"]["run"][1]["position"], (json{1.02, -2, 3}));
    EXPECT_EQ(got["lights"]["missed"], (json{1}));
}

TEST(EvalJson, KeysKeepTheirOrder) {
    const auto got = nlohmann::ordered_json::parse(eval_json(full_evaluation()));
    EXPECT_THAT(keys_of(got), ElementsAre("format", "version", "sequence", "run", "width", "height", "frames",
                                          "truth_frames", "run_frames", "seen_frames", "seen_share", "objects",
                                          "object_means", "depth_mm", "normal_deg", "segmentation", "intervals",
                                          "trajectory", "states", "lights", "finished_model", "novel", "relit"));
    EXPECT_THAT(keys_of(got["objects"][0]["quantities"]),
                ElementsAre("kd_before", "kd", "ks", "alpha", "rgb_before", "rgb", "kd_shown", "rgb_shown"));
}

TEST(EvalJson, WhatWasNotMeasuredIsNull) {
    const json got = parsed(test::geometry_only());
    for (const char* key : {"segmentation", "lights"}) EXPECT_TRUE(got.at(key).is_null()) << key;
    EXPECT_TRUE(got["object_means"].at("ks").is_null());
    EXPECT_TRUE(got["objects"][0]["quantities"].at("ks").is_null());
    EXPECT_FALSE(got["objects"][0]["quantities"].at("rgb").is_null());
}

TEST(EvalJson, OnlyColoursHaveThePsnrOfSrgb) {
    Evaluation evaluation = full_evaluation();
    evaluation.object_means[Quantity::kRgb]->mean.all.psnr_srgb_db = 25.5;
    const json got = parsed(evaluation)["object_means"];
    EXPECT_EQ(got["rgb"]["mean"]["all"]["psnr_srgb_db"], 25.5);
    EXPECT_FALSE(got["kd"]["mean"]["all"].contains("psnr_srgb_db"));
}

TEST(EvalJson, InfinitePsnrIsNull) {
    Evaluation evaluation = full_evaluation();
    evaluation.object_means[Quantity::kKd]->mean.filled->psnr_db = std::numeric_limits<double>::infinity();
    const json got = parsed(evaluation)["object_means"]["kd"]["mean"]["filled"];
    EXPECT_TRUE(got.at("psnr_db").is_null());
    EXPECT_FALSE(got.at("mad").is_null());
}

TEST(EvalJson, ListsStandOnOneLine) {
    const std::string text = eval_json(full_evaluation(1, 5));
    EXPECT_THAT(text, HasSubstr("\n  \"frames\": [0,10,20,30,40],\n"));
    EXPECT_THAT(text, HasSubstr("\n    \"missed\": [1],\n"));
}

TEST(EvalJson, BadBytesAreReplaced) {
    Evaluation evaluation = full_evaluation();
    evaluation.objects[0].name = "caf\xe9";
    EXPECT_EQ(parsed(evaluation)["objects"][0]["name"], "caf\xef\xbf\xbd");
}

TEST(EvalJson, NothingIsStillJson) { EXPECT_EQ(parsed({})["objects"], json::array()); }

}  // namespace
}  // namespace patina::eval::eval_json_test
