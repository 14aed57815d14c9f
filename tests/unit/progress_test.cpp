#include "tools/program/progress.h"

#include <gtest/gtest.h>

namespace patina::tools::progress_test {
namespace {

TEST(Progress, TimeLeftIsForAPerson) {
    EXPECT_EQ(time_left(10, 20, 60), "20 s left");
    EXPECT_EQ(time_left(10, 1, 31), "5 min left");
    EXPECT_EQ(time_left(60, 1, 181), "3.0 h left");
    EXPECT_EQ(time_left(10, 60, 60), "0 s left");
}

TEST(Progress, NothingIsSaidOfWhatIsNotKnown) {
    EXPECT_EQ(time_left(1, 20, 60), "") << "too early";
    EXPECT_EQ(time_left(10, 0, 60), "");
    EXPECT_EQ(time_left(10, 20, std::nullopt), "");
    EXPECT_EQ(time_left(10, 61, 60), "") << "more frames than were told";
}

}  // namespace
}  // namespace patina::tools::progress_test
