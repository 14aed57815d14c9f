#include "tools/eval/evaluate.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "tests/eval/eval_rig.h"
#include "tests/eval/pictures.h"
#include "tests/export/throws.h"

namespace patina::eval::evaluate_test {
namespace {

using test::change_object;
using test::EvalFrame;
using test::EvalRig;
using test::throws_error_with;
using testing::ElementsAre;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kBox = 2;

/// The object's scores for a quantity, averaged over frames.
const Comparison& mean_of(const Evaluation& evaluation, size_t object, Quantity quantity) {
    return evaluation.objects.at(object).quantities[quantity].value().mean;
}
const Comparison& floor_in(const Evaluation& evaluation, Quantity quantity) { return mean_of(evaluation, 0, quantity); }
const Comparison& box_in(const Evaluation& evaluation, Quantity quantity) { return mean_of(evaluation, 1, quantity); }

void expect_perfect(const Comparison& comparison) {
    EXPECT_EQ(comparison.coverage, 1);
    for (const Scores& scores : {comparison.filled.value(), comparison.all}) {
        EXPECT_EQ(scores.mad, 0);
        EXPECT_EQ(scores.rmse, 0);
        EXPECT_EQ(scores.psnr_db, kInfinity);
        EXPECT_DOUBLE_EQ(scores.ssim, 1);
    }
}

TEST(Evaluate, TheTruthAsARunIsPerfect) {
    const Evaluation result = EvalRig().evaluate();
    EXPECT_THAT(result.frames, ElementsAre(0, 10, 20, 30));
    EXPECT_EQ(result.extent, EvalRig::kExtent);
    ASSERT_EQ(result.objects.size(), 3u);
    for (const Quantity quantity : kQuantities) {
        expect_perfect(floor_in(result, quantity));
        expect_perfect(box_in(result, quantity));
        expect_perfect(result.object_means[quantity].value().mean);
    }
    for (const auto& errors : {result.depth_mm, result.normal_deg}) {
        EXPECT_EQ(errors->coverage, 1);
        EXPECT_NEAR(errors->rmse, 0, 1e-6);
        EXPECT_NEAR(errors->p90, 0, 1e-6);
    }
    EXPECT_NEAR(result.trajectory->ate_rmse_m, 0, 1e-9);
    EXPECT_NEAR(result.trajectory->per_second->translation_rmse_m, 0, 1e-9);
    EXPECT_EQ(result.lights->matches.size(), 2u);
    EXPECT_NEAR(result.lights->matches[1].position_error_m, 0, 1e-9);
    EXPECT_EQ(result.lights->common_factor, 1);
    EXPECT_EQ(result.segmentation->iou, 1);
    EXPECT_EQ(result.segmentation->labels, 1);
    EXPECT_EQ(result.segmentation->foreign_share, 0);
}

TEST(Evaluate, ObjectsHaveNamesAndGaps) {
    const Evaluation result = EvalRig().evaluate();
    EXPECT_EQ(result.objects[0].name, "floor");
    EXPECT_EQ(result.objects[1].name, "box");
    EXPECT_EQ(result.objects[2].name, "object 3");
    EXPECT_EQ(result.objects[1].pixels, 3u * 20 * 18);
    const ObjectQuantity& box = result.objects[1].quantities[Quantity::kKs].value();
    ASSERT_EQ(box.frames.size(), 3u);
    EXPECT_EQ(box.frames[1].frame, 10u);
    EXPECT_EQ(box.frames[2].frame, 30u);  // out of sight in frame 20
    EXPECT_NEAR(box.frames[0].truth_mean.y, 0.15, 1e-7);
    EXPECT_EQ(result.objects[2].pixels, 4u * 63);
    EXPECT_FALSE(result.objects[2].quantities[Quantity::kKd]);  // one pixel less than counts
    EXPECT_EQ(result.objects[2].segmentation->iou, 1);
}

TEST(Evaluate, AnOffsetOnOneObjectIsItsErrorAlone) {
    const EvalRig rig;
    rig.change_frames([](EvalFrame& frame) {
        change_object(frame, kBox, frame.kd, [](glm::vec3& kd) { kd += 0.1f; });
        change_object(frame, kBox, frame.kd_segment, [](glm::vec3& kd) { kd -= 0.2f; });
        change_object(frame, kBox, frame.alpha, [](float& alpha) { alpha += 0.01f; });
    });
    const Evaluation result = rig.evaluate();
    const Scores kd = box_in(result, Quantity::kKd).filled.value();
    EXPECT_NEAR(kd.mad, 0.1, 1e-6);
    EXPECT_NEAR(kd.rmse, 0.1, 1e-6);
    EXPECT_NEAR(kd.psnr_db, 20, 1e-4);
    EXPECT_LT(kd.ssim, 1);
    EXPECT_NEAR(box_in(result, Quantity::kKdBefore).filled->mad, 0.2, 1e-6);
    EXPECT_NEAR(box_in(result, Quantity::kAlpha).filled->psnr_db, 40, 1e-3);
    expect_perfect(floor_in(result, Quantity::kKd));
    expect_perfect(box_in(result, Quantity::kKs));
    EXPECT_NEAR(result.object_means[Quantity::kKd]->mean.filled->mad, 0.05, 1e-6);
    EXPECT_NEAR(result.object_means[Quantity::kKd]->mean.filled->psnr_db, (kPsnrCap_db + 20) / 2, 1e-4);
    const FramePoint& point = result.objects[1].quantities[Quantity::kKd]->frames[0];
    EXPECT_NEAR(point.run_mean->z - point.truth_mean.z, 0.1, 1e-6);
    EXPECT_NEAR(point.comparison.filled->mad, 0.1, 1e-6);
}

TEST(Evaluate, NoiseIsTheRootMeanSquareError) {
    const EvalRig rig;
    std::mt19937 generator(1);
    std::normal_distribution<float> noise(0, 0.05f);
    rig.change_frames([&](EvalFrame& frame) {
        for (glm::vec3& ks : frame.ks.pixels()) ks += glm::vec3(noise(generator), noise(generator), noise(generator));
    });
    // 3 x 1300 values and more a frame, four frames: a standard deviation is known to about 0.6 %.
    const Scores scores = floor_in(rig.evaluate(), Quantity::kKs).filled.value();
    EXPECT_NEAR(scores.rmse, 0.05, 0.01 * 0.05);
    EXPECT_NEAR(scores.mad, 0.05 * std::sqrt(2 / 3.14159265), 0.015 * 0.05);
}

TEST(Evaluate, AveragesFramesNotPixels) {
    const EvalRig rig;
    EvalFrame wrong = EvalRig::frame(20);  // where the floor has most pixels
    for (float& alpha : wrong.alpha.pixels()) alpha += 0.4f;
    test::write_frame(rig.run_frame(20), wrong);
    EXPECT_NEAR(floor_in(rig.evaluate(), Quantity::kAlpha).filled->mad, 0.1, 1e-6);
}

TEST(Evaluate, DroppedPixelsLowerCoverageAndCountAsZero) {
    const EvalRig rig;
    rig.change_frames([](EvalFrame& frame) {
        // Every fourth pixel of the box: 90 of 360, half by 'valid' and half by a value that is not finite.
        size_t count = 0;
        for (size_t i = 0; i < frame.label.pixels().size(); ++i) {
            if (frame.label.pixels()[i] != kBox) continue;
            if (count % 8 == 0) frame.valid.pixels()[i] = 0;
            if (count % 8 == 4) frame.alpha.pixels()[i] = kNan;
            ++count;
        }
    });
    const Evaluation result = rig.evaluate();
    const Comparison& alpha = box_in(result, Quantity::kAlpha);
    EXPECT_DOUBLE_EQ(alpha.coverage, 0.75);
    EXPECT_EQ(alpha.filled->rmse, 0);
    EXPECT_DOUBLE_EQ(alpha.filled->ssim, 1);
    EXPECT_NEAR(alpha.all.mad, 0.25 * 0.3, 1e-7);
    EXPECT_NEAR(alpha.all.rmse, 0.5 * 0.3, 1e-7);
    EXPECT_LT(alpha.all.ssim, 0.9);
    EXPECT_DOUBLE_EQ(box_in(result, Quantity::kKs).coverage, 0.875);
    EXPECT_DOUBLE_EQ(floor_in(result, Quantity::kAlpha).coverage, 1);
}

TEST(Evaluate, AnObjectThatIsMissingAltogetherIsZero) {
    const EvalRig rig;
    rig.change_frames([](EvalFrame& frame) {
        for (size_t i = 0; i < frame.label.pixels().size(); ++i) {
            if (frame.label.pixels()[i] == kBox) frame.valid.pixels()[i] = 0;
        }
    });
    const Evaluation result = rig.evaluate();
    EXPECT_EQ(box_in(result, Quantity::kKs).coverage, 0);
    EXPECT_FALSE(box_in(result, Quantity::kKs).filled);
    EXPECT_NEAR(box_in(result, Quantity::kKs).all.mad, 0.15, 1e-7);
    EXPECT_FALSE(result.objects[1].quantities[Quantity::kKs]->frames[0].run_mean);
    EXPECT_EQ(result.object_means[Quantity::kKs]->mean.filled->mad, 0);
    EXPECT_EQ(result.object_means[Quantity::kKs]->mean.coverage, 0.5);
    EXPECT_FALSE(result.objects[1].segmentation->best_label);
}

TEST(Evaluate, RgbIsComparedAsACameraClipsIt) {
    const EvalRig rig;
    rig.change_frames([](EvalFrame& frame) {
        for (glm::vec3& rgb : frame.rgb.pixels()) {
            if (rgb.x > 1) rgb.x += 5;
        }
        for (glm::vec3& rgb : frame.rgb_segment.pixels()) rgb.z = -1;
    });
    const Evaluation result = rig.evaluate();
    expect_perfect(floor_in(result, Quantity::kRgb));
    const FramePoint& point = result.objects[0].quantities[Quantity::kRgbBefore]->frames[0];
    EXPECT_EQ(point.run_mean->z, 0);
    EXPECT_NEAR(point.comparison.filled->mad, point.truth_mean.z / 3, 1e-6);
}

TEST(Evaluate, RgbHasThePsnrOfSrgbToo) {
    const EvalRig rig;
    rig.change_frames([](EvalFrame& frame) {
        for (glm::vec3& rgb : frame.rgb.pixels()) rgb = glm::vec3(0.2159f);  // sRGB 0.5020
        for (glm::vec3& kd : frame.kd.pixels()) kd += 0.01f;
    });
    const Scores scores = floor_in(rig.evaluate(), Quantity::kRgb).all;
    EXPECT_GT(std::abs(scores.psnr_srgb_db.value() - scores.psnr_db), 0.5);
    EXPECT_FALSE(floor_in(rig.evaluate(), Quantity::kKd).all.psnr_srgb_db);
}

// Three ways to look better than one is. Each has to change its own figure, and no other.

TEST(Evaluate, RefinedAlbedoInPlaceOfTheSegmentsShows) {
    const EvalRig rig;
    const auto segment = [](EvalFrame& frame) {
        change_object(frame, kBox, frame.kd_segment, [](glm::vec3& kd) { kd = glm::vec3(0.3f, 0.4f, 0.5f); });
    };
    rig.change_frames(segment);
    const Evaluation honest = rig.evaluate();
    rig.change_frames([&](EvalFrame& frame) {
        segment(frame);
        frame.kd_segment = frame.kd;
    });
    const Evaluation swapped = rig.evaluate();
    EXPECT_GT(box_in(honest, Quantity::kKdBefore).all.mad, 0.03) << "the box is textured, a segment's kd is not";
    EXPECT_EQ(box_in(swapped, Quantity::kKdBefore).all.mad, 0);
    EXPECT_EQ(box_in(honest, Quantity::kKd).all.mad, box_in(swapped, Quantity::kKd).all.mad);
}

TEST(Evaluate, DetailThatIsCopiedFromTheInputHasARowOfItsOwn) {
    const EvalRig rig;
    const auto smooth = [](EvalFrame& frame) {
        for (glm::vec3& rgb : frame.rgb.pixels()) rgb *= 0.9f;
    };
    rig.change_frames(smooth);  // what is shown has the input's detail: it is the truth
    const Evaluation result = rig.evaluate();
    EXPECT_GT(box_in(result, Quantity::kRgb).all.mad, 0.01);
    EXPECT_EQ(box_in(result, Quantity::kRgbShown).all.mad, 0);
    rig.change_frames([](EvalFrame& frame) { frame.rgb = frame.rgb_shown; });
    EXPECT_EQ(box_in(rig.evaluate(), Quantity::kRgb).all.mad, 0) << "copied in, it would not be told";
}

TEST(Evaluate, FirstFramesCountAndSoDoTheLast) {
    const EvalRig rig;
    std::vector<float> off{0.4f, 0.2f, 0.1f, 0.05f};  // by frame
    rig.change_frames([&, frame = size_t{0}](EvalFrame& picture) mutable {
        for (float& alpha : picture.alpha.pixels()) alpha += off[frame];
        ++frame;
    });
    const ObjectQuantity floor = rig.evaluate().objects[0].quantities[Quantity::kAlpha].value();
    EXPECT_NEAR(floor.mean.all.mad, (0.4 + 0.2 + 0.1 + 0.05) / 4, 1e-6);
    EXPECT_NEAR(floor.at_end.all.mad, 0.05, 1e-6);
    std::filesystem::remove(rig.run_frame(0));
    const ObjectQuantity without = rig.evaluate().objects[0].quantities[Quantity::kAlpha].value();
    EXPECT_NEAR(without.mean.all.mad, (0.2 + 0.1 + 0.05) / 3, 1e-6);
    EXPECT_NEAR(without.at_end.all.mad, 0.05, 1e-6);
}

TEST(Evaluate, DepthAndNormalErrorsAreWhatWasPutIn) {
    const EvalRig rig;
    rig.change_frames([](EvalFrame& frame) {
        const glm::mat4 turn = glm::rotate(glm::mat4(1), glm::radians(5.0f), glm::vec3(1, 0, 0));
        for (float& depth : frame.depth.pixels()) depth *= 1.01f;
        for (glm::vec3& normal : frame.normal.pixels()) normal = glm::vec3(turn * glm::vec4(normal, 0));
        change_object(frame, kBox, frame.normal, [](glm::vec3& normal) { normal = glm::vec3(0); });
        change_object(frame, kBox, frame.depth, [](float& depth) { depth = kNan; });
    });
    const Evaluation result = rig.evaluate();
    const uint64_t pixels = 4 * (48 * 30 + 63) - 3 * 360 - 7 * 0;
    EXPECT_NEAR(result.normal_deg->median, 5, 5 * 1e-3);
    EXPECT_NEAR(result.normal_deg->mean, 5, 1e-4);
    EXPECT_EQ(result.normal_deg->pixels, pixels);
    EXPECT_EQ(result.depth_mm->pixels, pixels);
    EXPECT_DOUBLE_EQ(result.depth_mm->coverage, static_cast<double>(pixels) / (4 * (48 * 30 + 63)));
    // 1 % of 2 m to 2.78 m.
    EXPECT_GT(result.depth_mm->median, 20);
    EXPECT_LT(result.depth_mm->p90, 27.8);
    EXPECT_GT(result.depth_mm->rmse, result.depth_mm->mean);
}

TEST(Evaluate, ARunInAWorldOfItsOwnIsBroughtIntoTruths) {
    const EvalRig rig;
    const RigidTransform run_from_truth =
        glm::translate(glm::rotate(RigidTransform(1), 1.0, glm::dvec3(0.6, 0, 0.8)), glm::dvec3(1, 2, 3));
    std::vector<sensor::StampedPose> poses = EvalRig::trajectory();
    for (sensor::StampedPose& pose : poses) pose.world_from_camera = run_from_truth * pose.world_from_camera;
    std::vector<Light> lights = EvalRig::lights();
    for (auto& light : lights) light.position_m = glm::dvec3(run_from_truth * glm::dvec4(light.position_m, 1));
    sensor::write_trajectory(rig.run() / "trajectory.txt", poses);
    sensor::write_lights(rig.run() / "lights.json", lights);
    rig.change_frames([&](EvalFrame& frame) {
        for (glm::vec3& normal : frame.normal.pixels()) normal = glm::mat3(glm::dmat3(run_from_truth)) * normal;
    });
    const Evaluation result = rig.evaluate();
    EXPECT_NEAR(result.trajectory->ate_rmse_m, 0, 1e-9);
    EXPECT_GT(result.trajectory->unaligned_rmse_m, 1);
    EXPECT_NEAR(result.normal_deg->p90, 0, 1e-4);
    ASSERT_EQ(result.lights->matches.size(), 2u);
    EXPECT_NEAR(result.lights->matches[0].position_error_m, 0, 1e-9);
}

/// The truth of a recording has lamps alone.
TEST(Evaluate, ASunIsNoInventedLamp) {
    const EvalRig rig;
    std::vector<Light> lights = EvalRig::lights();
    lights.push_back({{0, -6000, 8000}, {1e9, 1e9, 1e9}});
    lights.push_back({{40, 0, 0}, {1, 1, 1}});
    sensor::write_lights(rig.run() / "lights.json", lights);
    const Evaluation result = rig.evaluate();
    EXPECT_EQ(result.lights->matches.size(), 2u);
    EXPECT_EQ(result.lights->invented.size(), 1u) << "the lamp that is 40 m away";
}

TEST(Evaluate, LabelsArePooledOverFrames) {
    const EvalRig rig;
    rig.change_frames([frame = 0](EvalFrame& picture) mutable {
        const float label = frame++ < 2 ? 17 : 18;  // the box changes its label midway
        Image<float> labels = picture.label;
        change_object(picture, kBox, labels, [&](float& value) { value = label; });
        picture.label = labels;
    });
    const ObjectSegmentation box = rig.evaluate().objects[1].segmentation.value();
    EXPECT_EQ(box.best_label, 17u);  // in two of the three frames that show the box
    EXPECT_DOUBLE_EQ(box.iou, 2.0 / 3);
    EXPECT_EQ(box.labels, 2u);
}

TEST(Evaluate, WhatTheRunLacksIsAbsent) {
    const EvalRig rig;
    rig.change_frames([](EvalFrame&) {}, {"kd", "kd_segment", "kd_shown", "ks", "alpha", "rgb_segment", "label"});
    std::filesystem::remove(rig.run() / "lights.json");
    std::filesystem::remove(rig.run() / "trajectory.txt");
    const Evaluation result = rig.evaluate();
    for (const Quantity quantity : {Quantity::kKd, Quantity::kKs, Quantity::kAlpha, Quantity::kRgbBefore}) {
        EXPECT_FALSE(result.objects[0].quantities[quantity]);
        EXPECT_FALSE(result.object_means[quantity]);
    }
    expect_perfect(floor_in(result, Quantity::kRgb));
    EXPECT_TRUE(result.depth_mm);
    EXPECT_FALSE(result.segmentation);
    EXPECT_FALSE(result.objects[0].segmentation);
    EXPECT_FALSE(result.lights);
    EXPECT_FALSE(result.trajectory);
    EXPECT_EQ(result.no_trajectory, "truth and run do not both have one");
}

TEST(Evaluate, TwoPosesAreTooFewButAllElseIsMeasured) {
    const EvalRig rig;
    const std::vector<sensor::StampedPose> poses = EvalRig::trajectory();
    sensor::write_trajectory(rig.run() / "trajectory.txt", std::span(poses).first(2));
    const Evaluation result = rig.evaluate();
    EXPECT_FALSE(result.trajectory);
    EXPECT_THAT(result.no_trajectory, testing::EndsWith(" have 2 poses in common, and 3 are needed"));
    expect_perfect(floor_in(result, Quantity::kRgb));
    EXPECT_TRUE(result.lights);
    sensor::write_trajectory(rig.run() / "trajectory.txt", std::span(poses).first(3));
    EXPECT_EQ(rig.evaluate().trajectory.value().poses, 3u);
}

TEST(Evaluate, OnlyCommonFramesCount) {
    const EvalRig rig;
    std::filesystem::remove(rig.run_frame(10));
    test::write_frame(rig.run_frame(15), EvalRig::frame(15));
    std::ofstream(rig.run() / "frames" / "notes.txt") << "no frame";
    const Evaluation result = rig.evaluate();
    EXPECT_THAT(result.frames, ElementsAre(0, 20, 30));
    EXPECT_EQ(result.truth_frames, 4u);
    EXPECT_EQ(result.run_frames, 4u);
}

TEST(Evaluate, SaysHowToGetFrames) {
    const EvalRig rig;
    const auto evaluated = [&] { rig.evaluate(); };
    EXPECT_THAT([&] { evaluate(rig.sequence() / "none", rig.run()); }, throws_error_with("none does not exist"));
    for (const uint32_t index : {0, 10, 20, 30}) std::filesystem::remove(rig.run_frame(index));
    EXPECT_THAT(evaluated, throws_error_with("run/frames holds no frames: run with --dump-every N"));
    test::write_frame(rig.run_frame(5), EvalRig::frame(5));
    EXPECT_THAT(evaluated, throws_error_with("(4 from 0 to 30) and "));
    EXPECT_THAT(evaluated, throws_error_with("(1 from 5 to 5) have no frame in common"));
    std::filesystem::remove_all(rig.sequence() / "truth");
    EXPECT_THAT(evaluated, throws_error_with("truth/frames holds no frames: record the sequence with --truth-every N"));
}

TEST(Evaluate, NamesTheFrameThatDisagrees) {
    const EvalRig rig;
    const auto evaluated = [&] { rig.evaluate(); };
    test::write_frame(rig.run_frame(20), EvalRig::frame(20), {"ks"});
    EXPECT_THAT(evaluated, throws_error_with("000020.exr has no channel ks.R, but "));
    rig.change_frames([](EvalFrame&) {}, {"ks"});
    test::write_frame(rig.run_frame(20), EvalRig::frame(20));
    EXPECT_THAT(evaluated, throws_error_with("000020.exr has a channel ks.R, but "));
    rig.change_frames([](EvalFrame&) {}, {"valid"});
    EXPECT_THAT(evaluated, throws_error_with("000000.exr has no channel valid"));
    rig.change_frames([](EvalFrame&) {});
    std::ofstream(rig.run_frame(30), std::ios::binary) << "damaged";
    EXPECT_THAT(evaluated, throws_error_with("000030.exr is truncated: "));
    rig.change_frames([](EvalFrame&) {});
    test::write_frame(rig.sequence() / "truth" / "frames" / "000010.exr", EvalRig::frame(10), {"kd"});
    EXPECT_THAT(evaluated, throws_error_with("truth/frames/000010.exr has no channel kd.R"));
}

TEST(Evaluate, NamesBothSizes) {
    const EvalRig rig;
    EvalFrame small = EvalRig::frame(0);
    for (auto* picture : {&small.kd, &small.kd_segment, &small.kd_shown, &small.ks, &small.rgb, &small.rgb_segment,
                          &small.rgb_shown, &small.normal}) {
        *picture = Image<glm::vec3>({4, 3});
    }
    for (auto* picture : {&small.alpha, &small.depth, &small.label, &small.valid}) *picture = Image<float>({4, 3});
    test::write_frame(rig.run_frame(10), small);
    EXPECT_THAT([&] { rig.evaluate(); }, throws_error_with("000010.exr is 4 x 3 pixels, but "));
    EXPECT_THAT([&] { rig.evaluate(); }, throws_error_with("000000.exr is 48 x 40"));
}

TEST(Evaluate, TruthMustBeFinite) {
    const EvalRig rig;
    EvalFrame broken = EvalRig::frame(10);
    broken.ks.at(9, 12).y = kNan;
    broken.ks.at(9, 2).y = kNan;  // background: not valid
    test::write_frame(rig.sequence() / "truth" / "frames" / "000010.exr", broken);
    EXPECT_THAT([&] { rig.evaluate(); },
                throws_error_with("truth/frames/000010.exr: channel ks.G is nan at pixel (9, 12), must be finite"));
}

TEST(Evaluate, StatesOfTrackedFramesComeFromTheRunsRecord) {
    const EvalRig rig;
    EXPECT_FALSE(rig.evaluate().states);
    const auto write = [&](const char* json) { std::ofstream(rig.run() / "run.json") << json; };
    write(R"({"totals": {}})");
    EXPECT_FALSE(rig.evaluate().states);
    write(R"({"tracking": {"tracking": 30, "weak": 4, "lost": 6, "frames": []}})");
    const FrameStates states = rig.evaluate().states.value();
    EXPECT_EQ(states.tracking, 30u);
    EXPECT_EQ(states.weak, 4u);
    EXPECT_EQ(states.lost, 6u);
    write(R"({"tracking": {"tracking": 30, "weak": -4, "lost": 6}})");
    EXPECT_THAT([&] { rig.evaluate(); }, throws_error_with("run.json: tracking.weak is -4"));
}

TEST(Evaluate, ADamagedTrajectoryIsAnError) {
    const EvalRig rig;
    const auto expect_error = [&](const char* second_line, const char* message) {
        std::ofstream(rig.run() / "trajectory.txt") << "0 0 0 0 0 0 0 1\n" << second_line << "\n";
        EXPECT_THAT([&] { rig.evaluate(); }, throws_error_with(message));
    };
    expect_error("0.03333 0 0 0 0 0", "trajectory.txt:2 has 6 columns");
    expect_error("0.03333 nan 0 0 0 0 0 1", "trajectory.txt:2: column 2 is nan, must be finite");
    expect_error("nan 0 0 0 0 0 0 1", "trajectory.txt:2: column 1 is nan, must be finite");
}

TEST(Evaluate, ATrajectoryOfAnotherTimeIsAnError) {
    const EvalRig rig;
    std::vector<sensor::StampedPose> poses = EvalRig::trajectory();
    for (sensor::StampedPose& pose : poses) pose.timestamp_s += 1000;
    sensor::write_trajectory(rig.run() / "trajectory.txt", poses);
    EXPECT_THAT([&] { rig.evaluate(); }, throws_error_with("trajectory.txt has no pose within 0.02 s of one of "));
}

}  // namespace
}  // namespace patina::eval::evaluate_test
