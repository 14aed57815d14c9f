// Texels find their point of the surface, pictures say what its albedo is, and the mean of what they say is kept.

#include "tests/reference/texture/bake.h"

#include <array>
#include <cmath>
#include <functional>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "passes/texture/blend_picture.h"
#include "passes/texture/finish_texels.h"
#include "passes/texture/place_texels.h"
#include "reconstruction/texture/texture_triangles.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/texture/balance.h"

namespace patina::bake_test {
namespace {

using reference::BakePicture;
using reference::PlacedTriangle;

constexpr Extent2D kPage{75, 53};   // no multiple of a tile
constexpr double kTexel_m = 0.002;  // a pixel at 0.3 m is as large

/// A page that faces a camera at the origin, `depth_m` away: its texels lie kTexel_m apart, kd rises to the right.
TextureLayout facing_page(double depth_m, glm::vec3 left, glm::vec3 right) {
    TextureLayout layout{kTexel_m, {kPage}, {}, {}};
    TexturedSurface& piece = layout.pieces.emplace_back();
    piece.reflectance.segments.resize(2);
    for (const glm::vec2 place : {glm::vec2(4, 4), glm::vec2(70, 4), glm::vec2(4, 48), glm::vec2(70, 48)}) {
        const glm::dvec2 at_m = kTexel_m * (glm::dvec2(place) - glm::dvec2(37.5, 26.5));
        piece.mesh.positions_m.emplace_back(glm::dvec3(at_m, depth_m));
        piece.mesh.normals.emplace_back(0, 0, -1);
        piece.mesh.colors.emplace_back(0.5f);
        piece.reflectance.kd.emplace_back(place.x < 40 ? left : right, 1.0f);
        piece.reflectance.labels.push_back(1);
        piece.place_px.push_back(place);
        piece.pages.push_back(0);
    }
    piece.mesh.triangles = {{0, 2, 1}, {1, 2, 3}};
    return layout;
}

std::vector<PlacedTriangle> reference_triangles(const TextureLayout& layout) {
    std::vector<PlacedTriangle> triangles;
    for (const TexturedSurface& piece : layout.pieces) {
        for (const auto& indices : piece.mesh.triangles) {
            PlacedTriangle& triangle = triangles.emplace_back();
            for (size_t i = 0; i < 3; ++i) {
                const uint32_t vertex = indices[i];
                triangle.positions_m[i] = piece.mesh.positions_m[vertex];
                triangle.normals[i] = piece.mesh.normals[vertex];
                triangle.kd[i] = glm::dvec3(piece.reflectance.kd[vertex]);
                triangle.places_px[i] = piece.place_px[vertex];
            }
        }
    }
    return triangles;
}

/// A wall across the view at `depth_m`, under a light, with a paint by pixel.
BakePicture picture_of_wall(double depth_m, glm::dvec3 light,
                            const std::function<glm::dvec3(uint32_t, uint32_t)>& paint) {
    BakePicture picture;
    picture.camera = {{160, 120}, 150, 150, 79.5, 59.5, {}};
    const Extent2D extent = picture.camera.extent;
    picture.color = picture.position_m = picture.kd = picture.rgb = picture.light = Image<glm::dvec4>(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const glm::dvec2 at((x - 79.5) / 150, (y - 59.5) / 150);
            picture.position_m.at(x, y) = {depth_m * at.x, depth_m * at.y, depth_m, depth_m};
            picture.light.at(x, y) = {light, 1};
            picture.kd.at(x, y) = {0.4, 0.4, 0.4, 1};
            picture.rgb.at(x, y) = {0.4 * light, 1};
            picture.color.at(x, y) = {light * paint(x, y), 1};
        }
    }
    return picture;
}

class BakeTest : public GpuTest {
  protected:
    /// Places a layout's only page, cut into two bands, blends pictures into it, and finishes it.
    void bake(const TextureLayout& layout, const std::vector<BakePicture>& pictures) {
        texels.clear();
        sums.clear();
        known.clear();
        words.clear();
        const TextureTriangles triangles = texture_triangles(layout);
        const Extent2D page = layout.pages.front();
        const uint32_t half = gpu::kTextureTile * 2;
        std::vector<TextureBand> bands;
        for (uint32_t row = 0; row < page.height; row += half)
            bands.emplace_back(device(), 0, row, Extent2D{page.width, std::min(half, page.height - row)});
        for (const TextureBand& band : bands) {
            place(band, triangles);
            for (const BakePicture& picture : pictures) blend(band, picture);
        }
        finish(bands, page);
    }

    std::vector<gpu::SurfaceTexel> texels;
    std::vector<glm::vec4> sums;
    std::vector<uint32_t> known, words;
    bool records_know = true;

  private:
    void place(const TextureBand& band, const TextureTriangles& triangles) {
        const TileLists lists = list_tiles(triangles, 0, band.first_row(), band.extent());
        graph::FrameGraph frame = runner().begin();
        PlaceTexelsInputs inputs;
        inputs.vertices = frame.upload("vertices", std::span(triangles.vertices));
        inputs.triangles = frame.upload("triangles", std::span(triangles.indices));
        inputs.tiles = frame.upload("tiles", std::span(lists.tiles));
        inputs.lists = frame.upload("lists", std::span(lists.lists));
        TextureBand::keep(frame, add_place_texels(frame, band, inputs));
        run(std::move(frame));
    }

    void finish(const std::vector<TextureBand>& bands, Extent2D page) {
        graph::FrameGraph frame = runner().begin();
        const glm::uvec2 count = blocks_of(page);
        graph::BufferId blocks =
            frame.fill(frame.create_buffer("blocks", uint64_t{count.x} * count.y * sizeof(gpu::TextureBlock)), 0);
        for (const TextureBand& band : bands)
            blocks = add_average_texels(frame, band, band.import(frame), blocks, page);
        const TextureBalance balance = add_balance_blocks(frame, blocks, page, kTexel_m, records_know);
        std::vector<std::array<graph::Readback, 4>> reads;
        for (const TextureBand& band : bands) {
            const TextureBandIds ids = band.import(frame);
            reads.push_back({frame.read_back(ids.texels), frame.read_back(ids.sums), frame.read_back(ids.known),
                             frame.read_back(add_finish_texels(frame, band, ids, balance, page))});
        }
        run(std::move(frame));
        for (const auto& read : reads) {
            append(texels, read[0].as<gpu::SurfaceTexel>());
            append(sums, read[1].as<glm::vec4>());
            append(known, read[2].as<uint32_t>());
            append(words, read[3].as<uint32_t>());
        }
    }

    template <class Element>
    static void append(std::vector<Element>& to, const std::vector<Element>& from) {
        to.insert(to.end(), from.begin(), from.end());
    }

    void blend(const TextureBand& band, const BakePicture& picture) {
        graph::FrameGraph frame = runner().begin();
        const auto halves = [&](const char* name, const Image<glm::dvec4>& image) {
            std::vector<uint64_t> packed;
            for (const glm::dvec4& v : image.pixels()) packed.push_back(glm::packHalf4x16(glm::vec4(v)));
            return frame.upload(name, {image.extent(), vulkan::Format::kRgba16f}, std::as_bytes(std::span(packed)));
        };
        std::vector<float> depths_m;
        for (const glm::dvec4& position : picture.position_m.pixels())
            depths_m.push_back(static_cast<float>(position.w));
        BlendPictureInputs inputs;
        inputs.color = halves("color", picture.color);
        inputs.depth_m = frame.upload("depth", {picture.position_m.extent(), vulkan::Format::kR32f},
                                      std::as_bytes(std::span(depths_m)));
        if (picture.reflects)
            inputs.reflected = {halves("kd", picture.kd), halves("rgb", picture.rgb), halves("light", picture.light)};
        inputs.camera = make_camera(picture.camera, picture.world_from_camera);
        inputs.gain = picture.gain;
        inputs.voxel_m = static_cast<float>(picture.voxel_m);
        TextureBand::keep(frame, add_blend_picture(frame, band, band.import(frame), inputs));
        run(std::move(frame));
    }
};

size_t at(uint32_t column, uint32_t row) { return size_t{row} * kPage.width + column; }

TEST_F(BakeTest, TexelsLieOnTheSurfaceAndInTheGutterAroundIt) {
    const TextureLayout layout = facing_page(0.4, glm::vec3(0.2f), glm::vec3(0.6f));
    bake(layout, {});
    const std::vector<PlacedTriangle> triangles = reference_triangles(layout);
    size_t placed = 0;
    for (uint32_t row = 0; row < kPage.height; ++row) {
        for (uint32_t column = 0; column < kPage.width; ++column) {
            const auto expected = reference::place_texel(triangles, column, row);
            const gpu::SurfaceTexel& texel = texels[at(column, row)];
            ASSERT_EQ(texel.normal != gpu::kNoSurface, expected.has_value()) << column << ", " << row;
            if (!expected) {
                EXPECT_EQ(words[at(column, row)], 0u);
                continue;
            }
            ++placed;
            const glm::vec3 position = glm::uintBitsToFloat(glm::uvec3(texel.x, texel.y, texel.z));
            EXPECT_LT(glm::distance(glm::dvec3(position), expected->position_m), 1e-5);
            EXPECT_EQ(state_of(words[at(column, row)]), 1u) << "no picture shows it";
            // Ten bits of the root: a step is 0.002 at 0.6 and less below.
            EXPECT_LT(glm::distance(unpack_albedo(words[at(column, row)]), glm::vec3(expected->kd)), 2.5e-3f);
        }
    }
    // 66 x 44 texels, and a gutter of 3 around them whose corners are round.
    EXPECT_NEAR(static_cast<double>(placed), 72 * 50, 40);
    EXPECT_EQ(texels[at(0, 0)].normal, gpu::kNoSurface);
}

TEST_F(BakeTest, APictureSharperThanTheRecordsGivesItsPaint) {
    const glm::dvec3 light(0.8, 0.7, 0.5), dark(0.1, 0.08, 0.12), bright(0.7, 0.6, 0.5);
    const auto paint = [&](uint32_t x, uint32_t) { return x / 6 % 2 == 0 ? dark : bright; };
    const glm::vec3 mean(0.5 * (dark + bright));
    const TextureLayout layout = facing_page(0.3, mean, mean);  // a pixel is a texel, a stripe six of them
    bake(layout, {picture_of_wall(0.3, light, paint)});
    size_t dark_ones = 0, bright_ones = 0;
    for (uint32_t column = 6; column < 69; ++column) {
        const glm::dvec3 kd(unpack_albedo(words[at(column, 26)]));
        ASSERT_EQ(state_of(words[at(column, 26)]), 2u);
        // The means that are balanced are over whole stripes but for the ends: a factor of 1 within 15 %.
        dark_ones += glm::distance(kd, dark) < 0.15 * glm::length(dark);
        bright_ones += glm::distance(kd, bright) < 0.15 * glm::length(bright);
    }
    EXPECT_GT(dark_ones, 20u);
    EXPECT_GT(bright_ones, 20u);
}

TEST_F(BakeTest, PicturesOfAnotherBrightnessAreBroughtToTheRecords) {
    const glm::vec3 records(0.3f, 0.4f, 0.2f);
    const TextureLayout layout = facing_page(0.3, records, records);
    bake(layout, {picture_of_wall(0.3, glm::dvec3(0.5), [](auto, auto) { return glm::dvec3(0.6, 0.5, 0.3); })});
    for (const uint32_t column : {10u, 30u, 60u}) {
        const glm::vec3 kd = unpack_albedo(words[at(column, 26)]);
        // What is added to both means leaves 1 to 2 % of the difference.
        EXPECT_LT(glm::distance(kd, records), 0.02f) << column;
    }
}

TEST_F(BakeTest, OfWhatRecordsSayPrintLeavesWhatChanceDoesNotExplain) {
    const glm::dvec3 dark(0.1), bright(0.7);
    const auto print = [&](uint32_t x, uint32_t) { return x / 3 % 2 == 0 ? dark : bright; };
    const auto plain = [&](uint32_t, uint32_t) { return 0.5 * (dark + bright); };
    const auto brighter_than_pictures = [&](double records, const auto& paint) {
        const glm::vec3 by_records(static_cast<float>(records) * 0.5f * glm::vec3(dark + bright));
        bake(facing_page(0.3, by_records, by_records), {picture_of_wall(0.3, glm::dvec3(0.5), paint)});
        double sum = 0, pictures = 0;
        for (uint32_t column = 20; column < 56; ++column) {
            const glm::vec4 seen = sums[at(column, 26)];
            sum += unpack_albedo(words[at(column, 26)]).g;
            pictures += seen.g / seen.a;
        }
        return sum / pictures;
    };
    EXPECT_NEAR(brighter_than_pictures(1.1, print), 1, 0.005) << "records hit more paper than ink";
    EXPECT_NEAR(brighter_than_pictures(1.1, plain), 1.1, 0.01);
    const double left = brighter_than_pictures(1.7, print);
    EXPECT_GT(left, 1.4);
    EXPECT_LT(left, 1.69);
}

TEST_F(BakeTest, WithoutRecordsPicturesStayAsTheyAre) {
    records_know = false;
    const glm::dvec3 paint(0.3, 0.5, 0.2);
    bake(facing_page(0.3, glm::vec3(0.8f), glm::vec3(0.8f)),
         {picture_of_wall(0.3, glm::dvec3(0.5), [&](auto, auto) { return paint; })});
    for (const uint32_t column : {10u, 30u, 60u})
        EXPECT_LT(glm::distance(unpack_albedo(words[at(column, 26)]), glm::vec3(paint)), 0.01f) << column;
}

TEST_F(BakeTest, BalancingAgreesWithTheReference) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> some(0.1, 0.9);
    const TextureLayout layout = facing_page(0.27, glm::vec3(0.2f), glm::vec3(0.6f));
    BakePicture picture = picture_of_wall(
        0.27, glm::dvec3(0.5), [&](auto x, auto) { return glm::dvec3(some(random)) * (x < 80 ? 0.6 : 1.4); });
    for (size_t i = 0; i < 900; ++i) picture.color.pixels()[static_cast<size_t>(some(random) * 160 * 120)].a = 0;
    bake(layout, {picture});
    reference::SeenPage page{kPage, kTexel_m, {}, {}, {}};
    for (size_t i = 0; i < texels.size(); ++i) {
        const bool surface = texels[i].normal != gpu::kNoSurface;
        const glm::dvec3 position(glm::uintBitsToFloat(glm::uvec3(texels[i].x, texels[i].y, texels[i].z)));
        page.position_m.push_back(surface ? std::optional(position) : std::nullopt);
        page.known.emplace_back(unpack_albedo(known[i]));
        const glm::dvec4 sum(sums[i]);
        page.seen.push_back(sum.a > 0 ? std::optional(glm::dvec3(sum) / sum.a) : std::nullopt);
    }
    const std::vector<glm::dvec3> expected = reference::balance_page(page);
    for (size_t i = 0; i < texels.size(); ++i) {
        // Ten bits of the root: a step is 0.002 at 1.
        EXPECT_LT(glm::distance(glm::dvec3(unpack_albedo(words[i])), glm::clamp(expected[i], 0.0, 1.0)), 4e-3) << i;
    }
}

/// Beside a chart that a picture shows lies one that none shows, in the same blocks but far behind.
TEST_F(BakeTest, ChartsThatShareABlockKeepTheirOwnColours) {
    TextureLayout layout = facing_page(0.3, glm::vec3(0.4f), glm::vec3(0.4f));
    TexturedSurface& piece = layout.pieces[0];
    for (const size_t corner : {1u, 3u}) {
        piece.place_px[corner].x = 36;
        piece.mesh.positions_m[corner].x = static_cast<float>(kTexel_m * (36 - 37.5));
    }
    for (const glm::vec2 place : {glm::vec2(43, 4), glm::vec2(70, 4), glm::vec2(43, 48), glm::vec2(70, 48)}) {
        piece.mesh.positions_m.emplace_back(glm::dvec3(kTexel_m * (glm::dvec2(place) - glm::dvec2(37.5, 26.5)), 0.8));
        piece.mesh.normals.emplace_back(0, 0, -1);
        piece.mesh.colors.emplace_back(0.5f);
        piece.reflectance.kd.emplace_back(0.1f, 0.1f, 0.1f, 1.0f);
        piece.reflectance.labels.push_back(1);
        piece.place_px.push_back(place);
        piece.pages.push_back(0);
    }
    piece.mesh.triangles.push_back({4, 6, 5});
    piece.mesh.triangles.push_back({5, 6, 7});
    bake(layout, {picture_of_wall(0.3, glm::dvec3(0.5), [](auto, auto) { return glm::dvec3(0.4); })});
    for (uint32_t row = 6; row < 46; ++row) {
        for (uint32_t column = 5; column < 70; ++column) {
            const uint32_t word = words[at(column, row)];
            if (column > 35 && column < 44) continue;  // the gutters
            EXPECT_EQ(state_of(word), column < 40 ? 2u : 1u) << column << ", " << row;
            EXPECT_NEAR(unpack_albedo(word).r, column < 40 ? 0.4f : 0.1f, 0.01f) << column << ", " << row;
        }
    }
}

TEST_F(BakeTest, PicturesAgreeWithTheReferenceAtEveryTexel) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> some(0.05, 0.95);
    const TextureLayout layout = facing_page(0.27, glm::vec3(0.2f), glm::vec3(0.6f));
    std::vector<BakePicture> pictures;
    for (int i = 0; i < 3; ++i) {
        BakePicture picture = picture_of_wall(
            0.27, {0.6, 0.5, 0.4}, [&](auto, auto) { return glm::dvec3(some(random), some(random), some(random)); });
        for (glm::dvec4& rgb : picture.rgb.pixels()) rgb += glm::dvec4(0.05 * some(random));  // a highlight
        for (size_t p = 0; p < 400; ++p) {
            const auto any = static_cast<size_t>(some(random) * 160 * 120);
            picture.color.pixels()[any].a = p % 2 == 0 ? 0.5 : 0.0;
            picture.position_m.pixels()[(any * 7) % (160 * 120)].w = p % 2 == 0 ? 0.2 : 0.0;  // something before it
        }
        picture.world_from_camera = glm::translate(RigidTransform(1.0), glm::dvec3(0.01 * i, -0.006 * i, 0));
        picture.gain = {1.0, 1.0 + 0.1 * i, 0.9};
        if (i == 2) picture.reflects = false;
        pictures.push_back(std::move(picture));
    }
    bake(layout, pictures);
    const std::vector<PlacedTriangle> triangles = reference_triangles(layout);
    size_t seen = 0, differing = 0;
    for (uint32_t row = 0; row < kPage.height; ++row) {
        for (uint32_t column = 0; column < kPage.width; ++column) {
            const auto texel = reference::place_texel(triangles, column, row);
            if (!texel) continue;
            glm::dvec4 sum(0);
            for (const BakePicture& picture : pictures)
                sum += reference::blend_picture(picture, texel->position_m, texel->normal);
            const glm::dvec4 got(sums[at(column, row)]);
            seen += sum.a > 0;
            // Rounding decides on which side of a pixel a few texels fall, and whether that one is clipped.
            differing += glm::length(got - sum) > 2e-3 * glm::length(sum);
        }
    }
    EXPECT_GT(seen, 2500u);
    EXPECT_LT(differing, seen / 200);
}

TEST_F(BakeTest, WhatIsHiddenTurnedAwayOrDarkIsNotSeen) {
    const auto grey = [](auto, auto) { return glm::dvec3(0.5); };
    const TextureLayout layout = facing_page(0.3, glm::vec3(0.3f), glm::vec3(0.3f));
    const auto seen_by = [&](const BakePicture& picture) {
        bake(layout, {picture});
        return state_of(words[at(37, 26)]) == 2;
    };
    EXPECT_TRUE(seen_by(picture_of_wall(0.3, glm::dvec3(0.5), grey)));
    EXPECT_FALSE(seen_by(picture_of_wall(0.2, glm::dvec3(0.5), grey))) << "something stands before it";
    EXPECT_FALSE(seen_by(picture_of_wall(0.3, glm::dvec3(0.01), grey))) << "next to no light arrives";
    BakePicture behind = picture_of_wall(0.3, glm::dvec3(0.5), grey);
    behind.world_from_camera =
        glm::rotate(glm::translate(RigidTransform(1.0), glm::dvec3(0, 0, 0.6)), M_PI, {0.0, 1.0, 0.0});
    EXPECT_FALSE(seen_by(behind)) << "its back";
    const auto shiny = [](auto, auto) { return glm::dvec3(1.8); };
    EXPECT_FALSE(seen_by(picture_of_wall(0.3, glm::dvec3(0.5), shiny))) << "brighter than any albedo";
}

TEST_F(BakeTest, APictureThatHasTheTexelInAPixelsMiddleCountsMost) {
    const TextureLayout layout = facing_page(0.3, glm::vec3(0.3f), glm::vec3(0.3f));
    BakePicture centred = picture_of_wall(0.3, glm::dvec3(0.5), [](auto, auto) { return glm::dvec3(0.2); });
    centred.world_from_camera = glm::translate(RigidTransform(1.0), glm::dvec3(kTexel_m / 2, kTexel_m / 2, 0));
    const BakePicture between = picture_of_wall(0.3, glm::dvec3(0.5), [](auto, auto) { return glm::dvec3(0.8); });
    bake(layout, {centred, between});
    // The other has the texel amid four pixels: its weight is the least, and all else is nearly alike.
    const glm::vec4 sum = sums[at(37, 26)];
    EXPECT_NEAR(sum.r / sum.a, (0.2 + 0.05 * 0.8) / 1.05, 1e-3);
}

TEST_F(BakeTest, ANearPictureCountsForMuchMoreThanAFarOne) {
    const TextureLayout layout = facing_page(0.3, glm::vec3(0.3f), glm::vec3(0.3f));
    const BakePicture near = picture_of_wall(0.3, glm::dvec3(0.5), [](auto, auto) { return glm::dvec3(0.2); });
    BakePicture far = picture_of_wall(0.6, glm::dvec3(0.5), [](auto, auto) { return glm::dvec3(0.8); });
    far.world_from_camera = glm::translate(RigidTransform(1.0), glm::dvec3(0, 0, -0.3));
    bake(layout, {near, far});
    // Weights are as 1 to 2^-4, all else is alike.
    const glm::vec4 sum = sums[at(37, 26)];
    EXPECT_NEAR(sum.r / sum.a, 0.2 + 0.6 / 17, 1e-3);
}

}  // namespace
}  // namespace patina::bake_test
