#include "tests/reference/observation/observation_set.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patina::reference::observation_set_test {
namespace {

Direction at_degrees(double degrees, uint32_t id) {
    const double angle = glm::radians(degrees);
    return {on_grid({std::sin(angle), 0, std::cos(angle)}), id};
}

std::vector<uint32_t> ids(const std::vector<Direction>& set) {
    std::vector<uint32_t> result;
    for (const Direction& d : set) result.push_back(d.id);
    return result;
}

TEST(ObservationSet, OfTheClosestPairTheOneInTheDenserPlaceGoes) {
    std::vector<Direction> set{at_degrees(0, 0), at_degrees(20, 1), at_degrees(60, 2)};
    insert(set, at_degrees(10, 3), 3, 0);  // it is 10 from both: the new one goes
    EXPECT_THAT(ids(set), testing::ElementsAre(0, 1, 2));
    insert(set, at_degrees(85, 4), 3, 0);  // 0 and 20 are closest; 20 is 40 from its next, 0 is 60: 20 goes
    EXPECT_THAT(ids(set), testing::ElementsAre(0, 4, 2));
    insert(set, at_degrees(-40, 5), 3, 0);  // 60 and 85 are closest; 60 is 60 from its next, 85 is 85: 60 goes
    EXPECT_THAT(ids(set), testing::ElementsAre(0, 4, 5));
}

TEST(ObservationSet, DirectionsWithinTheMergeDistanceAreLeftOut) {
    std::vector<Direction> set{at_degrees(0, 0)};
    const double one_degree = std::pow(2 * std::sin(glm::radians(0.5)) * 2048, 2);
    insert(set, at_degrees(0.9, 1), 30, one_degree);
    EXPECT_EQ(set.size(), 1u);
    insert(set, at_degrees(1.1, 2), 30, one_degree);
    EXPECT_EQ(set.size(), 2u);
}

TEST(ObservationSet, UnpackedDirectionsAreOfUnitLengthInTheirOctant) {
    const auto word = [](int x, int y) {
        return (static_cast<uint32_t>(x) & 8191) | (static_cast<uint32_t>(y) & 8191) << 13;
    };
    EXPECT_EQ(unpack_direction(word(0, 0)), glm::dvec3(0, 0, 1));
    EXPECT_EQ(unpack_direction(word(-4095, 0)), glm::dvec3(-1, 0, 0));
    EXPECT_NEAR(glm::distance(unpack_direction(word(4095, -4095)), glm::dvec3(0, 0, -1)), 0, 1e-12);
    const glm::dvec3 low = unpack_direction(word(-3000, 2500));
    EXPECT_LT(low.x, 0);
    EXPECT_GT(low.y, 0);
    EXPECT_LT(low.z, 0);
    EXPECT_NEAR(glm::length(low), 1, 1e-12);
}

/// A camera's way around a surface point: directions 0.7 degrees apart, on curves as of a hand that sweeps back and
/// forth, all within 75 degrees of the normal.
std::vector<Direction> sweep(uint32_t seed, uint32_t count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    const double a = 0.3 + share(random), b = 0.3 + share(random), phase = 6 * share(random);
    std::vector<Direction> all;
    for (uint32_t i = 0; i < count; ++i) {
        const double t = 0.02 * i;
        const double polar = glm::radians(75.0) * std::abs(std::sin(a * t + phase)), azimuth = 2.5 * std::sin(b * t);
        all.push_back(
            {on_grid({std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)}), i});
    }
    return all;
}

std::vector<Direction> scattered(uint32_t seed, uint32_t count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<Direction> all;
    for (uint32_t i = 0; i < count; ++i) {
        const double z = std::cos(glm::radians(75.0)), height = z + (1 - z) * share(random);
        const double radius = std::sqrt(1 - height * height), azimuth = 2 * 3.141592653589793 * share(random);
        all.push_back({on_grid({radius * std::cos(azimuth), radius * std::sin(azimuth), height}), i});
    }
    return all;
}

TEST(ObservationSet, CoversWhatWasSeenAsWellAsFarthestPointsOfAll) {
    for (const auto& make : {scattered, sweep}) {
        Coverage kept_sum, best_sum;
        constexpr uint32_t kStreams = 30;
        for (uint32_t seed = 0; seed < kStreams; ++seed) {
            const std::vector<Direction> all = make(seed, 400);
            std::vector<Direction> kept;
            for (const Direction& d : all) insert(kept, d, 30, 0);
            const Coverage got = coverage(all, kept), best = coverage(all, farthest_points(all, 30));
            kept_sum.mean += got.mean / kStreams;
            kept_sum.largest += got.largest / kStreams;
            best_sum.mean += best.mean / kStreams;
            best_sum.largest += best.largest / kStreams;
        }
        EXPECT_LE(kept_sum.mean, best_sum.mean / 0.95);
        // Farthest points are chosen for this one, knowing all.
        EXPECT_LE(kept_sum.largest, best_sum.largest / 0.88);
    }
}

}  // namespace
}  // namespace patina::reference::observation_set_test
