#include "sensor/live/camera_source.h"

#include <chrono>
#include <thread>

#include <gmock/gmock.h>

#include "engine/core/error.h"
#include "sensor/camera_view.h"
#include "sensor/live/depth_watch.h"
#include "sensor/live/picture_pairs.h"
#include "sensor/live/wrapping_clock.h"
#include "tests/sensor/sequences.h"

// A camera whose depth and colour come apart, as a live source.

namespace patina::sensor::camera_source_test {
namespace {

using namespace testing;
using ::testing::HasSubstr;

constexpr Extent2D kExtent{4, 3};

Image<uint16_t> depth(uint16_t value) { return Image<uint16_t>(kExtent, value); }
Image<SrgbPixel> color(uint8_t value) { return Image<SrgbPixel>(kExtent, SrgbPixel(value)); }

/// What PicturePairs made: depth and colour of each pair, and why depth was lost.
struct Joined {
    std::vector<std::pair<uint16_t, int>> pairs;
    std::vector<std::string> lost;
    PicturePairs join{0.018,
                      [this](double timestamp_s, Image<uint16_t> d, Image<SrgbPixel> c) {
                          EXPECT_EQ(timestamp_s, d.at(0, 0) / 1000.0);
                          pairs.emplace_back(d.at(0, 0), c.at(0, 0).r);
                      },
                      [this](const std::string& reason) { lost.push_back(reason); }};
};

TEST(PicturePairs, JoinWhatIsNearInTimeWhicheverComesFirst) {
    Joined joined;
    joined.join.depth(0.100, depth(100));
    joined.join.color(0.110, color(1));  // after it
    joined.join.color(0.125, color(2));  // before it
    joined.join.depth(0.133, depth(133));
    joined.join.color(0.145, color(3));
    joined.join.depth(0.170, depth(170));  // 25 ms after: not that one
    joined.join.depth(0.200, depth(200));
    EXPECT_THAT(joined.lost, ::testing::IsEmpty()) << "its colour may still come";
    joined.join.color(0.201, color(4));
    EXPECT_EQ(joined.pairs, (std::vector<std::pair<uint16_t, int>>{{100, 1}, {133, 2}, {200, 4}}));
    ASSERT_EQ(joined.lost.size(), 1u);
    EXPECT_THAT(joined.lost[0], HasSubstr("within 0.018 s"));
}

TEST(PicturePairs, OfTwoThatWaitTheNearerOneIsTaken) {
    Joined joined;
    joined.join.depth(0.100, depth(100));  // its colour is missing
    joined.join.depth(0.110, depth(110));
    joined.join.color(0.111, color(1));
    joined.join.color(0.121, color(2));  // its depth is missing
    joined.join.color(0.131, color(3));
    joined.join.depth(0.130, depth(130));
    EXPECT_EQ(joined.pairs, (std::vector<std::pair<uint16_t, int>>{{110, 1}, {130, 3}}));
    EXPECT_EQ(joined.lost.size(), 1u);
}

TEST(PicturePairs, OneStreamMayComeLate) {
    for (const bool depth_is_late : {false, true}) {
        Joined joined;
        constexpr int kLate = static_cast<int>(PicturePairs::kMostWaiting) - 1;
        std::vector<std::pair<uint16_t, int>> expected;
        const auto give = [&joined](bool is_depth, int i) {
            const int time_ms = 33 * i;
            if (is_depth) joined.join.depth(time_ms / 1000.0, depth(static_cast<uint16_t>(time_ms)));
            if (!is_depth) joined.join.color((time_ms + 5) / 1000.0, color(static_cast<uint8_t>(i)));
        };
        for (int i = 1; i <= 40; ++i) {
            give(!depth_is_late, i);
            if (i <= kLate) continue;
            give(depth_is_late, i - kLate);
            expected.emplace_back(33 * (i - kLate), i - kLate);
        }
        EXPECT_EQ(joined.pairs, expected) << depth_is_late;
        EXPECT_THAT(joined.lost, ::testing::IsEmpty()) << depth_is_late;
    }
}

TEST(PicturePairs, NoMoreThanHalfASecondWaits) {
    Joined joined;
    for (uint16_t i = 0; i < PicturePairs::kMostWaiting; ++i) joined.join.depth(i / 1000.0, depth(i));
    EXPECT_THAT(joined.lost, ::testing::IsEmpty());
    joined.join.depth(0.100, depth(100));
    EXPECT_EQ(joined.lost.size(), 1u) << "depth without colour";
    for (uint8_t i = 0; i < 100; ++i) joined.join.color(1 + i / 100.0, color(i));
    joined.join.depth(1.5, depth(1500));
    EXPECT_THAT(joined.pairs, ::testing::IsEmpty()) << "the colour of that time has gone";
    joined.join.depth(1.99, depth(1990));
    EXPECT_EQ(joined.pairs, (std::vector<std::pair<uint16_t, int>>{{1990, 99}}));
}

TEST(WrappingClock, GoesOnWhereTheCounterBeginsAnew) {
    WrappingClock clock(1000);
    const double first = clock.seconds(0, 0xffffffff - 499);
    EXPECT_NEAR(clock.seconds(1, 500) - first, 1, 1e-9) << "the other stream began after the turn";
    EXPECT_NEAR(clock.seconds(0, 1500) - first, 2, 1e-9);
    EXPECT_NEAR(clock.seconds(1, 1500) - first, 2, 1e-9);
    WrappingClock other(1000);
    const double late = other.seconds(0, 100);
    EXPECT_NEAR(other.seconds(1, 0xffffffff - 99) - late, -0.2, 1e-9) << "the other stream began before the turn";
}

TEST(DepthWatch, ColorAloneDoesNotKeepACameraAlive) {
    using Seconds = std::chrono::seconds;
    const DepthWatch::Clock::time_point start{};
    DepthWatch watch(start);
    EXPECT_NO_THROW(watch.expect("the camera", start + Seconds(5)));
    watch.heard(start + Seconds(3));
    EXPECT_NO_THROW(watch.expect("the camera", start + Seconds(8)));
    EXPECT_EQ(error_of([&] { watch.expect("the camera", start + Seconds(9)); }),
              "the camera has sent no depth pictures for 5 s: it was unplugged, perhaps");
}

TEST(CameraView, FocalLengthsFollowFromTheFieldOfView) {
    const Intrinsics camera = intrinsics_of({640, 480}, glm::dvec2(1.0, 0.8));
    EXPECT_NEAR(camera.fx, 320 / std::tan(0.5), 1e-9);
    EXPECT_NEAR(camera.fy, 240 / std::tan(0.4), 1e-9);
    EXPECT_EQ(camera.cx, 319.5);
    for (const auto view : {std::optional<glm::dvec2>(), std::optional(glm::dvec2(0)), std::optional(glm::dvec2(1, 4))})
        EXPECT_EQ(intrinsics_of({320, 240}, view).fy, 262.5);
}

/// Sends frames as fast as they are taken, then ends as told.
class FakeCamera : public PictureCamera {
  public:
    explicit FakeCamera(uint32_t frames, bool fails, bool* started = nullptr)
        : frames_(frames), fails_(fails), started_(started) {
        info_ = test_info();
        info_.frames.reset();
    }
    const SequenceInfo& info() const override { return info_; }
    void run(const PictureSink& sink, const std::stop_token& stop) override {
        if (started_) *started_ = true;
        for (uint32_t i = 0; i < frames_ && !stop.stop_requested(); ++i) {
            sink.depth(50 + i / 100.0, depth(static_cast<uint16_t>(i)));
            if (i != 1) sink.color(50 + i / 100.0 + 0.001, color(static_cast<uint8_t>(i)));
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        if (fails_) throw Error("it was unplugged");
        while (!stop.stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

  private:
    SequenceInfo info_;
    uint32_t frames_;
    bool fails_;
    bool* started_;
};

TEST(CameraSource, YieldsFramesAndTheReasonForThoseThatAreMissing) {
    CameraSource source(std::make_unique<FakeCamera>(5, true));
    std::vector<uint32_t> tapped;
    source.set_tap([&](const Reading& reading) {
        const auto* frame = std::get_if<Frame>(&reading);
        tapped.push_back(frame ? frame->index : std::get<Skipped>(reading).index);
    });
    uint32_t next = 0;
    const auto read_all = [&] {
        while (const auto reading = source.next()) {
            const auto* frame = std::get_if<Frame>(&*reading);
            EXPECT_EQ(frame ? frame->index : std::get<Skipped>(*reading).index, next++);
            if (!frame) continue;
            EXPECT_GE(source.now_s(), frame->timestamp_s);
            EXPECT_LT(source.now_s(), frame->timestamp_s + 5);
        }
    };
    EXPECT_EQ(error_of(read_all), "it was unplugged");
    EXPECT_EQ(next, 5u);
    EXPECT_EQ(tapped.size(), 5u);
    EXPECT_EQ(source.counts().captured, 5u);
    EXPECT_EQ(source.counts().damaged, 1u);
}

TEST(CameraSource, EndsWhenItIsStopped) {
    CameraSource source(std::make_unique<FakeCamera>(2, false));
    EXPECT_TRUE(source.next());
    std::thread stopper([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        source.stop();
    });
    while (source.next()) continue;
    stopper.join();
}

TEST(CameraSource, ThatWasStoppedBeforeItsFirstFrameDoesNotStart) {
    bool started = false;
    {
        CameraSource source(std::make_unique<FakeCamera>(2, false, &started));
        source.stop();
        EXPECT_FALSE(source.next());
    }
    EXPECT_FALSE(started);
}

}  // namespace
}  // namespace patina::sensor::camera_source_test
