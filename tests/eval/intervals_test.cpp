#include "tools/eval/intervals.h"

#include <gmock/gmock.h>

#include "sensor/files/text_file.h"
#include "tests/eval/eval_rig.h"
#include "tools/eval/eval_text.h"

namespace patina::eval::intervals_test {
namespace {

/// Truth: "floor" has kd (0.6, 0.5, 0.4), ks (0.1, 0.15, 0.2), alpha 0.2; "box" is textured, its alpha is 0.3. The
/// run's labels are the objects' ids.
class Intervals : public ::testing::Test {
  protected:
    Evaluation evaluate(const std::string& materials) {
        sensor::write_bytes(rig_.run() / "materials.json", "{\"materials\": [" + materials + "]}");
        return rig_.evaluate();
    }

    test::EvalRig rig_;
};

constexpr const char* kFloor = R"({"id": 1, "specular_confidence": 0.75,
    "interval": {"kd": [[0.5, 0.7], [0.5001, 0.6], [0.3, 0.35]], "ks": [[0, 0.1], [0, 0.1499], [0.3, 0.4]],
                 "alpha": [0.1, 0.4]},
    "interval_50": {"kd": [[0.6, 0.6], [0, 0.1], [0, 0.1]], "ks": [[0, 0], [0, 0], [0, 0]], "alpha": [0.21, 0.3]}})";
constexpr const char* kBox = R"({"id": 2,
    "interval": {"kd": [[0, 1], [0, 1], [0, 1]], "ks": [[0, 1], [0, 1], [0, 1]], "alpha": [0.1, 0.2]}})";

TEST_F(Intervals, CountsTrueValuesWithinThem) {
    const Evaluation evaluation = evaluate(std::string(kFloor) + ", " + kBox);
    ASSERT_EQ(evaluation.intervals.size(), 2u);
    const IntervalCounts& half = evaluation.intervals[0];
    EXPECT_EQ(half.probability, 0.5);
    EXPECT_EQ(half.kd.within, 1u);
    EXPECT_EQ(half.ks.within, 0u);
    EXPECT_EQ(half.alpha.within, 0u);
    EXPECT_EQ(half.alpha.values, 1u) << "the box has none of 50 %";
    const IntervalCounts& most = evaluation.intervals[1];
    EXPECT_EQ(most.probability, 0.9);
    EXPECT_EQ(most.kd.values, 3u) << "a texture has no single kd";
    EXPECT_EQ(most.kd.within, 1u) << "0.5 lies below 0.5001 by more than rounding";
    EXPECT_NEAR(most.kd.mean_width(), (0.2 + 0.0999 + 0.05) / 3, 1e-12);
    EXPECT_EQ(most.ks.values, 6u);
    EXPECT_EQ(most.ks.within, 1u + 3u);
    EXPECT_EQ(most.alpha.values, 2u);
    EXPECT_EQ(most.alpha.within, 1u);
    EXPECT_NEAR(most.alpha.mean_width(), 0.2, 1e-12);
    ASSERT_TRUE(evaluation.objects.at(0).intervals);
    EXPECT_EQ(evaluation.objects[0].intervals->confidence, 0.75);
    EXPECT_FALSE(evaluation.objects.at(1).intervals->confidence);
    EXPECT_THAT(eval_text(evaluation), ::testing::HasSubstr("of 90% hold kd 1 of 3, width 0.117; ks 4 of 6"));
}

TEST_F(Intervals, OfOtherThingsSegmentsDoNotCount) {
    EXPECT_TRUE(evaluate(R"({"id": 1}, {"id": 7})").intervals.empty()) << "segments without intervals";
    rig_.change_frames([](test::EvalFrame& frame) {
        for (float& label : frame.label.pixels()) label = label > 0 ? 1.0f : 0.0f;
    });
    const Evaluation merged = evaluate(std::string(kFloor) + ", " + kBox);
    size_t with_intervals = 0;
    for (const ObjectResult& object : merged.objects) {
        if (!object.intervals) continue;
        ++with_intervals;
        EXPECT_GE(object.segmentation->iou, kMatchedIou);
    }
    EXPECT_LE(with_intervals, 1u) << "a segment has one object at most";
}

TEST_F(Intervals, RunsWithoutMaterialsHaveNone) { EXPECT_TRUE(rig_.evaluate().intervals.empty()); }

}  // namespace
}  // namespace patina::eval::intervals_test
