// Layers as pictures: each pixel is what the reference makes of it.

#include "passes/viewer/draw_layer.h"

#include <random>

#include <glm/gtc/packing.hpp>
#include <glm/gtc/type_precision.hpp>

#include "tests/gpu/gpu_test.h"
#include "tests/reference/viewer/draw_layer.h"
#include "tools/viewer/layers.h"

namespace patina::draw_layer_test {
namespace {

using reference::LayerPixel;
using reference::LayerStyle;
using Picture = std::vector<glm::u8vec4>;

constexpr double kStep = 1.01 / 255;  // of 8 bits, and what is computed in floats of halves

std::vector<uint64_t> packed(const std::vector<glm::vec4>& values) {
    std::vector<uint64_t> halves;
    for (const glm::vec4& value : values) halves.push_back(glm::packHalf4x16(value));
    return halves;
}

/// A value as half floats hold it.
glm::dvec4 rounded(glm::vec4 value) { return glm::dvec4(glm::unpackHalf4x16(glm::packHalf4x16(value))); }

class DrawLayer : public GpuTest {
  protected:
    struct Model {
        Extent2D extent;
        std::vector<glm::vec4> position_m, normal, value;
        std::vector<uint32_t> label;
    };

    /// Surfaces with gaps, values that are not known, above 1 and below 0, and normals that are missing.
    static Model random_model(Extent2D extent) {
        std::mt19937 random(extent.width);
        std::uniform_real_distribution<float> between(-1, 1), value(-0.1f, 2);
        Model model{extent, {}, {}, {}, {}};
        for (size_t i = 0; i < extent.area(); ++i) {
            const glm::vec3 direction(between(random), between(random), between(random) - 1.5f);
            model.position_m.emplace_back(between(random), between(random), 2, random() % 5 == 0 ? 0.0f : 2.0f);
            model.normal.emplace_back(random() % 7 == 0 ? glm::vec3(0) : glm::normalize(direction), 0);
            model.value.emplace_back(value(random), value(random), value(random), random() % 6 == 0 ? 0.0f : 0.3f);
            model.label.push_back(random() % 6 == 0 ? 0u : static_cast<uint32_t>(random() % 65536));
        }
        return model;
    }

    /// Draws `value`, or labels where `labels`.
    Picture draw(const Model& model, const gpu::DrawLayerParams& params, bool labels) {
        using vulkan::Format;
        const vulkan::ImageRef picture = device().create_image({"picture", model.extent, Format::kRgba8});
        graph::FrameGraph frame = runner().begin();
        const auto halves = [&](const char* name, const std::vector<glm::vec4>& values) {
            const std::vector<uint64_t> held = packed(values);
            return frame.upload(name, {model.extent, Format::kRgba16f}, std::as_bytes(std::span(held)));
        };
        const DrawnSurface surface{
            frame.upload("position", {model.extent, Format::kRgba32f}, std::as_bytes(std::span(model.position_m))),
            halves("normal", model.normal)};
        graph::ImageId drawn;
        if (labels) {
            const graph::ImageId label =
                frame.upload("label", {model.extent, Format::kR32u}, std::as_bytes(std::span(model.label)));
            drawn = add_draw_segments(frame, surface, label, params, frame.import(picture));
        } else {
            drawn = add_draw_layer(frame, surface, halves("value", model.value), params, frame.import(picture));
        }
        const graph::Readback read = frame.read_back(drawn);
        run(std::move(frame));
        return read.as<glm::u8vec4>();
    }

    static LayerPixel pixel_of(const Model& model, size_t i) {
        return {glm::dvec4(model.position_m[i]), glm::dvec3(rounded(model.normal[i])), rounded(model.value[i])};
    }

    static void expect_near(glm::u8vec4 got, glm::dvec3 expected, size_t i) {
        EXPECT_EQ(got.a, 255) << i;
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(got[c] / 255.0, expected[c], kStep) << "pixel " << i << " channel " << c;
    }
};

TEST_F(DrawLayer, AgreesWithTheReferenceInEveryStyle) {
    const glm::dvec3 camera_m(0.1, -0.2, -0.3);
    for (const Extent2D extent : {Extent2D{1, 1}, {8, 8}, {13, 7}, {65, 33}}) {
        const Model model = random_model(extent);
        for (const tools::LayerText& text : tools::kLayers) {
            if (text.layer == tools::Layer::kSegments) continue;
            const gpu::DrawLayerParams params = tools::params_of(text.layer, camera_m, 1.5f);
            LayerStyle style;
            style.kind = params.style == gpu::kDrawNormal  ? LayerStyle::kDirection
                         : params.style == gpu::kDrawScale ? LayerStyle::kValue
                                                           : LayerStyle::kRadiance;
            style.channel = static_cast<int>(params.channel);
            style.low = params.low;
            style.high = params.high;
            style.exposure = params.exposure;
            style.shoulder = params.shoulder;
            style.camera_m = camera_m;
            style.relief = params.camera_m.w;
            const Picture got = draw(model, params, false);
            for (size_t i = 0; i < got.size() && !HasFailure(); ++i) {
                SCOPED_TRACE(text.word);
                // A direction beyond -1..1 is clipped when it is stored.
                const glm::dvec3 expected = glm::clamp(draw_layer(style, pixel_of(model, i)), 0.0, 1.0);
                expect_near(got[i], expected, i);
            }
        }
    }
}

TEST_F(DrawLayer, SegmentsAgreeWithTheReference) {
    const Model model = random_model({65, 33});
    const gpu::DrawLayerParams params = tools::params_of(tools::Layer::kSegments, glm::dvec3(0), 1);
    LayerStyle style;
    style.relief = params.camera_m.w;
    const Picture got = draw(model, params, true);
    for (size_t i = 0; i < got.size() && !HasFailure(); ++i)
        expect_near(got[i], draw_segment(style, pixel_of(model, i), model.label[i]), i);
}

TEST_F(DrawLayer, AWhiteSurfaceIsWhiteAndWhereThereIsNoneIsTheBackground) {
    Model model = random_model({4, 4});
    model.position_m.assign(16, {0, 0, 1, 1});
    model.position_m[5].w = 0;
    model.value.assign(16, {1, 1, 1, 1});
    const Picture got = draw(model, tools::params_of(tools::Layer::kKd, glm::dvec3(0), 1), false);
    EXPECT_EQ(got[0], glm::u8vec4(255));
    EXPECT_EQ(got[5], glm::u8vec4(28, 28, 31, 255));
}

TEST_F(DrawLayer, ImagesOfDifferentExtentsAreAnError) {
    graph::FrameGraph frame = runner().begin();
    const graph::ImageId large = frame.create_image("large", {{8, 8}, vulkan::Format::kRgba16f});
    const graph::ImageId small = frame.create_image("small", {{4, 4}, vulkan::Format::kRgba16f});
    EXPECT_THROW(add_draw_layer(frame, {large, large}, small, {}, large), Error);
}

}  // namespace
}  // namespace patina::draw_layer_test
