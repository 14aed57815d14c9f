#include "passes/kinect2/measure_phases.h"

#include <numbers>

#include "tests/gpu/kinect2/kinect2_test.h"

namespace patina::measure_phases_test {
namespace {

class MeasurePhasesTest : public Kinect2Test {
  protected:
    reference::kinect2::Measured measure(std::span<const uint8_t> infrared) {
        graph::FrameGraph frame = runner().begin();
        const kinect2::PhasorIds ids = kinect2::add_measure_phases(frame, tables().import(frame), infrared);
        const graph::Readback ab = frame.read_back(ids.ab), c = frame.read_back(ids.c);
        run(std::move(frame));
        const auto first = ab.as<glm::vec4>(), second = c.as<glm::vec4>();
        reference::kinect2::Measured measured{constant_phasors({}), Image<double>(kinect2::kInfraredExtent)};
        for (size_t i = 0; i < first.size(); ++i) {
            measured.phasors[0].pixels()[i] = glm::dvec2(first[i].x, first[i].y);
            measured.phasors[1].pixels()[i] = glm::dvec2(first[i].z, first[i].w);
            measured.phasors[2].pixels()[i] = glm::dvec2(second[i].x, second[i].y);
            measured.infrared.pixels()[i] = second[i].z;
        }
        return measured;
    }
};

TEST_F(MeasurePhasesTest, APhasorsAngleIsTheTravelAndItsLengthTheLight) {
    const scenes::kinect2::InfraredScene scene{Image<float>(kinect2::kInfraredExtent, 2.0f),
                                               Image<float>(kinect2::kInfraredExtent, 250.0f)};
    const auto measured = measure(scenes::kinect2::infrared_frame(simulated(model()), scene));
    const auto& tables = this->tables().host();
    const double gain[] = {1.322581, 1.0, 1.612903}, wraps[] = {3, 15, 2};
    for (const glm::uvec2 at : {glm::uvec2(1, 0), {255, 211}, {256, 212}, {510, 423}, {300, 30}}) {
        const glm::vec4 ray = tables.offsets_c_ray.at(at.x, at.y);
        const double s = 6250.0 / 3 / ray.w, y2 = s * s - 1 - ray.z * ray.z;
        const double travel = scenes::kinect2::travel_mm({ray.z, std::sqrt(std::max(y2, 0.0))}, 2000) / 1250;
        double mean = 0;
        for (int f = 0; f < 3; ++f) {
            const double angle = 2 * std::numbers::pi * travel / wraps[f];
            const glm::dvec2 expected = 1.5 * gain[f] * 250.0 * glm::dvec2(std::cos(angle), std::sin(angle));
            // Three codes are rounded to half a measurement each, and to one beyond 256.
            EXPECT_LT(glm::length(measured.phasors[f].at(at.x, at.y) - expected), 2.0) << f;
            mean += 1.5 * gain[f] * 250.0 / 3;
        }
        EXPECT_NEAR(measured.infrared.at(at.x, at.y), mean * 2 / 3 * 16, 2.0 * 16) << at.x << ' ' << at.y;
    }
    EXPECT_EQ(measured.phasors[0].at(0, 100), glm::dvec2(0)) << "the first column carries no data";
    EXPECT_EQ(measured.phasors[2].at(511, 100), glm::dvec2(0));
    EXPECT_EQ(measured.infrared.at(511, 100), 0);
}

TEST_F(MeasurePhasesTest, ASaturatedFrequencyIsDarkInPhaseAndBrightInThePicture) {
    scenes::kinect2::InfraredScene scene{Image<float>(kinect2::kInfraredExtent, 2.0f),
                                         Image<float>(kinect2::kInfraredExtent, 250.0f)};
    scene.amplitude.at(77, 300) = 1e6f;
    const auto measured = measure(scenes::kinect2::infrared_frame(simulated(model()), scene));
    for (const auto& phasors : measured.phasors) EXPECT_EQ(phasors.at(77, 300), glm::dvec2(0));
    EXPECT_EQ(measured.infrared.at(77, 300), 65535);
    EXPECT_LT(measured.infrared.at(78, 300), 65535);
}

TEST_F(MeasurePhasesTest, AgreesWithTheReference) {
    const auto infrared = scenes::kinect2::infrared_frame(simulated(model()), cluttered_scene(), {25, 2, 3});
    const auto got = measure(infrared), expected = reference::kinect2::measure_phases(model(), infrared);
    for (size_t i = 0; i < kinect2::kInfraredExtent.area(); ++i) {
        for (size_t f = 0; f < 3; ++f) {
            const glm::dvec2 phasor = expected.phasors[f].pixels()[i];
            // Sums of three products in single precision; the documented 4.18879 is 2.5e-6 off.
            ASSERT_LT(glm::length(got.phasors[f].pixels()[i] - phasor), 1e-5 * glm::length(phasor) + 1e-2)
                << f << ' ' << i;
        }
        ASSERT_NEAR(got.infrared.pixels()[i], expected.infrared.pixels()[i],
                    1e-5 * expected.infrared.pixels()[i] + 0.1);
    }
}

TEST_F(MeasurePhasesTest, ShortFramesAreAnError) {
    graph::FrameGraph frame = runner().begin();
    const std::vector<uint8_t> bytes(9 * kinect2::kSubImageBytes - 1);
    const kinect2::TableIds ids = tables().import(frame);
    try {
        kinect2::add_measure_phases(frame, ids, bytes);
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "the pass 'kinect2.measure_phases' got 2686463 bytes of an infrared frame, not 2686464");
    }
}

}  // namespace
}  // namespace patina::measure_phases_test
