// Views show the albedo, and the colours, that pictures tell of their surface.

#include "passes/texture/show_texels.h"

#include <array>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "passes/texture/blend_diffuse.h"
#include "passes/texture/cast_depth.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/texture/balance.h"
#include "tests/reference/texture/view.h"

namespace patina::show_texels_test {
namespace {

using reference::BakePicture;
using reference::ViewPixel;

constexpr Extent2D kExtent{72, 53};
const Intrinsics kCamera{kExtent, 70, 70, 35.5, 26, {}};
constexpr double kWall_m = 0.3, kPixel_m = kWall_m / 70;
constexpr glm::vec3 kRecords(0.4f, 0.3f, 0.5f), kLight(0.6f, 0.5f, 0.4f), kGloss(0.05f);

using Pixels = Image<glm::dvec4>;

Pixels filled_with(Extent2D extent, glm::vec3 rgb, double alpha = 1) {
    Pixels image(extent);
    for (glm::dvec4& pixel : image.pixels()) pixel = glm::dvec4(rgb, alpha);
    return image;
}

/// What a camera at `x_m` beside the origin sees of a wall across the view.
Pixels wall_from(const Intrinsics& camera, double x_m) {
    Pixels positions_m(camera.extent);
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            const double u = (x - camera.cx) / camera.fx, v = (y - camera.cy) / camera.fy;
            positions_m.at(x, y) = {kWall_m * u + x_m, kWall_m * v, kWall_m, kWall_m};
        }
    }
    return positions_m;
}

/// A picture of that wall, painted at random, twice as fine as the view; the model reflects as records have it.
BakePicture picture_from(double x_m, std::mt19937& random) {
    std::uniform_real_distribution<double> some(0.1, 0.9);
    BakePicture picture;
    picture.camera = {{150, 110}, 140, 140, 74.5, 54.5, {}};
    picture.world_from_camera = glm::translate(RigidTransform(1.0), glm::dvec3(x_m, 0, 0));
    const Extent2D extent = picture.camera.extent;
    picture.position_m = wall_from(picture.camera, x_m);
    picture.light = filled_with(extent, kLight);
    picture.kd = filled_with(extent, kRecords);
    picture.rgb = filled_with(extent, kRecords * kLight + kGloss);
    picture.color = filled_with(extent, glm::vec3(0));
    for (glm::dvec4& pixel : picture.color.pixels()) {
        const glm::dvec3 paint(some(random), some(random), some(random));
        pixel = glm::dvec4(paint * glm::dvec3(kLight) + glm::dvec3(kGloss), 1);
    }
    return picture;
}

class ShowTexels : public GpuTest {
  protected:
    struct Shown {
        Image<glm::dvec4> kd, rgb;
    };

    graph::ImageId upload(graph::FrameGraph& frame, const char* name, const Pixels& image) {
        std::vector<uint64_t> packed;
        for (const glm::dvec4& v : image.pixels()) packed.push_back(glm::packHalf4x16(glm::vec4(v)));
        return frame.upload(name, {image.extent(), vulkan::Format::kRgba16f}, std::as_bytes(std::span(packed)));
    }

    graph::ImageId upload_positions(graph::FrameGraph& frame, const Pixels& image) {
        std::vector<glm::vec4> exact(image.pixels().begin(), image.pixels().end());
        return frame.upload("positions", {image.extent(), vulkan::Format::kRgba32f}, std::as_bytes(std::span(exact)));
    }

    static Pixels widened(const graph::Readback& read) {
        const Image<uint64_t> halves = read.image<uint64_t>();
        Pixels wide(halves.extent());
        for (size_t i = 0; i < halves.pixels().size(); ++i)
            wide.pixels()[i] = glm::dvec4(glm::unpackHalf4x16(halves.pixels()[i]));
        return wide;
    }

    DiffusePicture take_apart(graph::FrameGraph& frame, const BakePicture& picture) {
        BlendPictureInputs inputs;
        inputs.color = upload(frame, "color", picture.color);
        inputs.depth_m = add_cast_depth(frame, upload_positions(frame, picture.position_m));
        inputs.reflected = {upload(frame, "kd", picture.kd), upload(frame, "rgb", picture.rgb),
                            upload(frame, "light", picture.light)};
        inputs.gain = picture.gain;
        inputs.voxel_m = static_cast<float>(picture.voxel_m);
        const auto target = [&](const char* name) {
            return frame.create_image(name, {picture.camera.extent, vulkan::Format::kRgba16f});
        };
        return add_diffuse_picture(frame, inputs, {target("diffuse"), target("light of the picture")});
    }

    /// Shows the pictures in the view; `taken`: what add_diffuse_picture made of them.
    Shown show(const std::vector<BakePicture>& pictures) {
        graph::FrameGraph frame = runner().begin();
        ShowTexelsInputs view;
        view.kd = upload(frame, "kd", filled_with(kExtent, kRecords));
        view.picture_kd = upload(frame, "picture kd", filled_with(kExtent, kRecords));
        view.light = upload(frame, "light", filled_with(kExtent, kLight));
        view.rgb = upload(frame, "rgb", filled_with(kExtent, kRecords * kLight + kGloss));
        view.kd_elsewhere = upload(frame, "kd elsewhere", filled_with(kExtent, glm::vec3(0.125f)));
        view.rgb_elsewhere = upload(frame, "rgb elsewhere", filled_with(kExtent, glm::vec3(0.25f)));
        view.pixel_m = kPixel_m;
        view.other_light = other_light;
        const TextureBand page(device(), 0, 0, kExtent);
        ViewTexelIds texels = add_place_view(frame, page, upload_positions(frame, view_m),
                                             upload(frame, "normal", filled_with(kExtent, {0, 0, -1}, 0)), view.kd);
        std::vector<std::array<graph::Readback, 2>> reads;
        for (const BakePicture& picture : pictures) {
            BlendDiffuseInputs inputs;
            inputs.picture = take_apart(frame, picture);
            reads.push_back({frame.read_back(inputs.picture.diffuse), frame.read_back(inputs.picture.light)});
            inputs.depth_m = add_cast_depth(frame, upload_positions(frame, picture.position_m));
            inputs.camera = make_camera(picture.camera, picture.world_from_camera);
            inputs.voxel_m = static_cast<float>(picture.voxel_m);
            texels = add_blend_diffuse(frame, page, texels, inputs);
        }
        const ShownTexels shown = add_show_texels(frame, page, texels, view);
        const graph::Readback kd = frame.read_back(shown.kd), rgb = frame.read_back(shown.rgb);
        run(std::move(frame));
        taken.clear();
        for (const auto& [diffuse, light] : reads) taken.push_back({widened(diffuse), widened(light)});
        return {widened(kd), widened(rgb)};
    }

    std::vector<ViewPixel> expected_view(const std::vector<BakePicture>& pictures) const {
        std::vector<ViewPixel> view;
        for (const glm::dvec4& position : view_m.pixels()) {
            ViewPixel& pixel = view.emplace_back();
            pixel.surface = position.w > 0;
            pixel.position_m = glm::dvec3(position);
            pixel.normal = {0, 0, -1};
            if (!pixel.surface) continue;
            for (size_t i = 0; i < pictures.size(); ++i) {
                const auto said =
                    reference::blend_diffuse(pictures[i], taken[i], pixel.position_m, pixel.normal, glm::dvec3(0));
                pixel.said.told += said.told;
                pixel.said.shown += said.shown;
            }
        }
        return view;
    }

    Pixels view_m = wall_from(kCamera, 0);
    bool other_light = false;
    std::vector<reference::DiffusePicture> taken;
};

/// Pictures that are clipped, dark, hidden or too bright here and there; the view has holes.
std::vector<BakePicture> awkward_pictures(std::mt19937& random) {
    std::vector<BakePicture> pictures;
    for (const double x_m : {-0.02, 0.005, 0.1}) {
        BakePicture picture = picture_from(x_m, random);
        const size_t pixels = picture.color.pixels().size();
        for (size_t i = 0; i < 1500; ++i) {
            const size_t chosen = random() % pixels;
            glm::dvec4& color = picture.color.pixels()[chosen];
            color.a = i % 3 == 0 ? 0 : 0.5;
            if (i % 4 == 1) {  // clipped, and known to be brighter
                color.g = 1;
                picture.rgb.pixels()[chosen] = {0.3, 1.6, 0.3, 1};
            }
            if (i % 30 == 0)
                picture.position_m.pixels()[random() % pixels].w = i % 60 == 0 ? 0 : 0.2;  // edges around it
            picture.light.pixels()[random() % pixels] = {0.01, 0.5, 0.5, 1};
            picture.rgb.pixels()[random() % pixels] = {0.9, 0.9, 0.9, 1};  // a highlight that the picture lacks
        }
        picture.gain = {1.0, 1.1, 0.9};
        pictures.push_back(std::move(picture));
    }
    return pictures;
}

TEST_F(ShowTexels, AgreesWithTheReference) {
    std::mt19937 random(11);
    const std::vector<BakePicture> pictures = awkward_pictures(random);
    for (size_t i = 0; i < 200; ++i) view_m.pixels()[random() % view_m.pixels().size()].w = 0;
    const Shown shown = show(pictures);

    for (size_t i = 0; i < pictures.size(); ++i) {
        const reference::DiffusePicture expected = reference::diffuse_picture(pictures[i]);
        const size_t pixels = expected.diffuse.pixels().size();
        size_t differing = 0;
        for (size_t p = 0; p < pixels; ++p) {
            const glm::dvec4 exact = expected.diffuse.pixels()[p], arrives = expected.light.pixels()[p];
            differing += glm::length(taken[i].diffuse.pixels()[p] - exact) > 4e-3 * (1 + glm::length(exact));
            differing += glm::distance(glm::dvec3(taken[i].light.pixels()[p]), glm::dvec3(arrives)) > 2e-3;
        }
        EXPECT_LT(differing, pixels / 500) << "of picture " << i;
    }

    const std::vector<ViewPixel> view = expected_view(pictures);
    const std::vector<glm::dvec4> all = reference::means_of(view, kExtent, false);
    reference::SeenPage page{kExtent, kPixel_m, {}, {}, {}};
    for (const ViewPixel& pixel : view) {
        page.position_m.push_back(pixel.surface ? std::optional(pixel.position_m) : std::nullopt);
        page.known.emplace_back(kRecords);
        const glm::dvec4 told = pixel.said.told;
        page.seen.push_back(told.a > 0 ? std::optional(glm::dvec3(told) / told.a) : std::nullopt);
    }
    const std::vector<glm::dvec3> balanced = reference::balance_page(page);
    size_t compared = 0, filled = 0, differing = 0;
    for (size_t i = 0; i < view.size(); ++i) {
        const glm::dvec3 rgb(shown.rgb.pixels()[i]), kd(shown.kd.pixels()[i]);
        const glm::dvec3 expected =
            all[i].a > 0 ? glm::max(glm::dvec3(all[i]) + glm::dvec3(kGloss), 0.0) : glm::dvec3(0.25);
        differing += glm::length(rgb - expected) > 5e-3;
        filled += all[i].a > 0 && view[i].said.shown.a == 0;
        differing += !view[i].surface && kd != glm::dvec3(0.125);
        if (view[i].said.told.a == 0) continue;
        ++compared;
        differing += glm::length(kd - glm::clamp(balanced[i], 0.0, 1.0)) > 8e-3;
    }
    EXPECT_GT(compared, 1500u);
    EXPECT_GT(filled, 20u) << "none of their own";
    EXPECT_LT(differing, view.size() / 100);
}

TEST_F(ShowTexels, LightThatIsWrongCancelsOutInColoursButNotInAlbedo) {
    std::mt19937 random(3);
    BakePicture picture = picture_from(0, random);
    picture.color = filled_with(picture.camera.extent, {0.3f, 0.2f, 0.1f});
    const Shown shown = show({picture});
    const glm::dvec4 rgb = shown.rgb.at(36, 26), kd = shown.kd.at(36, 26);
    EXPECT_LT(glm::distance(glm::dvec3(rgb), glm::dvec3(0.3, 0.2, 0.1)), 3e-3);
    EXPECT_LT(glm::distance(glm::dvec3(kd), glm::dvec3(kRecords)), 0.04)
        << "what records know, but for what is added to both means";
}

TEST_F(ShowTexels, WhatIsClippedOrTooBrightIsShownAndTellsNoAlbedo) {
    std::mt19937 random(3);
    BakePicture picture = picture_from(0, random);
    picture.color = filled_with(picture.camera.extent, glm::vec3(1), 0.5);
    const Shown shown = show({picture});
    EXPECT_LT(glm::distance(glm::dvec3(shown.rgb.at(36, 26)), glm::dvec3(1)), 3e-3);
    EXPECT_EQ(shown.kd.at(36, 26).r, 0.125);
}

TEST_F(ShowTexels, PicturesFromWhereTheEyeIsCountMost) {
    std::mt19937 random(3);
    BakePicture here = picture_from(0.002, random), away = picture_from(0.06, random);
    here.color = filled_with(here.camera.extent, glm::vec3(0.1f));
    away.color = filled_with(away.camera.extent, glm::vec3(0.5f));
    EXPECT_LT(show({here, away}).rgb.at(36, 26).r, 0.11);
}

TEST_F(ShowTexels, UnderOtherLightItIsTheAlbedoInThat) {
    other_light = true;
    std::mt19937 random(3);
    BakePicture picture = picture_from(0, random);
    picture.color = filled_with(picture.camera.extent, {0.3f, 0.2f, 0.1f});
    const Shown shown = show({picture});
    const glm::dvec3 kd(shown.kd.at(36, 26)), expected = kd * glm::dvec3(kLight) + glm::dvec3(kGloss);
    EXPECT_LT(glm::distance(glm::dvec3(shown.rgb.at(36, 26)), expected), 3e-3);
}

}  // namespace
}  // namespace patina::show_texels_test
