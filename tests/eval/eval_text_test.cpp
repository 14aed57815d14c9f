#include "tools/eval/eval_text.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>

#include "tests/eval/made_up_evaluation.h"

namespace patina::eval::eval_text_test {
namespace {

using test::full_evaluation;
using test::geometry_only;
using testing::HasSubstr;
using testing::Not;

/// The characters of the longest line; of those that UTF-8 writes with several bytes, the first counts.
size_t longest_line(const std::string& text) {
    std::istringstream lines(text);
    size_t longest = 0;
    for (std::string line; std::getline(lines, line);) {
        const auto is_first = [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0) != 0x80; };
        longest = std::max(longest, static_cast<size_t>(std::ranges::count_if(line, is_first)));
    }
    return longest;
}

/// Two objects, of which the second has no ks, and everything is filled.
Evaluation small_evaluation() {
    Evaluation evaluation = full_evaluation(2, 10);
    for (ObjectResult& object : evaluation.objects) {
        for (const Quantity quantity : kQuantities) object.quantities[quantity]->mean.coverage = 1;
    }
    evaluation.objects[1].quantities[Quantity::kKs].reset();
    evaluation.objects[0].quantities[Quantity::kAlpha]->mean.all.psnr_db = std::numeric_limits<double>::infinity();
    evaluation.trajectory.reset();
    evaluation.no_trajectory = "truth and run do not both have one";
    evaluation.states.reset();
    evaluation.segmentation.reset();
    evaluation.lights->invented.clear();
    return evaluation;
}

TEST(EvalText, LooksLikeTable1) {
    EXPECT_EQ(eval_text(small_evaluation()),
              R"(out/<b>run</b> against recordings/bunnies: 10 frames of 512 x 424 (truth has 10, the run 15)

Scores over all pixels that have truth; where the run has no value it counts as 0.
S1 floor, S2 yellow <script> figure

                     MAD                  RMSE                PSNR, dB                SSIM
                 S1     S2    avg      S1     S2    avg      S1     S2    avg      S1     S2    avg
kd           0.0125 0.0225 0.0325  0.0125 0.0250 0.0375   39.00  38.00  37.00  0.9950 0.9900 0.9850
kd refined   0.0325 0.0425 0.0425  0.0375 0.0500 0.0500   37.00  36.00  36.00  0.9850 0.9800 0.9800
ks           0.0525      - 0.0525  0.0625      - 0.0625   35.00      -  35.00  0.9750      - 0.9750
alpha        0.0725 0.0825 0.0625  0.0875 0.1000 0.0750     inf  32.00  34.00  0.9650 0.9600 0.9700
RGB          0.0925 0.1025 0.0725  0.1125 0.1250 0.0875   31.00  30.00  33.00  0.9550 0.9500 0.9650
RGB refined  0.1125 0.1225 0.0825  0.1375 0.1500 0.1000   29.00  28.00  32.00  0.9450 0.9400 0.9600
kd shown     0.1325 0.1425 0.0925  0.1625 0.1750 0.1125   27.00  26.00  31.00  0.9350 0.9300 0.9550
RGB shown    0.1525 0.1625 0.1025  0.1875 0.2000 0.1250   25.00  24.00  30.00  0.9250 0.9200 0.9500

              PSNR of sRGB, dB          coverage
                 S1     S2    avg      S1     S2    avg
kd                -      -      -  100.0% 100.0%  97.5%
kd refined        -      -      -  100.0% 100.0%  97.5%
ks                -      -      -  100.0%      -  97.5%
alpha             -      -      -  100.0% 100.0%  97.5%
RGB               -      -      -  100.0% 100.0%  97.5%
RGB refined       -      -      -  100.0% 100.0%  97.5%
kd shown          -      -      -  100.0% 100.0%  97.5%
RGB shown         -      -      -  100.0% 100.0%  97.5%

Averages over the objects, of all frames and of the last tenth of those that show an object:

                        all pixels                         filled pixels                     seen in 5 frames
                MAD   RMSE   PSNR   SSIM   sRGB     MAD   RMSE   PSNR   SSIM   sRGB     MAD   RMSE   PSNR   SSIM   sRGB
kd           0.0325 0.0375  37.00 0.9850      -  0.0300 0.0375  37.00 0.9850      -  0.0150 0.0188  38.50 0.9925      -
kd refined   0.0425 0.0500  36.00 0.9800      -  0.0400 0.0500  36.00 0.9800      -  0.0200 0.0250  38.00 0.9900      -
ks           0.0525 0.0625  35.00 0.9750      -  0.0500 0.0625  35.00 0.9750      -  0.0250 0.0312  37.50 0.9875      -
alpha        0.0625 0.0750  34.00 0.9700      -  0.0600 0.0750  34.00 0.9700      -  0.0300 0.0375  37.00 0.9850      -
RGB          0.0725 0.0875  33.00 0.9650      -  0.0700 0.0875  33.00 0.9650      -  0.0350 0.0438  36.50 0.9825      -
RGB refined  0.0825 0.1000  32.00 0.9600      -  0.0800 0.1000  32.00 0.9600      -  0.0400 0.0500  36.00 0.9800      -
kd shown     0.0925 0.1125  31.00 0.9550      -  0.0900 0.1125  31.00 0.9550      -  0.0450 0.0563  35.50 0.9775      -
RGB shown    0.1025 0.1250  30.00 0.9500      -  0.1000 0.1250  30.00 0.9500      -  0.0500 0.0625  35.00 0.9750      -

                  all pixels, last tenth             filled pixels, last tenth         seen in 5 frames, last tenth
                MAD   RMSE   PSNR   SSIM   sRGB     MAD   RMSE   PSNR   SSIM   sRGB     MAD   RMSE   PSNR   SSIM   sRGB
kd           0.0085 0.0075  39.40 0.9970      -  0.0060 0.0075  39.40 0.9970      -  0.0030 0.0038  39.70 0.9985      -
kd refined   0.0105 0.0100  39.20 0.9960      -  0.0080 0.0100  39.20 0.9960      -  0.0040 0.0050  39.60 0.9980      -
ks           0.0125 0.0125  39.00 0.9950      -  0.0100 0.0125  39.00 0.9950      -  0.0050 0.0063  39.50 0.9975      -
alpha        0.0145 0.0150  38.80 0.9940      -  0.0120 0.0150  38.80 0.9940      -  0.0060 0.0075  39.40 0.9970      -
RGB          0.0165 0.0175  38.60 0.9930      -  0.0140 0.0175  38.60 0.9930      -  0.0070 0.0088  39.30 0.9965      -
RGB refined  0.0185 0.0200  38.40 0.9920      -  0.0160 0.0200  38.40 0.9920      -  0.0080 0.0100  39.20 0.9960      -
kd shown     0.0205 0.0225  38.20 0.9910      -  0.0180 0.0225  38.20 0.9910      -  0.0090 0.0113  39.10 0.9955      -
RGB shown    0.0225 0.0250  38.00 0.9900      -  0.0200 0.0250  38.00 0.9900      -  0.0100 0.0125  39.00 0.9950      -

Depth error     1.50 mm median, 2.25 mean, 4.75 at 90% of the pixels, RMSE 3.12; coverage 98.4%
Normal error    0.50 deg median, 1.25 mean, 2.75 at 90% of the pixels, RMSE 1.62; coverage 98.4%
Lights          1 of 2 matched within 0.50 m; 1 missed, 0 invented; the run's intensities are 2.000 times the true ones
  true light 1 at (1.00, -2.00, 3.00) m: light 2 of the run, 20.0 mm off
    intensity off by 100.0% 100.0% 100.0%; after division by the common factor by 12.5% 0.0% 0.0%
  true light 2 at (-1.00, -2.00, 3.00) m: missed

Note: Segmentation was not measured: the run's frames hold no labels.
Note: The trajectory was not compared: truth and run do not both have one.
)");
}

TEST(EvalText, TellsOfTheTrajectory) {
    Evaluation evaluation = full_evaluation();
    EXPECT_THAT(
        eval_text(evaluation),
        HasSubstr("\nTrajectory      ATE RMSE 12.50 mm, at most 30.00 mm; 500.00 mm without alignment; 39 of 40 poses"
                  "\nRPE per frame   RMSE 1.00 mm, 0.010 deg; median 0.80 mm, 0.008 deg; at most 2.00 mm, 0.020 "
                  "deg; 38 x 0.033 s"
                  "\nRPE per second  RMSE 4.00 mm, 0.060 deg; median 3.00 mm, 0.050 deg; at most 5.00 mm, 0.070 "
                  "deg; 9 x 1.000 s"
                  "\nFrames          36 tracking, 3 weak, 1 lost; only those that track were fused\n"));
    EXPECT_THAT(eval_text(evaluation), testing::Not(HasSubstr("truth has none")));
    evaluation.trajectory->run_poses = 41;
    EXPECT_THAT(eval_text(evaluation),
                HasSubstr("\nNote: 2 of the run's 41 poses are at times for which truth has none.\n"));
}

TEST(EvalText, FitsATerminal) {
    for (const size_t objects : {1, 4, 5, 6, 7, 30}) {
        EXPECT_LE(longest_line(eval_text(full_evaluation(objects))), 120u) << objects << " objects";
    }
}

TEST(EvalText, ManyObjectsHaveALineEach) {
    const std::string text = eval_text(full_evaluation(30));
    EXPECT_THAT(text,
                HasSubstr("\nS1 floor                 0.0125  0.0325  0.0525  0.0725  0.0925  0.1125  0.1325  0.1525"));
    EXPECT_THAT(text, HasSubstr("\nS2 yellow <script> fi~   0.0225"));
    EXPECT_THAT(text, HasSubstr("\nS3 K\xc3\xbc"
                                "che & \"more\"        0.0325"));
    EXPECT_THAT(text, HasSubstr("\nS30 chair 29             0.3025"));
    EXPECT_THAT(text, HasSubstr("\navg                      0.0325"));
}

TEST(EvalText, AveragesAreOfEveryKindOfPixelsAndPeriod) {
    const std::string text = eval_text(full_evaluation());
    const size_t averages = text.find("Averages over the objects");
    ASSERT_NE(averages, std::string::npos);
    for (const char* title : {"all pixels", "filled pixels", "seen in 5 frames", "all pixels, last tenth",
                              "filled pixels, last tenth", "seen in 5 frames, last tenth"})
        EXPECT_THAT(text.substr(averages), HasSubstr(title));
    EXPECT_THAT(text.substr(averages), HasSubstr("\nkd           0.0325 0.0375  37.00 0.9850"));
    EXPECT_THAT(text.substr(averages), HasSubstr("  0.0300 0.0375  37.00 0.9850      -  0.0150 0.0188"));
    EXPECT_THAT(text.substr(averages), HasSubstr("\nkd           0.0085 0.0075  39.40 0.9970"));
}

TEST(EvalText, WhatIsShownHasRowsWhereTheRunHasIt) {
    Evaluation evaluation = full_evaluation();
    EXPECT_THAT(eval_text(evaluation), HasSubstr("\nRGB shown "));
    for (const Quantity quantity : {Quantity::kKdShown, Quantity::kRgbShown}) evaluation.object_means[quantity].reset();
    EXPECT_THAT(eval_text(evaluation), Not(HasSubstr("shown")));
}

TEST(EvalText, SaysWhatTheRunDidNotWrite) {
    const std::string text = eval_text(geometry_only());
    EXPECT_THAT(text, HasSubstr("\nkd                -      -      -      -      -       -"));
    EXPECT_THAT(text, HasSubstr("\nRGB refined  0.1125"));
    EXPECT_THAT(text, HasSubstr("Note: The run's frames hold no kd, kd refined, ks, alpha and RGB.\n"));
    EXPECT_THAT(text, HasSubstr("Note: Lights were not compared"));
}

TEST(EvalText, NothingSeenOftenEnoughIsSaid) {
    Evaluation evaluation = full_evaluation();
    evaluation.seen_share = 0;
    EXPECT_THAT(eval_text(evaluation),
                HasSubstr("Note: No surface was seen in at least 5 frames by the evaluated ones.\n"));
}

TEST(EvalText, NothingSeenIsSaid) {
    const std::string text = eval_text({});
    EXPECT_THAT(text, HasSubstr("No object of the truth is seen"));
    EXPECT_THAT(text, Not(HasSubstr("MAD")));
}

TEST(EvalText, NamesCannotMoveTheCursor) {
    Evaluation evaluation = full_evaluation();
    evaluation.objects[0].name = "a\033[2Jb\nc";
    EXPECT_THAT(eval_text(evaluation), HasSubstr("S1 a\\x1b[2Jb"));
}

}  // namespace
}  // namespace patina::eval::eval_text_test
