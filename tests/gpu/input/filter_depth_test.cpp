#include "passes/input/filter_depth.h"

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/reference/input/filter_depth.h"

namespace patina::filter_depth_test {
namespace {

class FilterDepthTest : public GpuTest {
  protected:
    Image<float> filter(const Image<float>& depth_m, const DepthFilter& settings = {}) {
        graph::FrameGraph frame = runner().begin();
        const auto id = frame.upload("depth_m", {depth_m.extent(), vulkan::Format::kR32f},
                                     std::as_bytes(std::span(depth_m.pixels())));
        const graph::Readback result = frame.read_back(add_filter_depth(frame, id, settings));
        run(std::move(frame));
        return result.image<float>();
    }

    std::vector<Image<float>> filter_both(const Image<float>& depth_m) {
        return {filter(depth_m), reference::filter_depth(depth_m, {})};
    }
};

TEST_F(FilterDepthTest, AConstantPictureWithHolesStaysAsItIs) {
    for (const Extent2D extent : kPictureExtents) {
        Image<float> depth_m(extent, 1.7f);
        for (size_t i = 0; i < extent.area(); i += 7) depth_m.pixels()[i] = 0;
        for (const auto& filtered : filter_both(depth_m)) {
            for (size_t i = 0; i < extent.area(); ++i) ASSERT_FLOAT_EQ(filtered.pixels()[i], depth_m.pixels()[i]);
        }
    }
}

TEST_F(FilterDepthTest, AStepOfSixSigmaIsPreserved) {
    Image<float> depth_m({33, 17}, 1.0f);  // sigma(1 m) = 0.01 m
    for (uint32_t y = 0; y < 17; ++y) {
        for (uint32_t x = 16; x < 33; ++x) depth_m.at(x, y) = 1.06f;
    }
    for (const auto& filtered : filter_both(depth_m)) {
        // Neighbours across the step weigh exp(-18) = 1.5e-8.
        for (size_t i = 0; i < depth_m.pixels().size(); ++i) {
            ASSERT_NEAR(filtered.pixels()[i], depth_m.pixels()[i], 5e-7f);
        }
    }
}

TEST_F(FilterDepthTest, AStepBelowTheNoiseIsSmoothed) {
    Image<float> depth_m({12, 12}, 1.0f);
    for (uint32_t y = 0; y < 12; ++y) {
        for (uint32_t x = 6; x < 12; ++x) depth_m.at(x, y) = 1.001f;
    }
    for (const auto& filtered : filter_both(depth_m)) {
        // Per side the five columns weigh 0.607 0.882 1 0.882 0.607 of 3.978: the pixel before the step takes 37.4 %
        // of it. The depth weights, exp(-0.005) at least, change that by less than 0.2 %.
        EXPECT_NEAR(filtered.at(5, 6), 1.0f + 0.374f * 0.001f, 2e-6f);
    }
}

TEST_F(FilterDepthTest, NoiseOnATiltedPlaneFallsToAThird) {
    constexpr Extent2D kExtent{128, 96};
    std::mt19937 random(5);
    for (const float distance_m : {1.0f, 3.0f}) {
        const float noise_m = 0.0012f + 0.0019f * (distance_m - 0.4f) * (distance_m - 0.4f);  // Nguyen et al. 2012
        std::normal_distribution<float> noise(0.0f, noise_m);
        const auto plane = [&](uint32_t x, uint32_t y) {
            return distance_m * (1 + 0.0005f * static_cast<float>(x) - 0.0003f * static_cast<float>(y));
        };
        Image<float> depth_m(kExtent);
        for (uint32_t y = 0; y < 96; ++y) {
            for (uint32_t x = 0; x < 128; ++x) depth_m.at(x, y) = plane(x, y) + noise(random);
        }
        for (const auto& filtered : filter_both(depth_m)) {
            double before = 0, after = 0, bias = 0;
            for (uint32_t y = 2; y < 94; ++y) {
                for (uint32_t x = 2; x < 126; ++x) {
                    before += std::pow(depth_m.at(x, y) - plane(x, y), 2);
                    after += std::pow(filtered.at(x, y) - plane(x, y), 2);
                    bias += filtered.at(x, y) - plane(x, y);
                }
            }
            EXPECT_LT(std::sqrt(after / before), 1.0 / 3) << distance_m << " m";
            EXPECT_NEAR(bias / (92 * 124), 0, 0.05 * noise_m);
        }
    }
}

TEST_F(FilterDepthTest, AgreesWithTheReference) {
    const DepthFilter wide{1.0f, 0.03f, 0.01f, 0.02f};
    for (const Extent2D extent : kPictureExtents) {
        const Image<float> depth_m = random_depth(extent, 11);
        for (const DepthFilter& settings : {DepthFilter{}, wide}) {
            const Image<float> got = filter(depth_m, settings);
            const Image<float> expected = reference::filter_depth(depth_m, settings);
            // Software devices compute exp2 to about 1e-4; it scales differences of a few centimetres.
            for (size_t i = 0; i < extent.area(); ++i) ASSERT_NEAR(got.pixels()[i], expected.pixels()[i], 2e-6f);
        }
    }
}

TEST_F(FilterDepthTest, ASigmaOfZeroIsAnError) {
    graph::FrameGraph frame = runner().begin();
    const auto id = frame.create_image("depth_m", {{4, 4}, vulkan::Format::kR32f});
    EXPECT_THAT([&] { add_filter_depth(frame, id, {0.0f}); },
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("got sigmas without use: 0 px")));
}

}  // namespace
}  // namespace patina::filter_depth_test
