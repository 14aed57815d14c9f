#include "tools/bench/distribution.h"

#include <numeric>

#include <gtest/gtest.h>

namespace patina::distribution_test {
namespace {

TEST(Distribution, NineInTenSamplesAreAtMostP90) {
    for (const size_t count : {1u, 2u, 9u, 10u, 11u, 100u}) {
        std::vector<float> samples(count);
        std::iota(samples.rbegin(), samples.rend(), 1.0f);
        const bench::Distribution got = bench::distribution(samples);
        EXPECT_EQ(got.count, count);
        EXPECT_EQ(got.min, 1.0f);
        EXPECT_EQ(got.median, static_cast<float>(count / 2 + 1));
        const auto at_most = static_cast<size_t>(got.p90);  // samples are 1, 2, 3, ...
        EXPECT_GE(10 * at_most, 9 * count);
        EXPECT_LT(10 * (at_most - 1), 9 * count);
    }
}

TEST(Distribution, OfNothingIsZero) { EXPECT_EQ(bench::distribution({}).count, 0u); }

}  // namespace
}  // namespace patina::distribution_test
