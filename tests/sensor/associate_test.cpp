#include "sensor/associate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

namespace patina::sensor::associate_test {
namespace {

using Partners = std::vector<std::optional<size_t>>;

/// The rule as it is said: all pairs within the limit, the nearest first.
Partners plain(const std::vector<double>& a, const std::vector<double>& b, double limit_s) {
    std::vector<std::tuple<double, size_t, size_t>> pairs;
    for (size_t i = 0; i < a.size(); ++i) {
        for (size_t j = 0; j < b.size(); ++j) {
            if (b[j] >= a[i] - limit_s && b[j] <= a[i] + limit_s) pairs.emplace_back(std::abs(b[j] - a[i]), i, j);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    Partners partners(a.size());
    std::vector<bool> taken(b.size());
    for (const auto& [distance_s, i, j] : pairs) {
        if (partners[i] || taken[j]) continue;
        partners[i] = j;
        taken[j] = true;
    }
    return partners;
}

TEST(Associate, TakesTheNearestPairsFirstAndEachOnce) {
    const std::vector<double> a{0.0, 1.0, 2.0};
    EXPECT_EQ(associate(a, std::vector<double>{2.25, 0.25, 1.25}, 0.5), (Partners{1, 2, 0}));
    EXPECT_EQ(associate(a, std::vector<double>{0.75}, 0.5), (Partners{std::nullopt, 0, std::nullopt}));
    EXPECT_EQ(associate(a, std::vector<double>{0.5, 0.75}, 0.5),
              (Partners{0, 1, std::nullopt}));  // the limit counts as within
    EXPECT_EQ(associate(std::vector<double>{0.0, 0.25, 0.5}, std::vector<double>{0.25}, 0.5),
              (Partners{std::nullopt, 0, std::nullopt}));
    EXPECT_EQ(associate(a, {}, 0.5), (Partners(3)));
    EXPECT_EQ(associate({}, a, 0.5), Partners{});
}

// Multiples of 1/64 s over a short time: most timestamps are there several times, and most distances too.
TEST(Associate, IsTheRuleForListsWithManyTies) {
    std::mt19937 random(1);
    for (int round = 0; round < 2000; ++round) {
        std::vector<double> a(random() % 12), b(random() % 12);
        for (std::vector<double>* list : {&a, &b}) {
            for (double& time_s : *list) time_s = double(random() % 16) / 64;
        }
        const double limit_s = double(random() % 10) / 64;
        ASSERT_EQ(associate(a, b, limit_s), plain(a, b, limit_s)) << "round " << round;
    }
}

TEST(Associate, IsTheRuleForRecordedTimes) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> jitter_s(-0.03, 0.03);
    for (int round = 0; round < 200; ++round) {
        std::vector<double> a, b;
        for (int i = 0; i < 60; ++i) {
            if (random() % 8 != 0) a.push_back(1305031102 + i / 30.0 + jitter_s(random));
            if (random() % 8 != 0) b.push_back(1305031102 + i / 30.0 + jitter_s(random));
        }
        std::shuffle(b.begin(), b.end(), random);
        ASSERT_EQ(associate(a, b, 0.02), plain(a, b, 0.02)) << "round " << round;
    }
}

// All pairs of 200 000 timestamps within the limit of each other are 4 10^10.
TEST(Associate, LongListsOfTheSameTimeTakeNoLongerThanOthers) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<double> same(200000, 7.0);
    const Partners partners = associate(same, same, 0.02);
    EXPECT_EQ(partners.front(), 0u);
    EXPECT_EQ(partners.back(), 199999u);
    std::vector<double> dense(200000);
    for (size_t i = 0; i < dense.size(); ++i) dense[i] = 1e-7 * static_cast<double>(i);
    EXPECT_EQ(associate(dense, same, 0.02), Partners(dense.size()));
    std::vector<double> shifted = dense;
    for (double& time_s : shifted) time_s += 3e-8;
    EXPECT_EQ(associate(dense, shifted, 0.02).back(), 199999u);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

}  // namespace
}  // namespace patina::sensor::associate_test
