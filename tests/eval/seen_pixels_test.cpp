#include "tools/eval/seen_pixels.h"

#include <fstream>

#include <gmock/gmock.h>

#include "sensor/files/picture_file.h"
#include "tests/eval/sliding_view.h"
#include "tests/export/throws.h"
#include "tools/eval/evaluate.h"

namespace patina::eval::seen_pixels_test {
namespace {

using test::SlidingRig;
using test::SlidingView;
using test::throws_error_with;

constexpr uint32_t kWidth = SlidingView::kExtent.width;

/// The columns of a colour frame from which on nothing was seen `least` times: depth's pixel is one to the right.
uint32_t first_unseen(uint32_t least) { return kWidth - 1 - (least - 1) * SlidingView::kStep; }

Image<uint8_t> mask_of(const SlidingRig& rig, uint32_t frame, uint32_t least) {
    const auto frames = exr_frames(rig.sequence() / "truth" / "frames");
    return SeenPixels(rig.sequence(), frames, least).mask(frame, ExrPlanes::read(frames.at(frame)));
}

void expect_columns(const Image<uint8_t>& mask, uint32_t first_unseen) {
    for (uint32_t y = 0; y < mask.extent().height; ++y) {
        for (uint32_t x = 0; x < kWidth; ++x) EXPECT_EQ(mask.at(x, y), x < first_unseen ? 1 : 0) << x << ' ' << y;
    }
}

TEST(SeenPixels, AreThoseWhoseSurfaceTheDepthCameraSawBefore) {
    const SlidingRig rig;
    expect_columns(mask_of(rig, 8, 5), first_unseen(5));
    expect_columns(mask_of(rig, 4, 5), first_unseen(5));
    expect_columns(mask_of(rig, 4, 2), first_unseen(2));
    expect_columns(mask_of(rig, 4, 6), 0);  // later frames do not count
    expect_columns(mask_of(rig, 0, 2), 0);
}

TEST(SeenPixels, WithoutTruthAreNotAmongThem) {
    const SlidingRig rig;
    test::EvalFrame hole = SlidingRig::frame();
    hole.valid.at(3, 4) = 0;
    test::write_frame(SlidingRig::frame_file(rig.sequence() / "truth", 8), hole);
    const Image<uint8_t> mask = mask_of(rig, 8, 2);
    EXPECT_EQ(mask.at(3, 4), 0);
    EXPECT_EQ(mask.at(4, 4), 1);
}

TEST(SeenPixels, FramesThatCannotBeUsedSeeNothing) {
    const SlidingRig rig;
    std::ofstream(rig.sequence() / "depth" / "000003.png", std::ios::binary) << "damaged";
    expect_columns(mask_of(rig, 4, 4), first_unseen(5));
    expect_columns(mask_of(rig, 4, 5), 0);
    const Image<uint16_t> far(SlidingView::kExtent, 9000);  // beyond what the sequence says is to be used
    std::filesystem::remove(rig.sequence() / "depth" / "000002.png");
    sensor::write_png(rig.sequence() / "depth" / "000002.png", far);
    expect_columns(mask_of(rig, 4, 4), 0);
}

TEST(SeenPixels, SayWhatIsMissing) {
    const SlidingRig rig;
    const auto masked = [&] { mask_of(rig, 4, 2); };
    sensor::write_trajectory(rig.sequence() / "truth" / "trajectory.txt",
                             std::vector<sensor::StampedPose>(5, {0, RigidTransform(1)}));
    EXPECT_THAT(masked, throws_error_with("trajectory.txt has 5 poses, but truth/frames has a frame 8"));
    std::filesystem::remove(rig.sequence() / "truth" / "trajectory.txt");
    EXPECT_THAT(masked, throws_error_with("truth/trajectory.txt"));
}

TEST(SeenPixels, TrueFramesAreAsLargeAsColour) {
    const SlidingRig rig;
    test::EvalFrame small;
    for (auto* picture : {&small.depth, &small.valid}) *picture = Image<float>({4, 3}, 1);
    const auto file = SlidingRig::frame_file(rig.sequence() / "truth", 0);
    test::write_frame(
        file, small,
        {"kd", "kd_segment", "kd_shown", "ks", "alpha", "rgb", "rgb_segment", "rgb_shown", "normal", "label"});
    EXPECT_THAT([&] { mask_of(rig, 4, 2); },
                throws_error_with("000000.exr is 4 x 3 pixels, but the sequence's colour is 48 x 40"));
}

/// A run that is wrong in the columns that were seen less than five times, where a fourth of the rows is empty.
void spoil_unseen(test::EvalFrame& frame) {
    for (uint32_t y = 0; y < frame.kd.extent().height; ++y) {
        for (uint32_t x = first_unseen(5); x < kWidth; ++x) {
            frame.kd.at(x, y) += 0.1f;
            if (y % 4 == 0) frame.valid.at(x, y) = 0;
        }
    }
}

TEST(SeenPixels, AreScoredApart) {
    const SlidingRig rig;
    test::EvalFrame spoilt = SlidingRig::frame();
    spoil_unseen(spoilt);
    for (const uint32_t index : {4, 8}) test::write_frame(SlidingRig::frame_file(rig.run(), index), spoilt);
    const Evaluation seen = evaluate(rig.sequence(), rig.run(), {.seen_frames = 5});
    const Evaluation all = evaluate(rig.sequence(), rig.run(), {.seen_frames = 1});

    const ObjectQuantity& kd = seen.objects.at(0).quantities[Quantity::kKd].value();
    ASSERT_EQ(kd.frames.size(), 3u);
    EXPECT_FALSE(kd.frames[0].comparison.seen) << "nothing of frame 0 was seen five times";
    EXPECT_EQ(kd.mean.seen->mad, 0);
    EXPECT_DOUBLE_EQ(kd.mean.seen->ssim, 1);
    EXPECT_GT(kd.mean.filled->mad, 0.005);
    EXPECT_GT(kd.mean.all.mad, kd.mean.filled->mad);
    EXPECT_EQ(seen.objects[0].pixels, 3u * 40 * kWidth);
    EXPECT_EQ(seen.objects[0].seen_pixels, 2u * 40 * first_unseen(5));
    EXPECT_EQ(seen.seen_frames, 5u);
    EXPECT_DOUBLE_EQ(seen.seen_share, 2.0 * first_unseen(5) / (3 * kWidth));

    const ObjectQuantity& kd_all = all.objects.at(0).quantities[Quantity::kKd].value();
    EXPECT_DOUBLE_EQ(kd_all.frames[1].comparison.coverage, 1 - 0.25 * (kWidth - first_unseen(5)) / kWidth);
    EXPECT_EQ(kd_all.mean.seen->mad, kd_all.mean.filled->mad) << "every pixel counts as seen";
    EXPECT_EQ(kd_all.mean.all.mad, kd.mean.all.mad) << "how often is enough makes no difference elsewhere";
    EXPECT_EQ(all.seen_share, 1);

    EXPECT_EQ(seen.depth_mm->pixels, all.depth_mm->pixels);
    EXPECT_EQ(seen.depth_mm->coverage, all.depth_mm->coverage);
    EXPECT_LT(seen.depth_mm->coverage, 1);
    EXPECT_EQ(seen.segmentation->iou, all.segmentation->iou);
}

TEST(SeenPixels, AreScoredWhereTheyAreFilled) {
    const SlidingRig rig;
    test::EvalFrame empty = SlidingRig::frame();
    for (uint32_t x = 0; x < kWidth; ++x) empty.valid.at(x, 7) = 0;
    for (const uint32_t index : {4, 8}) test::write_frame(SlidingRig::frame_file(rig.run(), index), empty);
    const Evaluation result = evaluate(rig.sequence(), rig.run());
    const Comparison& kd = result.objects.at(0).quantities[Quantity::kKd]->mean;
    EXPECT_DOUBLE_EQ(kd.coverage, (1 + 2 * 39.0 / 40) / 3);
    EXPECT_NEAR(kd.all.mad, 2 * 0.5 / 40 / 3, 1e-9);
    EXPECT_EQ(kd.seen->mad, 0);
}

}  // namespace
}  // namespace patina::eval::seen_pixels_test
