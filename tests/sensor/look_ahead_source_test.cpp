#include "sensor/look_ahead_source.h"

#include <gmock/gmock.h>

#include "tests/sensor/sequences.h"

namespace patina::sensor::look_ahead_source_test {
namespace {

/// Five readings, the third skipped, and no known length.
class FiveReadings : public Source {
  public:
    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override {
        if (next_ == 5) return std::nullopt;
        if (next_ == 2) return Skipped{next_++, "damaged"};
        Frame frame;
        frame.index = next_++;
        return frame;
    }

  private:
    SequenceInfo info_;
    uint32_t next_ = 0;
};

uint32_t index_of(const Reading& reading) {
    return std::visit([](const auto& value) { return value.index; }, reading);
}

TEST(LookAheadSource, WhatIsLookedAtIsStillRead) {
    LookAheadSource source(std::make_unique<FiveReadings>());
    EXPECT_EQ(index_of(source.next().value()), 0u);
    ASSERT_NE(source.peek(1), nullptr);
    EXPECT_TRUE(std::holds_alternative<Skipped>(*source.peek(1)));
    EXPECT_EQ(index_of(*source.peek(0)), 1u);
    EXPECT_EQ(source.peek(4), nullptr);
    for (uint32_t i = 1; i < 5; ++i) EXPECT_EQ(index_of(source.next().value()), i);
    EXPECT_FALSE(source.next());
    EXPECT_EQ(source.peek(0), nullptr);
}

}  // namespace
}  // namespace patina::sensor::look_ahead_source_test
