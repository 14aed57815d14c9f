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

namespace patina::sensor {
namespace {

using namespace testing;
using ::testing::HasSubstr;

constexpr Extent2D kExtent{4, 3};

Image<uint16_t> depth(uint16_t value) { return Image<uint16_t>(kExtent, value); }
Image<SrgbPixel> color(uint8_t value) { return Image<SrgbPixel>(kExtent, SrgbPixel(value)); }

TEST(PicturePairs, JoinWhatIsNearInTimeWhicheverComesFirst) {
    std::vector<std::pair<uint16_t, int>> pairs;
    std::vector<std::string> lost;
    PicturePairs joined(
        0.018,
        [&](double timestamp_s, Image<uint16_t> d, Image<SrgbPixel> c) {
            EXPECT_EQ(timestamp_s, d.at(0, 0) / 1000.0);
            pairs.emplace_back(d.at(0, 0), c.at(0, 0).r);
        },
        [&](const std::string& reason) { lost.push_back(reason); });
    joined.depth(0.100, depth(100));
    joined.color(0.110, color(1));  // after it
    joined.color(0.125, color(2));  // before it
    joined.depth(0.133, depth(133));
    joined.color(0.145, color(3));
    joined.depth(0.170, depth(170));  // 25 ms after: not that one
    EXPECT_THAT(lost, ::testing::IsEmpty());
    joined.depth(0.200, depth(200));  // and no other came for it
    joined.color(0.201, color(4));
    EXPECT_EQ(pairs, (std::vector<std::pair<uint16_t, int>>{{100, 1}, {133, 2}, {200, 4}}));
    ASSERT_EQ(lost.size(), 1u);
    EXPECT_THAT(lost[0], HasSubstr("within 0.018 s"));
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
}  // namespace patina::sensor
