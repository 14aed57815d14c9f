#include "passes/kinect2/decode.h"

#include "tests/gpu/kinect2/kinect2_test.h"

namespace patina::decode_test {
namespace {

using kinect2::DecodeSettings;
using kinect2::Exponentials;

class DecodeTest : public Kinect2Test {
  protected:
    Image<float> decode(std::span<const uint8_t> infrared, const DecodeSettings& settings = {}) {
        graph::FrameGraph frame = runner().begin();
        const auto images = kinect2::add_decode(frame, tables().import(frame), infrared, settings);
        const graph::Readback depth_m = frame.read_back(images.depth_m);
        run(std::move(frame));
        return depth_m.image<float>();
    }

    std::vector<uint8_t> plane(float depth_m, float amplitude) {
        return scenes::kinect2::infrared_frame(simulated(model()), {Image<float>(kinect2::kInfraredExtent, depth_m),
                                                                    Image<float>(kinect2::kInfraredExtent, amplitude)});
    }
};

TEST_F(DecodeTest, APlaneIsWhereItIs) {
    for (const float z : {1.0f, 2.5f, 4.4f}) {
        const Image<float> depth_m = decode(plane(z, 300));
        EXPECT_GT(valid_share(depth_m), 0.96) << z;
        for (const float got : depth_m.pixels()) {
            // Codes of steps of up to 2 at an amplitude of 300 make less than a millimetre.
            ASSERT_TRUE(got == 0 || std::abs(got - z) < 0.001f) << got << " at " << z;
        }
    }
}

TEST_F(DecodeTest, TheWorkedExampleGivesItsDepth) {
    kinect2::CameraModel uniform = model();
    const uint16_t offsets[] = {0x2C9A, 0x08EC, 0x42E8};
    for (size_t f = 0; f < 3; ++f) uniform.p0[f].assign(kinect2::kInfraredExtent.area(), offsets[f]);
    const auto infrared = scenes::kinect2::infrared_frame(
        simulated(uniform),
        {Image<float>(kinect2::kInfraredExtent, 1.0f), Image<float>(kinect2::kInfraredExtent, 300.0f)});
    kinect2::Tables own(device(), uniform);
    graph::FrameGraph frame = runner().begin();
    DecodeSettings settings;
    settings.smooth_phases = false;
    const auto images = kinect2::add_decode(frame, own.import(frame), infrared, settings);
    const graph::Readback depth_m = frame.read_back(images.depth_m);
    run(std::move(frame));
    // Near the centre the lens moves nothing: column 256, mirrored back.
    EXPECT_NEAR(depth_m.image<float>().at(255, 212), 0.99979, 5e-6) << "as documented, to its digits";
}

TEST_F(DecodeTest, AgreesWithTheReference) {
    const auto infrared = scenes::kinect2::infrared_frame(simulated(model()), cluttered_scene(), {25, 2, 9});
    DecodeSettings base2;
    base2.exponentials = Exponentials::kBase2;
    DecodeSettings plain;
    plain.smooth_phases = plain.drop_edges = false;
    plain.max_m = 8;
    for (const DecodeSettings& settings : {DecodeSettings{}, base2, plain}) {
        const Image<float> got = decode(infrared, settings);
        const Image<double> expected = reference::kinect2::decode(model(), infrared, settings);
        EXPECT_GT(valid_share(expected), 0.5);
        EXPECT_LT(largest_difference(got, expected), 0.0005) << "metres";
        EXPECT_LT(differing_validity(got, expected), 0.001) << "only what is at a threshold may differ";
    }
}

TEST_F(DecodeTest, NoiseAveragesOut) {
    const auto infrared = scenes::kinect2::infrared_frame(
        simulated(model()),
        {Image<float>(kinect2::kInfraredExtent, 2.0f), Image<float>(kinect2::kInfraredExtent, 300.0f)}, {25, 1, 2});
    const Image<float> depth_m = decode(infrared);
    double sum = 0, squares = 0, count = 0;
    for (const float z : depth_m.pixels()) {
        if (z == 0) continue;
        sum += z - 2.0;
        squares += (z - 2.0) * (z - 2.0);
        count += 1;
    }
    EXPECT_GT(count, 200000);
    EXPECT_NEAR(sum / count, 0, 0.0005);
    EXPECT_LT(std::sqrt(squares / count), 0.02);
    EXPECT_GT(std::sqrt(squares / count), 0.001) << "there was no noise";
}

TEST_F(DecodeTest, TheSameFrameGivesTheSameBytes) {
    const auto infrared = scenes::kinect2::infrared_frame(simulated(model()), cluttered_scene(), {25, 2, 9});
    EXPECT_EQ(decode(infrared).pixels(), decode(infrared).pixels());
}

}  // namespace
}  // namespace patina::decode_test
