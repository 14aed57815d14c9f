#include "passes/kinect2/unwrap_phases.h"

#include <numbers>

#include "tests/gpu/kinect2/kinect2_test.h"

namespace patina::unwrap_phases_test {
namespace {

using kinect2::DecodeSettings;
using kinect2::Exponentials;
using reference::kinect2::Phasors;

class UnwrapPhasesTest : public Kinect2Test {
  protected:
    Readings unwrap(const Phasors& phasors, const DecodeSettings& settings) {
        graph::FrameGraph frame = runner().begin();
        const kinect2::PhasorIds ids = upload(frame, phasors);
        const graph::Readback readings =
            frame.read_back(kinect2::add_unwrap_phases(frame, tables().import(frame), ids, settings));
        run(std::move(frame));
        return readings_of(readings);
    }

    /// Without smoothing.
    Readings unwrap(const Phasors& phasors, Exponentials exponentials = Exponentials::kAsLibfreenect2) {
        DecodeSettings settings;
        settings.exponentials = exponentials;
        settings.smooth_phases = false;
        return unwrap(phasors, settings);
    }

    Readings smooth(const Phasors& phasors, Exponentials exponentials = Exponentials::kAsLibfreenect2) {
        DecodeSettings settings;
        settings.exponentials = exponentials;
        return unwrap(phasors, settings);
    }

    /// Phasors of so many units of 1.25 m of travel at every pixel, with an error of the phase at 16 MHz.
    static Phasors of_travel(double units, double length, double error_b = 0) {
        const double wraps[] = {3, 15, 2};
        Phasors phasors;
        for (size_t f = 0; f < 3; ++f) {
            const double angle = 2 * std::numbers::pi * units / wraps[f] + (f == 1 ? error_b : 0);
            const glm::dvec2 phasor = length * glm::dvec2(std::cos(angle), std::sin(angle));
            phasors[f] = Image<glm::dvec2>(kinect2::kInfraredExtent, phasor);
        }
        return phasors;
    }
};

TEST_F(UnwrapPhasesTest, EveryDistanceUpToTheSensorsRangeIsFound) {
    const glm::vec4 ray = tables().host().offsets_c_ray.at(100, 300);
    const double s = 6250.0 / 3 / ray.w, y2 = s * s - 1 - ray.z * ray.z;
    for (const double z_mm : {500.0, 1000.0, 1875.0, 2500.0, 4400.0, 8000.0, 12000.0, 16000.0}) {
        const double units = scenes::kinect2::travel_mm({ray.z, std::sqrt(y2)}, z_mm) / 1250;
        // A phase of 1e-6 turns, which is what single precision leaves, is 0.01 mm at 16 MHz, and more counts far away.
        EXPECT_NEAR(unwrap(of_travel(units, 300)).depth_mm.at(100, 300), z_mm, 0.05) << z_mm;
    }
}

TEST_F(UnwrapPhasesTest, WhatIsDarkAtAnyFrequencyOrInSumIsNoReading) {
    EXPECT_GT(unwrap(of_travel(2, 5.01)).depth_mm.at(200, 200), 0);
    EXPECT_NEAR(unwrap(of_travel(2, 5.01)).amplitude.at(200, 200), 5.01 * 2, 1e-4);
    EXPECT_EQ(unwrap(of_travel(2, 4.99)).depth_mm.at(200, 200), 0) << "amplitudes of 9.98 together";
    Phasors phasors = of_travel(2, 100);
    phasors[2].at(200, 200) *= 0.044;  // an amplitude of 2.93
    const Image<float> depth_mm = unwrap(phasors).depth_mm;
    EXPECT_EQ(depth_mm.at(200, 200), 0);
    EXPECT_GT(depth_mm.at(201, 200), 0);
}

TEST_F(UnwrapPhasesTest, PhasesThatDisagreeAreNoReadingBeyondALimitThatFallsWithTheLight) {
    const auto accepted = [&](double amplitude, double error, Exponentials exponentials) {
        return unwrap(of_travel(4, 1.5 * amplitude, error), exponentials).depth_mm.at(200, 200) > 0;
    };
    // The part of an error at 16 MHz that is perpendicular to the line of all distances.
    const double perpendicular = std::sqrt(1 - 0.110264 * 0.110264);
    constexpr auto kBase2 = Exponentials::kBase2, kNatural = Exponentials::kAsLibfreenect2;
    // The documented limits, within the sensor's 20 to 35 degrees.
    for (const auto& [amplitude, exponentials, limit] :
         {std::tuple(60.0, kBase2, 0.6108653), std::tuple(100.0, kBase2, 0.505), std::tuple(500.0, kBase2, 0.3490659),
          std::tuple(100.0, kNatural, 0.6108653), std::tuple(500.0, kNatural, 0.469),
          std::tuple(1000.0, kNatural, 0.3490659)}) {
        EXPECT_TRUE(accepted(amplitude, 0.98 * limit / perpendicular, exponentials)) << amplitude;
        EXPECT_FALSE(accepted(amplitude, 1.02 * limit / perpendicular, exponentials)) << amplitude;
    }
}

TEST_F(UnwrapPhasesTest, SmoothingLeavesEvenPhasorsAsTheyAre) {
    const Readings smoothed = smooth(of_travel(4, 300)), plain = unwrap(of_travel(4, 300));
    EXPECT_LT(largest_difference(smoothed.depth_mm, plain.depth_mm), 0.01);
    EXPECT_LT(largest_difference(smoothed.amplitude, plain.amplitude), 0.01);
    EXPECT_THAT(smoothed.even.pixels(), testing::Each(1));
}

TEST_F(UnwrapPhasesTest, ANeighbourWeighsByHowWellItsPhaseAgrees) {
    Phasors phasors = constant_phasors({0, 0});
    // Two bright pixels side by side, a quarter turn apart: half of the largest distance.
    phasors[1].at(100, 101) = {100, 0};
    phasors[1].at(101, 101) = {0, 100};
    for (const Exponentials exponentials : {Exponentials::kAsLibfreenect2, Exponentials::kBase2}) {
        const double weight =
            exponentials == Exponentials::kBase2 ? std::exp2(-1.442695 * 5 * 0.5) : std::exp(-1.442695 * 5 * 0.5);
        const double center = 0.1195716, side = 0.1131098 * weight;
        const double length = 100 * std::hypot(center, side) / (center + side);
        EXPECT_NEAR(smooth(phasors, exponentials).amplitude.at(100, 101), length * 2 / 3, 1e-3);
    }
}

TEST_F(UnwrapPhasesTest, ADarkPixelTakesWhatIsAroundIt) {
    Phasors phasors = constant_phasors({0, 200});
    for (auto& image : phasors) image.at(50, 60) = {0, 0};
    const double others = 4 * 0.1131098 + 4 * 0.1069973;
    EXPECT_NEAR(smooth(phasors).amplitude.at(50, 60), 3 * 200 * others / (others + 0.1195716) * 2 / 3, 1e-2);
}

TEST_F(UnwrapPhasesTest, APixelWhoseNeighboursDisagreeIsAtAnEdge) {
    Phasors phasors = constant_phasors({200, 0});
    // Three opposite neighbours make a distance of 3, two of them one of 2.
    for (uint32_t x = 99; x <= 101; ++x) phasors[0].at(x, 99) = {-200, 0};
    for (uint32_t x = 199; x <= 200; ++x) phasors[0].at(x, 99) = {-200, 0};
    const Readings smoothed = smooth(phasors);
    EXPECT_EQ(smoothed.even.at(100, 100), 0);
    EXPECT_EQ(smoothed.even.at(200, 100), 1);
    EXPECT_EQ(smoothed.even.at(100, 102), 1);
    EXPECT_EQ(unwrap(phasors).even.at(100, 100), 1) << "nothing is known of edges without smoothing";
}

TEST_F(UnwrapPhasesTest, TheBorderIsNotSmoothed) {
    Phasors phasors = constant_phasors({200, 0});
    for (auto& image : phasors) image.at(0, 10) = image.at(20, 423) = {-70, 3};
    const Readings smoothed = smooth(phasors);
    for (const glm::uvec2 at : {glm::uvec2(0, 10), {20, 423}}) {
        EXPECT_NEAR(smoothed.amplitude.at(at.x, at.y), 2 * std::hypot(70, 3), 1e-3);
        EXPECT_EQ(smoothed.even.at(at.x, at.y), 1);
    }
}

TEST_F(UnwrapPhasesTest, AgreesWithTheReference) {
    const auto infrared = scenes::kinect2::infrared_frame(simulated(model()), cluttered_scene(), {25, 2, 5});
    const Phasors phasors = reference::kinect2::measure_phases(model(), infrared).phasors;
    for (const Exponentials exponentials : {Exponentials::kAsLibfreenect2, Exponentials::kBase2}) {
        const auto smoothed = reference::kinect2::smooth_phases(phasors, exponentials);
        const auto edges = std::count(smoothed.even.pixels().begin(), smoothed.even.pixels().end(), 0);
        EXPECT_GT(edges, 1000);
        for (const bool smoothing : {false, true}) {
            DecodeSettings settings;
            settings.exponentials = exponentials;
            settings.smooth_phases = smoothing;
            const Readings got = unwrap(phasors, settings);
            const auto expected =
                reference::kinect2::unwrap_phases(model(), smoothing ? smoothed.phasors : phasors, exponentials);
            EXPECT_GT(valid_share(expected.depth_mm), 0.6);
            EXPECT_LT(valid_share(expected.depth_mm), 0.98) << "nothing was refused";
            EXPECT_LT(differing_validity(got.depth_mm, expected.depth_mm), 1e-4) << "only what is at a threshold";
            EXPECT_LT(largest_difference(got.depth_mm, expected.depth_mm), 0.1) << "mm; single precision";
            EXPECT_LT(largest_difference(got.amplitude, expected.amplitude), 0.1);
            size_t apart = 0;
            for (size_t i = 0; i < got.even.pixels().size(); ++i)
                apart += smoothing && got.even.pixels()[i] != smoothed.even.pixels()[i];
            EXPECT_LT(apart, 20u) << "only what is at the threshold";
        }
    }
}

}  // namespace
}  // namespace patina::unwrap_phases_test
