#include "sensor/prefetch.h"

#include <atomic>
#include <chrono>
#include <limits>

#include <gmock/gmock.h>

#include "tests/sensor/sequences.h"

namespace patina::sensor::prefetch_test {
namespace {

using namespace testing;
using namespace std::chrono_literals;

/// Yields empty frames, tells how many, and fails at one of them.
class CountingSource : public Source {
  public:
    CountingSource(uint32_t frames, std::atomic<uint32_t>& yielded,
                   uint32_t fails_at = std::numeric_limits<uint32_t>::max())
        : yielded_(yielded), fails_at_(fails_at) {
        info_.frames = frames;
    }
    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override {
        if (next_ == fails_at_) throw Error("frame ", next_, " failed");
        if (next_ == info_.frames) return std::nullopt;
        ++yielded_;
        Frame frame;
        frame.index = next_++;
        if (frame.index % 3 == 2) return Skipped{frame.index, "damaged"};
        return frame;
    }

  private:
    SequenceInfo info_;
    std::atomic<uint32_t>& yielded_;
    uint32_t fails_at_;
    uint32_t next_ = 0;
};

uint32_t index_of(const Reading& reading) {
    return std::visit([](const auto& value) { return value.index; }, reading);
}

TEST(Prefetch, KeepsOrderAndDropsNothing) {
    for (const size_t capacity : {1u, 4u, 1000u}) {
        std::atomic<uint32_t> yielded = 0;
        PrefetchSource source(std::make_unique<CountingSource>(500, yielded), capacity);
        EXPECT_EQ(source.info().frames, 500u);
        const std::vector<Reading> readings = read_all(source);
        ASSERT_EQ(readings.size(), 500u);
        for (uint32_t i = 0; i < 500; ++i) {
            ASSERT_EQ(index_of(readings[i]), i);
            ASSERT_EQ(std::holds_alternative<Skipped>(readings[i]), i % 3 == 2);
        }
        EXPECT_FALSE(source.next()) << "the end stays the end";
    }
}

TEST(Prefetch, ReadsAheadButNotBeyondItsQueue) {
    std::atomic<uint32_t> yielded = 0;
    PrefetchSource source(std::make_unique<CountingSource>(1000, yielded), 4);
    const auto deadline = std::chrono::steady_clock::now() + 10s;
    while (yielded < 5 && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(20ms);
    EXPECT_EQ(yielded, 5u) << "four in the queue, one decoded and waiting";
}

TEST(Prefetch, ErrorsArriveAfterTheFramesBeforeThem) {
    std::atomic<uint32_t> yielded = 0;
    PrefetchSource source(std::make_unique<CountingSource>(10, yielded, 4), 2);
    for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(index_of(source.next().value()), i);
    for (int repeat = 0; repeat < 2; ++repeat) EXPECT_EQ(error_of([&] { source.next(); }), "frame 4 failed");
}

TEST(Prefetch, StopsPromptlyWhenDestroyed) {
    for (const uint32_t taken : {0u, 1u, 7u}) {
        std::atomic<uint32_t> yielded = 0;
        {
            PrefetchSource source(std::make_unique<CountingSource>(1'000'000, yielded), 4);
            for (uint32_t i = 0; i < taken; ++i) source.next();
        }
        EXPECT_LE(yielded, taken + 5);
    }
}

}  // namespace
}  // namespace patina::sensor::prefetch_test
