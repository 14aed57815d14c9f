// A painted wall whose voxels know only the mean of the paint: its fused colours bring back the paint.

#include "passes/shading/restore_detail.h"

#include <random>

#include <glm/gtc/packing.hpp>

#include "shared/shading/predict_radiance.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/shading/restore_detail.h"

namespace patina::restore_detail_test {
namespace {

using reference::DetailView;

constexpr double kDepthM = 2, kFocalPx = 400, kVoxelM = 0.02;
constexpr Extent2D kExtent{61, 47};
const glm::dvec3 kDark(0.1, 0.08, 0.12), kBright(0.7, 0.6, 0.5);

/// Stripes two pixels wide.
glm::dvec3 paint(uint32_t x) { return x / 2 % 2 == 0 ? kDark : kBright; }

/// A wall that faces the camera, evenly lit; kd is the mean paint.
DetailView striped_wall(Extent2D extent) {
    DetailView view;
    view.focal_px = kFocalPx;
    view.voxel_m = kVoxelM;
    const glm::dvec3 light(0.8, 0.7, 0.5), kd = 0.5 * (kDark + kBright);
    view.position_m = view.color = view.rgb = Image<glm::dvec4>(extent);
    view.normal = Image<glm::dvec4>(extent, {0, 0, -1, 0});
    view.light = Image<glm::dvec4>(extent, {light, 1});
    view.kd = view.picture_kd = Image<glm::dvec4>(extent, {kd, 1});
    view.ks_alpha = Image<glm::dvec4>(extent, {0, 0, 0, 0});
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            view.position_m.at(x, y) = {kDepthM * x / kFocalPx, kDepthM * y / kFocalPx, kDepthM, kDepthM};
            view.color.at(x, y) = {light * paint(x), 1};
            view.rgb.at(x, y) = {light * kd, 1};
        }
    }
    return view;
}

class RestoreDetail : public GpuTest {
  protected:
    struct Result {
        Image<glm::vec4> kd, rgb;
    };

    Result restore(const DetailView& view) {
        graph::FrameGraph frame = runner().begin();
        const auto halves = [&](const char* name, const Image<glm::dvec4>& image) {
            std::vector<uint64_t> words;
            for (const glm::dvec4& v : image.pixels()) words.push_back(glm::packHalf4x16(glm::vec4(v)));
            return frame.upload(name, {image.extent(), vulkan::Format::kRgba16f}, std::as_bytes(std::span(words)));
        };
        std::vector<glm::vec4> positions(view.position_m.pixels().begin(), view.position_m.pixels().end());
        const graph::ImageId position = frame.upload("position", {view.position_m.extent(), vulkan::Format::kRgba32f},
                                                     std::as_bytes(std::span(positions)));
        PredictedImages predicted;
        predicted.kd = halves("kd", view.kd);
        predicted.picture_kd = halves("picture_kd", view.picture_kd);
        predicted.rgb = halves("rgb", view.rgb);
        predicted.light = halves("light", view.light);
        predicted.ks_alpha = halves("ks_alpha", view.ks_alpha);
        const PredictedImages detailed =
            add_restore_detail(frame, predicted,
                               {position, halves("normal", view.normal), halves("color", view.color),
                                static_cast<float>(view.focal_px), static_cast<float>(view.voxel_m)});
        const graph::Readback kd = frame.read_back(detailed.kd), rgb = frame.read_back(detailed.rgb);
        run(std::move(frame));
        return {unpacked(kd), unpacked(rgb)};
    }

  private:
    static Image<glm::vec4> unpacked(const graph::Readback& read) {
        const Image<uint64_t> words = read.image<uint64_t>();
        Image<glm::vec4> image(words.extent());
        for (size_t i = 0; i < image.pixels().size(); ++i) image.pixels()[i] = glm::unpackHalf4x16(words.pixels()[i]);
        return image;
    }
};

template <class Color>
double off(glm::vec4 got, Color expected) {
    const glm::dvec3 d = glm::abs(glm::dvec3(got) - glm::dvec3(expected));
    return std::max({d.x, d.y, d.z});
}

TEST_F(RestoreDetail, PaintFinerThanAVoxelComesBack) {
    const DetailView view = striped_wall(kExtent);
    const Result got = restore(view);
    for (uint32_t y = 8; y + 8 < kExtent.height; ++y) {
        for (uint32_t x = 8; x + 8 < kExtent.width; ++x) {
            // A window of a few stripes may hold more of one than of the other.
            ASSERT_LT(off(got.kd.at(x, y), paint(x)), 0.12) << x << ' ' << y;
            ASSERT_LT(off(got.rgb.at(x, y), glm::dvec3(view.light.at(x, y)) * paint(x)), 0.1) << x << ' ' << y;
        }
    }
}

TEST_F(RestoreDetail, PicturesKeepTheAlbedoThatTheyAreMadeWith) {
    DetailView view =
        striped_wall(kExtent);  // kd is right; less light arrives than is known, so that pictures have less
    for (uint32_t y = 0; y < kExtent.height; ++y) {
        for (uint32_t x = 0; x < kExtent.width; ++x) {
            for (Image<glm::dvec4>* of_half : {&view.picture_kd, &view.rgb, &view.color}) {
                glm::dvec4& v = of_half->at(x, y);
                v = {0.5 * glm::dvec3(v), 1};
            }
        }
    }
    const Result got = restore(view);
    for (uint32_t x = 8; x + 8 < kExtent.width; ++x) {
        EXPECT_LT(off(got.kd.at(x, 20), paint(x)), 0.12) << x;
        EXPECT_LT(off(got.rgb.at(x, 20), glm::dvec3(view.color.at(x, 20))), 0.05) << x;
    }
}

TEST_F(RestoreDetail, AShadowsBorderIsNotTakenForPaint) {
    DetailView view = striped_wall(kExtent);
    for (uint32_t y = 0; y < kExtent.height; ++y) {
        for (uint32_t x = 0; x < kExtent.width; ++x) {
            const double arrives = x < 30 ? 1 : 0.5;
            view.light.at(x, y).a = arrives;
            view.color.at(x, y) = {glm::dvec3(view.light.at(x, y)) * glm::dvec3(0.4) * arrives, 1};
        }
    }
    const Result got = restore(view);
    for (uint32_t x = 28; x < 32; ++x) EXPECT_LT(off(got.kd.at(x, 20), view.kd.at(x, 20)), 1e-3) << x;
}

TEST_F(RestoreDetail, WhatIsNotKnownYetTakesItsColourOverTheLight) {
    DetailView view = striped_wall(kExtent);
    view.kd = view.picture_kd = view.rgb = Image<glm::dvec4>(kExtent, {0, 0, 0, 0});
    const Result got = restore(view);
    EXPECT_LT(off(got.kd.at(20, 20), paint(20)), 2e-3);
    EXPECT_EQ(got.kd.at(20, 20).a, 1.0f);
    view.color.at(20, 20).a = 0;
    EXPECT_EQ(restore(view).kd.at(20, 20), glm::vec4(0));
}

TEST_F(RestoreDetail, WhereNoLightWasMarchedTheFusedColourIsSeen) {
    DetailView view = striped_wall(kExtent);
    for (uint32_t y = 0; y < kExtent.height; ++y) {
        for (uint32_t x = 0; x < kExtent.width; ++x) {
            view.rgb.at(x, y) = glm::dvec4(glm::dvec3(view.light.at(x, y)) * glm::dvec3(view.kd.at(x, y)), 1);
            if (x < 30) view.light.at(x, y).a = gpu::kNotMarched;
        }
    }
    const Result got = restore(view);
    for (uint32_t x = 8; x < 30; ++x) {
        EXPECT_LT(off(got.rgb.at(x, 20), glm::dvec3(view.color.at(x, 20))), 1e-3) << x;
        EXPECT_LT(off(got.kd.at(x, 20), view.kd.at(x, 20)), 1e-3) << "kd is known: " << x;
    }
    EXPECT_GT(off(got.kd.at(31, 20), view.kd.at(31, 20)), 0.01) << "of what is lit around there is detail";
}

TEST_F(RestoreDetail, AgreesWithTheReference) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(0, 1);
    for (const Extent2D extent : {Extent2D{1, 1}, {8, 8}, {13, 7}, {65, 33}}) {
        DetailView view = striped_wall(extent);
        view.focal_px = 365;  // no step between taps is half a pixel
        for (size_t i = 0; i < extent.area(); ++i) {
            const auto varied = [&](double low, double high) {
                return glm::dvec3(low) + (high - low) * glm::dvec3(any(random), any(random), any(random));
            };
            view.position_m.pixels()[i].z += 0.02 * any(random);
            view.color.pixels()[i] = {varied(0, 0.6), any(random) < 0.9 ? 1 : 0};
            view.light.pixels()[i] = {varied(0, 1), any(random) < 0.1 ? -1 : 0.9 + 0.1 * any(random)};
            view.kd.pixels()[i] = any(random) < 0.9 ? glm::dvec4(varied(0.1, 0.7), 1) : glm::dvec4(0);
            view.picture_kd.pixels()[i] = view.kd.pixels()[i] * glm::dvec4(varied(0.5, 1.5), 1);
            view.rgb.pixels()[i] = {varied(0.5, 1), view.kd.pixels()[i].a};
            view.ks_alpha.pixels()[i] = {varied(0, 0.1), 0.2};
            if (any(random) < 0.05) view.position_m.pixels()[i] = glm::dvec4(0);
        }
        for (Image<glm::dvec4>* image : {&view.kd, &view.picture_kd}) {
            for (glm::dvec4& v : image->pixels()) {
                v = glm::dvec4(glm::unpackF3x9_E1x5(glm::packF3x9_E1x5(glm::vec3(v))), v.a);
            }
        }
        for (Image<glm::dvec4>* image : {&view.color, &view.light, &view.rgb, &view.ks_alpha}) {
            for (glm::dvec4& v : image->pixels()) v = glm::unpackHalf4x16(glm::packHalf4x16(glm::vec4(v)));
        }
        const Result got = restore(view);
        const reference::Detailed expected = reference::restore_detail(view);
        for (size_t i = 0; i < extent.area(); ++i) {
            ASSERT_LT(off(got.kd.pixels()[i], expected.kd.pixels()[i]), 2e-3) << extent << ' ' << i;
            ASSERT_LT(off(got.rgb.pixels()[i], expected.rgb.pixels()[i]), 2e-3) << extent << ' ' << i;
            ASSERT_EQ(got.kd.pixels()[i].a, expected.kd.pixels()[i].a);
        }
    }
}

}  // namespace
}  // namespace patina::restore_detail_test
