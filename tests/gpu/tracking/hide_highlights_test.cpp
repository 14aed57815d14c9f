#include "passes/tracking/hide_highlights.h"

#include <algorithm>
#include <random>

#include <glm/gtc/packing.hpp>

#include "tests/gpu/input/input_pictures.h"
#include "tests/gpu/tracking/track_rig.h"

namespace patina::hide_highlights_test {
namespace {

struct Pictures {
    Image<glm::vec4> color, kd, light, rgb;
};

class HideHighlightsTest : public TrackTest {
  protected:
    Image<glm::vec4> hide(const Pictures& pictures, float most_share) {
        graph::FrameGraph frame = runner().begin();
        const HighlightInputs inputs{upload_halves(frame, pictures.color), upload_halves(frame, pictures.kd),
                                     upload_halves(frame, pictures.light), upload_halves(frame, pictures.rgb)};
        const graph::Readback read = frame.read_back(add_hide_highlights(frame, inputs, most_share));
        run(std::move(frame));
        const Image<uint64_t> halves = read.image<uint64_t>();
        Image<glm::vec4> matte(halves.extent());
        std::transform(halves.pixels().begin(), halves.pixels().end(), matte.pixels().begin(),
                       [](uint64_t half) { return glm::unpackHalf4x16(half); });
        return matte;
    }
};

TEST_F(HideHighlightsTest, WhatIsMoreThanDiffuseIsLeftOut) {
    const glm::vec4 color(0.5, 0.25, 0.125, 1);
    const Extent2D extent{4, 1};
    Pictures pictures{Image<glm::vec4>(extent, color), Image<glm::vec4>(extent, glm::vec4(0.5, 0.5, 0.5, 1)),
                      Image<glm::vec4>(extent, glm::vec4(1)), Image<glm::vec4>(extent, glm::vec4(0.5, 0.5, 0.5, 1))};
    pictures.rgb.at(1, 0) = glm::vec4(0.56, 0.56, 0.56, 1);  // 11 % specular
    pictures.rgb.at(2, 0) = glm::vec4(0.7, 0.7, 0.7, 1);     // 29 %
    pictures.rgb.at(3, 0) = glm::vec4(0.7, 0.7, 0.7, 1);
    pictures.kd.at(3, 0) = glm::vec4(0);  // not known
    const Image<glm::vec4> matte = hide(pictures, 0.15f);
    EXPECT_EQ(matte.at(0, 0), color);
    EXPECT_EQ(matte.at(1, 0), color);
    EXPECT_EQ(matte.at(2, 0), glm::vec4(0));
    EXPECT_EQ(matte.at(3, 0), color);
}

TEST_F(HideHighlightsTest, AgreesWithTheReference) {
    for (const Extent2D extent : kPictureExtents) {
        std::mt19937 random(5);
        std::uniform_real_distribution<float> value(0.05f, 1);
        Pictures pictures{Image<glm::vec4>(extent), Image<glm::vec4>(extent), Image<glm::vec4>(extent),
                          Image<glm::vec4>(extent)};
        for (auto* image : {&pictures.color, &pictures.kd, &pictures.light, &pictures.rgb}) {
            for (glm::vec4& pixel : image->pixels())
                pixel = glm::vec4(value(random), value(random), value(random), random() % 4 == 0 ? 0 : 1);
            *image = rounded_to_halves(*image);
        }
        const Image<glm::vec4> matte = hide(pictures, 0.3f);
        size_t hidden = 0;
        for (size_t i = 0; i < extent.area(); ++i) {
            const glm::dvec3 weights(0.2126, 0.7152, 0.0722), rgb(pictures.rgb.pixels()[i]);
            const glm::dvec3 kd(pictures.kd.pixels()[i]), light(pictures.light.pixels()[i]);
            const double all = glm::dot(weights, rgb), share = 1 - glm::dot(weights, kd * light) / all;
            if (std::abs(share - 0.3) < 1e-4) continue;  // single precision may fall on either side
            const bool highlight = pictures.kd.pixels()[i].a > 0 && share > 0.3;
            ASSERT_EQ(matte.pixels()[i], highlight ? glm::vec4(0) : pictures.color.pixels()[i]) << i;
            hidden += highlight ? 1 : 0;
        }
        if (extent.area() > 100) {
            EXPECT_GT(hidden, extent.area() / 10);
        }
    }
}

}  // namespace
}  // namespace patina::hide_highlights_test
