#include "passes/kinect2/undistort_depth.h"

#include "passes/kinect2/unwrap_phases.h"
#include "tests/gpu/kinect2/kinect2_test.h"

namespace patina::undistort_depth_test {
namespace {

using kinect2::DecodeSettings;
using reference::kinect2::Unwrapped;

class UndistortDepthTest : public Kinect2Test {
  protected:
    struct Pictures {
        Image<float> depth_m, infrared;
    };
    Pictures undistort(kinect2::Tables& of, const Unwrapped& readings, const Image<uint8_t>& even,
                       const DecodeSettings& settings = {}) {
        graph::FrameGraph frame = runner().begin();
        const auto images =
            kinect2::add_undistort_depth(frame, of.import(frame), upload(frame, readings, even), settings);
        const graph::Readback depth = frame.read_back(images.depth_m), light = frame.read_back(images.infrared);
        run(std::move(frame));
        return {depth.image<float>(), light.image<float>()};
    }

    /// Depth of the sensor's pixels in mm, through a lens that bends nothing; mirrored as they are.
    Image<float> filter(const Unwrapped& readings, const Image<uint8_t>& even, const DecodeSettings& settings = {}) {
        kinect2::CameraModel straight = model();
        straight.depth.distortion = {};
        kinect2::Tables own(device(), straight);
        const Image<float> depth_m = undistort(own, readings, even, settings).depth_m;
        Image<float> depth_mm(depth_m.extent());
        for (uint32_t y = 0; y < 424; ++y) {
            for (uint32_t x = 0; x < 512; ++x) depth_mm.at(511 - x, y) = std::round(1000 * depth_m.at(x, y));
        }
        return depth_mm;
    }

    /// A near wall on the left of column 200, a far one from there on, as bright as one material makes them.
    static Unwrapped step() {
        Unwrapped readings = constant(0, 0);
        for (uint32_t y = 0; y < 424; ++y) {
            for (uint32_t x = 0; x < 512; ++x) {
                readings.depth_mm.at(x, y) = x < 200 ? 1000 : 2000;
                readings.amplitude.at(x, y) = x < 200 ? 800 : 200;
            }
        }
        return readings;
    }
    static Unwrapped constant(double depth_mm, double amplitude) {
        return {Image<double>(kinect2::kInfraredExtent, depth_mm), Image<double>(kinect2::kInfraredExtent, amplitude)};
    }
    static Image<uint8_t> all_even() { return Image<uint8_t>(kinect2::kInfraredExtent, 1); }
};

TEST_F(UndistortDepthTest, APointOfTheWorldIsWhereThePinholeCameraSeesIt) {
    // The sensor's pixels hold their own ray, so that the straight picture must hold its pixels' rays.
    const auto& host = tables().host();
    Unwrapped readings = constant(0, 500);
    for (size_t i = 0; i < readings.depth_mm.pixels().size(); ++i)
        readings.depth_mm.pixels()[i] = 1000 * (2.0 + host.offsets_c_ray.pixels()[i].z);
    const Image<float> got = undistort(tables(), readings, all_even()).depth_m;
    const Intrinsics camera = host.depth;
    EXPECT_FALSE(camera.distorted());
    size_t seen = 0;
    for (uint32_t y = 0; y < 424; ++y) {
        for (uint32_t x = 0; x < 512; ++x) {
            if (got.at(x, y) == 0) continue;
            ++seen;
            // Mirrored back, x points the other way. The nearest pixel is half a pixel away, stretched by the lens in
            // the corners.
            ASSERT_NEAR(2.0 - got.at(x, y), (x - camera.cx) / camera.fx, 0.8 / camera.fx) << x << ' ' << y;
        }
    }
    EXPECT_GT(seen, 0.97 * static_cast<double>(kinect2::kInfraredExtent.area()));
}

TEST_F(UndistortDepthTest, WhatLiesBetweenTwoSurfacesGoesAndTheSurfacesStay) {
    Unwrapped readings = step();
    for (uint32_t y = 100; y < 120; ++y) readings.depth_mm.at(200, y) = 1500;
    const Image<float> filtered = filter(readings, all_even());
    for (uint32_t y = 100; y < 120; ++y) EXPECT_EQ(filtered.at(200, y), 0) << y;
    EXPECT_EQ(filtered.at(199, 110), 1000);
    EXPECT_EQ(filtered.at(201, 110), 2000);
    DecodeSettings settings;
    settings.drop_edges = false;
    EXPECT_EQ(filter(readings, all_even(), settings).at(200, 110), 1500);
}

TEST_F(UndistortDepthTest, WhereTheLightIsEvenNothingIsBetweenSurfaces) {
    Unwrapped readings = step();
    readings.depth_mm.at(200, 110) = 1500;
    readings.amplitude = Image<double>(kinect2::kInfraredExtent, 500);
    EXPECT_EQ(filter(readings, all_even()).at(200, 110), 1500);
}

TEST_F(UndistortDepthTest, UnevenPhasesAndReadingsOutsideOfTheRangeGo) {
    Unwrapped readings = constant(1000, 500);
    readings.depth_mm.at(10, 10) = 499;
    readings.depth_mm.at(20, 10) = 500;
    readings.depth_mm.at(300, 10) = 4500;
    readings.depth_mm.at(310, 10) = 4501;
    readings.depth_mm.at(0, 20) = 4501;
    Image<uint8_t> even = all_even();
    even.at(50, 50) = even.at(0, 50) = 0;
    const Image<float> filtered = filter(readings, even);
    EXPECT_EQ(filtered.at(10, 10), 0);
    EXPECT_EQ(filtered.at(20, 10), 500);
    EXPECT_EQ(filtered.at(300, 10), 4500);
    EXPECT_EQ(filtered.at(310, 10), 0);
    EXPECT_EQ(filtered.at(0, 20), 0) << "a border pixel has to be in range, too";
    EXPECT_EQ(filtered.at(50, 50), 0);
    EXPECT_EQ(filtered.at(0, 50), 1000) << "nothing is known of edges at the border";
}

TEST_F(UndistortDepthTest, AgreesWithTheReference) {
    const auto infrared = scenes::kinect2::infrared_frame(simulated(model()), cluttered_scene(), {25, 2, 6});
    const auto phasors = reference::kinect2::measure_phases(model(), infrared).phasors;
    const auto smoothed = reference::kinect2::smooth_phases(phasors, {});
    Unwrapped readings = reference::kinect2::unwrap_phases(model(), smoothed.phasors, {});
    for (auto* picture : {&readings.depth_mm, &readings.amplitude}) {
        for (double& value : picture->pixels()) value = static_cast<float>(value);  // as the device gets them
    }
    const Pictures got = undistort(tables(), readings, smoothed.even);
    const Image<double> expected =
        reference::kinect2::undistort(model(), reference::kinect2::filter_edges(readings, smoothed.even, {}));
    const Image<double> unfiltered = reference::kinect2::undistort(model(), readings.depth_mm);
    EXPECT_GT(differing_validity(unfiltered, expected), 0.02) << "nothing was dropped";
    EXPECT_LT(differing_validity(got.depth_m, expected), 1e-4) << "only what is at a threshold may differ";
    Image<double> light(kinect2::kInfraredExtent);
    for (size_t i = 0; i < light.pixels().size(); ++i) light.pixels()[i] = static_cast<double>(i);
    const Image<double> straight_light = reference::kinect2::undistort(model(), light);
    for (size_t i = 0; i < light.pixels().size(); ++i) {
        if (got.depth_m.pixels()[i] == 0) continue;
        ASSERT_FLOAT_EQ(got.depth_m.pixels()[i], static_cast<float>(0.001 * unfiltered.pixels()[i])) << i;
    }
    for (size_t i = 0; i < light.pixels().size(); ++i)
        ASSERT_EQ(got.infrared.pixels()[i], straight_light.pixels()[i]) << i;
}

TEST_F(UndistortDepthTest, ARangeWithoutUseIsAnError) {
    DecodeSettings settings;
    settings.max_m = 0.4f;
    try {
        undistort(tables(), step(), all_even(), settings);
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "the pass 'kinect2.undistort_depth' got a range without use: 0.5 m to 0.4 m");
    }
}

}  // namespace
}  // namespace patina::undistort_depth_test
