#include "tests/reference/tracking/keyframes.h"

#include <bit>
#include <cmath>
#include <random>

#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>

#include "passes/tracking/encode_frame.h"
#include "passes/tracking/keep_keyframe.h"
#include "passes/tracking/match_keyframes.h"
#include "patina/camera.h"
#include "tests/gpu/gpu_test.h"

namespace patina::keyframes_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

using Code = std::vector<uint32_t>;

constexpr uint32_t kHasBoth = gpu::kFernHasColor | gpu::kFernHasDepth;

/// A code in which every fern's tests are as in `bits`.
Code code_of_all(uint32_t bits) { return Code(gpu::kFernWords, bits * 0x01010101u); }

/// The code with its first `ferns` ferns' codes changed in `bits`.
Code changed(Code code, uint32_t ferns, uint32_t bits) {
    for (uint32_t i = 0; i < ferns; ++i) code[i / 4] ^= bits << (8 * (i % 4));
    return code;
}

/// A code as the reference takes it.
std::vector<reference::FernCode> readable(const Code& code) {
    std::vector<reference::FernCode> ferns(gpu::kFerns);
    for (uint32_t i = 0; i < gpu::kFerns; ++i) {
        const uint32_t bits = code[i / 4] >> (8 * (i % 4)) & 255;
        if ((bits & gpu::kFernHasColor) != 0) {
            ferns[i].color = {(bits & gpu::kFernRed) != 0, (bits & gpu::kFernGreen) != 0, (bits & gpu::kFernBlue) != 0};
        }
        if ((bits & gpu::kFernHasDepth) != 0) ferns[i].depth = (bits & gpu::kFernDepth) != 0;
    }
    return ferns;
}

/// Depth and colour that change over the picture, with holes in both.
struct Pictures {
    Image<float> depth_m;
    Image<glm::vec4> color;
};

Pictures wavy_pictures(Extent2D depth_px, Extent2D color_px) {
    Pictures pictures{Image<float>(depth_px), Image<glm::vec4>(color_px)};
    for (uint32_t y = 0; y < depth_px.height; ++y) {
        for (uint32_t x = 0; x < depth_px.width; ++x) {
            const double u = (x + 0.5) / depth_px.width, v = (y + 0.5) / depth_px.height;
            const bool hole = u > 0.6 && v < 0.5;
            pictures.depth_m.at(x, y) = hole ? 0 : static_cast<float>(2.2 + std::sin(5 * u) + 0.7 * std::cos(6 * v));
        }
    }
    for (uint32_t y = 0; y < color_px.height; ++y) {
        for (uint32_t x = 0; x < color_px.width; ++x) {
            const double u = (x + 0.5) / color_px.width, v = (y + 0.5) / color_px.height;
            const float alpha = u < 0.3 && v > 0.6 ? 0.0f : (u > 0.8 ? 0.5f : 1.0f);
            pictures.color.at(x, y) = {u, 0.4 + 0.3 * std::sin(7 * v), u * v, alpha};
            if (alpha == 0) pictures.color.at(x, y) = glm::vec4(0);
        }
    }
    return pictures;
}

class Keyframes : public GpuTest {
  protected:
    Image<glm::vec4> shrink(const Pictures& pictures) {
        graph::FrameGraph frame = runner().begin();
        const graph::Readback read = frame.read_back(add_shrunk(frame, pictures));
        run(std::move(frame));
        return read.image<glm::vec4>();
    }

    Code encode(const Pictures& pictures, const std::vector<gpu::Fern>& ferns) {
        graph::FrameGraph frame = runner().begin();
        const graph::ImageId small = add_shrunk(frame, pictures);
        const auto id = frame.upload<gpu::Fern>("ferns", std::span(ferns));
        const graph::Readback read = frame.read_back(add_encode_frame(frame, small, id));
        run(std::move(frame));
        return read.as<uint32_t>();
    }

    KeyframeStore made_store(const KeyframeStoreSettings& settings = {}) {
        KeyframeStore store(device(), settings);
        graph::FrameGraph frame = runner().begin();
        store.reset(frame);
        run(std::move(frame));
        return store;
    }

    /// Offers a frame with this code, at a pose whose x is its number in millimetres; returns the store's counters.
    gpu::KeyframeCounters offer(const KeyframeStore& store, const Code& code, uint32_t number, bool tracked = true,
                                const RigidTransform& world_from_camera = RigidTransform(1), float spacing_m = 1e-3f) {
        graph::FrameGraph frame = runner().begin();
        KeyframeStoreIds ids = store.import(frame);
        const auto code_id = frame.upload<uint32_t>("code", std::span(code));
        gpu::KeyframeCandidate candidate{glm::mat4(1), number, tracked ? 1u : 0u, 0, 0};
        candidate.world_from_camera = glm::mat4(world_from_camera);
        candidate.world_from_camera[3].x += spacing_m * static_cast<float>(number);
        const auto candidate_id = frame.upload<gpu::KeyframeCandidate>("candidate", std::span(&candidate, 1));
        const KeyframeMatches matches = add_match_keyframes(frame, store, ids, code_id, 1);
        add_keep_keyframe(frame, store, ids, code_id, matches, candidate_id);
        KeyframeStore::keep(frame, ids);
        const graph::Readback read = frame.read_back(ids.counters);
        run(std::move(frame));
        return read.as<gpu::KeyframeCounters>().front();
    }

    std::vector<gpu::KeyframeMatch> match(const KeyframeStore& store, const Code& code, uint32_t count,
                                          KeyframeTests tests = KeyframeTests::kAll) {
        graph::FrameGraph frame = runner().begin();
        const KeyframeStoreIds ids = store.import(frame);
        const auto code_id = frame.upload<uint32_t>("code", std::span(code));
        const graph::Readback read =
            frame.read_back(add_match_keyframes(frame, store, ids, code_id, count, tests).matches);
        run(std::move(frame));
        return read.as<gpu::KeyframeMatch>();
    }

  private:
    static graph::ImageId add_shrunk(graph::FrameGraph& frame, const Pictures& pictures) {
        std::vector<uint64_t> halves;
        for (const glm::vec4& pixel : pictures.color.pixels()) halves.push_back(glm::packHalf4x16(pixel));
        const auto depth = frame.upload("depth", {pictures.depth_m.extent(), vulkan::Format::kR32f},
                                        std::as_bytes(std::span(pictures.depth_m.pixels())));
        const auto color = frame.upload("color", {pictures.color.extent(), vulkan::Format::kRgba16f},
                                        std::as_bytes(std::span(halves)));
        return add_shrink_frame(frame, depth, color);
    }
};

TEST_F(Keyframes, AnEvenFrameStaysEvenAtEverySize) {
    for (const Extent2D extent : {Extent2D{1, 1}, {13, 7}, {40, 30}, {65, 33}, {512, 424}}) {
        Pictures pictures{Image<float>(extent), Image<glm::vec4>(extent)};
        for (float& depth : pictures.depth_m.pixels()) depth = 2.5f;
        for (glm::vec4& color : pictures.color.pixels()) color = {0.25f, 0.0625f, 1, 1};
        const Image<glm::vec4> got = shrink(pictures);
        for (const glm::vec4& pixel : got.pixels()) {
            EXPECT_LT(glm::distance(pixel, glm::vec4(0.5f, 0.25f, 1, 2.5f)), 1e-5f) << extent;
        }
    }
}

TEST_F(Keyframes, WhatIsNotKnownStaysOutOfMeans) {
    Pictures pictures{Image<float>({80, 60}), Image<glm::vec4>({80, 60})};
    for (uint32_t y = 0; y < 60; ++y) {
        for (uint32_t x = 40; x < 80; ++x) {
            pictures.depth_m.at(x, y) = 3;
            pictures.color.at(x, y) = {0.25f, 0.25f, 0.25f, 1};
        }
    }
    const Image<glm::vec4> got = shrink(pictures);
    EXPECT_EQ(got.at(19, 15), glm::vec4(-1, -1, -1, 0));  // less than half of the weight is known
    EXPECT_LT(glm::distance(got.at(20, 15), glm::vec4(0.5f, 0.5f, 0.5f, 3)), 1e-5f);
    EXPECT_LT(glm::distance(got.at(39, 0), glm::vec4(0.5f, 0.5f, 0.5f, 3)), 1e-5f);
}

TEST_F(Keyframes, ShrinkingMatchesTheReference) {
    for (const auto& [depth_px, color_px] : std::vector<std::pair<Extent2D, Extent2D>>{
             {{1, 1}, {1, 1}}, {{13, 7}, {41, 31}}, {{65, 33}, {64, 48}}, {{170, 141}, {121, 90}}}) {
        const Pictures pictures = wavy_pictures(depth_px, color_px);
        const Image<glm::vec4> got = shrink(pictures);
        const Image<reference::SmallPixel> expected = reference::small_picture(pictures.depth_m, pictures.color);
        for (uint32_t y = 0; y < got.extent().height; ++y) {
            for (uint32_t x = 0; x < got.extent().width; ++x) {
                const reference::SmallPixel& pixel = expected.at(x, y);
                EXPECT_NEAR(got.at(x, y).a, pixel.depth_m.value_or(0), 1e-4) << depth_px << " at " << x << ", " << y;
                const glm::dvec3 color = pixel.color.value_or(glm::dvec3(-1));
                // Colours are half floats: 2^-11 of the value, and more of a small one's square root.
                EXPECT_LT(glm::distance(glm::dvec3(got.at(x, y)), color), 1e-3) << color_px << " at " << x << ", " << y;
            }
        }
    }
}

TEST_F(Keyframes, AFernSaysWhichValuesLieAboveItsThresholds) {
    Pictures pictures{Image<float>({40, 30}), Image<glm::vec4>({40, 30})};
    for (float& depth : pictures.depth_m.pixels()) depth = 2;
    for (glm::vec4& color : pictures.color.pixels()) color = {0.25f, 0.25f, 0.25f, 1};
    std::vector<gpu::Fern> ferns(gpu::kFerns, gpu::Fern{{0, 0}, 3, 0, {0.9f, 0.9f, 0.9f, 0}});
    ferns[1].depth_m = 1.5f;
    ferns[2].color.r = 0.4f;
    ferns[7].color.g = 0.4f;
    ferns[511] = {{39, 29}, 1, 0, {0.1f, 0.1f, 0.1f, 0}};
    Code expected = code_of_all(kHasBoth);
    expected[0] |= gpu::kFernDepth << 8 | gpu::kFernRed << 16;
    expected[1] |= gpu::kFernGreen << 24;
    expected[127] |= 15u << 24;
    EXPECT_EQ(encode(pictures, ferns), expected);
    for (float& depth : pictures.depth_m.pixels()) depth = 0;
    for (glm::vec4& color : pictures.color.pixels()) color = glm::vec4(0);
    EXPECT_EQ(encode(pictures, ferns), code_of_all(0));
}

TEST_F(Keyframes, CodesMatchTheReferencesPicture) {
    const std::vector<gpu::Fern> ferns = make_ferns({.seed = 7});
    for (const Extent2D extent : {Extent2D{13, 7}, {65, 33}, {170, 141}}) {
        const Pictures pictures = wavy_pictures(extent, extent);
        const Image<reference::SmallPixel> small = reference::small_picture(pictures.depth_m, pictures.color);
        const std::vector<reference::FernCode> got = readable(encode(pictures, ferns));
        size_t compared = 0;
        for (uint32_t i = 0; i < gpu::kFerns; ++i) {
            const reference::SmallPixel& pixel = small.at(ferns[i].pixel.x, ferns[i].pixel.y);
            ASSERT_EQ(got[i].depth.has_value(), pixel.depth_m.has_value()) << i;
            ASSERT_EQ(got[i].color.has_value(), pixel.color.has_value()) << i;
            // What lies closer to a threshold than rounding may fall to either side.
            if (pixel.depth_m && std::abs(*pixel.depth_m - ferns[i].depth_m) > 1e-4) {
                EXPECT_EQ(*got[i].depth, *pixel.depth_m > ferns[i].depth_m) << i;
                ++compared;
            }
            for (glm::length_t c = 0; pixel.color && c < 3; ++c) {
                if (std::abs((*pixel.color)[c] - ferns[i].color[c]) < 1e-3) continue;
                EXPECT_EQ((*got[i].color)[size_t(c)], (*pixel.color)[c] > ferns[i].color[c]) << i;
                ++compared;
            }
        }
        EXPECT_GT(compared, 1000u);
    }
}

TEST_F(Keyframes, DissimilarityIsTheShareOfDifferingFerns) {
    const KeyframeStore store = made_store();
    const Code code = code_of_all(kHasBoth | gpu::kFernGreen);
    offer(store, code, 3);
    EXPECT_EQ(match(store, code, 1)[0].dissimilarity, 0);
    EXPECT_EQ(match(store, changed(code, 64, gpu::kFernDepth), 1)[0].dissimilarity, 0.125f);
    // Several tests of one fern count once.
    EXPECT_EQ(match(store, changed(code, 64, gpu::kFernRed | gpu::kFernBlue), 1)[0].dissimilarity, 0.125f);
    EXPECT_EQ(match(store, changed(code, 64, gpu::kFernRed), 1, KeyframeTests::kDepth)[0].dissimilarity, 0);
    EXPECT_EQ(match(store, changed(code, 64, gpu::kFernDepth), 1, KeyframeTests::kDepth)[0].dissimilarity, 0.125f);
    // What one of them does not know does not count, until too little is left.
    const Code half_known = changed(changed(code, 384, kHasBoth), 448, gpu::kFernDepth);
    EXPECT_EQ(match(store, half_known, 1)[0].dissimilarity, 0.5f);
    EXPECT_EQ(match(store, changed(code, 385, gpu::kFernHasDepth), 1)[0].dissimilarity, 1);
    // Without colours the depth alone is compared.
    const Code colorless = changed(changed(code, 512, gpu::kFernHasColor | gpu::kFernRed), 64, gpu::kFernDepth);
    EXPECT_EQ(match(store, colorless, 1)[0].dissimilarity, 0.125f);
}

TEST_F(Keyframes, MatchesComeInOrderWithTheirPoses) {
    const KeyframeStore store = made_store({.capacity = 300, .least_dissimilarity = 0});
    const Code code = code_of_all(kHasBoth);
    // Frame i differs from the code in 500 - i ferns, frames 100 and 101 alike, and from all before.
    for (uint32_t i = 0; i < 200; ++i) {
        const uint32_t tests = i == 101 ? gpu::kFernRed : gpu::kFernDepth;
        offer(store, changed(code, 500 - (i == 101 ? 100 : i), tests), i);
    }
    const auto found = match(store, changed(code, 350, gpu::kFernDepth), 4);
    EXPECT_EQ(found[0].frame, 150u);
    EXPECT_EQ(found[0].slot, 150u);
    EXPECT_EQ(found[0].dissimilarity, 0);
    EXPECT_EQ(found[0].world_from_camera[3].x, 0.15f);
    EXPECT_EQ(found[0].world_from_camera[0].x, 1);
    EXPECT_EQ(found[1].frame, 149u);  // as near as 151, and older
    EXPECT_EQ(found[2].frame, 151u);
    EXPECT_EQ(found[3].frame, 148u);
    EXPECT_EQ(found[3].dissimilarity, 2.0f / 512);
}

TEST_F(Keyframes, AStoreWithFewerSaysSo) {
    const KeyframeStore store = made_store();
    const Code code = code_of_all(kHasBoth);
    for (const auto& none : match(store, code, 3)) EXPECT_EQ(none.slot, gpu::kNoKeyframe);
    offer(store, code, 5);
    offer(store, changed(code, 200, gpu::kFernDepth), 6);
    const auto found = match(store, code, gpu::kMostMatches);
    ASSERT_EQ(found.size(), gpu::kMostMatches);
    EXPECT_EQ(found[0].frame, 5u);
    EXPECT_EQ(found[1].frame, 6u);
    EXPECT_EQ(found[1].dissimilarity, 200.0f / 512);
    for (size_t i = 2; i < found.size(); ++i) {
        EXPECT_EQ(found[i].slot, gpu::kNoKeyframe);
        EXPECT_EQ(found[i].world_from_camera, glm::mat4(0));
    }
}

TEST_F(Keyframes, OnlyNewAndWellTrackedFramesAreKept) {
    const KeyframeStore store = made_store({.least_dissimilarity = 0.25f});
    const Code code = code_of_all(kHasBoth);
    EXPECT_EQ(offer(store, code, 0, false).used, 0u);                             // badly tracked
    EXPECT_EQ(offer(store, changed(code, 385, gpu::kFernHasDepth), 1).used, 0u);  // knows too little
    EXPECT_EQ(offer(store, code, 2).used, 1u);
    EXPECT_EQ(offer(store, changed(code, 128, gpu::kFernDepth), 3).used, 1u);  // a quarter differs, not more
    EXPECT_EQ(offer(store, changed(code, 129, gpu::kFernDepth), 4).used, 2u);
    EXPECT_EQ(offer(store, changed(code, 256, gpu::kFernHasDepth), 5).used, 2u);  // the known half is alike
    const Code unlike = changed(changed(code, 384, gpu::kFernHasDepth), 512, gpu::kFernDepth);
    EXPECT_EQ(offer(store, unlike, 6).used, 3u);  // a quarter is known, which is enough
    EXPECT_EQ(match(store, code, 1)[0].frame, 2u);
}

TEST_F(Keyframes, AFrameThatIsNearNoneIsKeptThoughItLooksAlike) {
    const KeyframeStore store = made_store({.near_m = 0.5f, .near_degrees = 10});
    const Code code = code_of_all(kHasBoth);
    const auto turned = [](double degrees) {
        return RigidTransform(glm::mat4_cast(glm::angleAxis(glm::radians(degrees), glm::dvec3(0.6, 0, 0.8))));
    };
    EXPECT_EQ(offer(store, code, 0, true, turned(0)).used, 1u);
    EXPECT_EQ(offer(store, code, 499, true, turned(9.9)).used, 1u);
    EXPECT_EQ(offer(store, code, 0, true, turned(10.1)).used, 2u);
    EXPECT_EQ(offer(store, code, 501).used, 3u);
    EXPECT_EQ(offer(store, code, 250, true, turned(5)).used, 3u);
    // The near one may be any of many.
    const KeyframeStore long_way = made_store({.near_m = 0.5f});
    for (uint32_t i = 0; i < 200; ++i) EXPECT_EQ(offer(long_way, code, i, true, turned(0), 1).used, i + 1);
    for (const uint32_t i : {0u, 127u, 128u, 199u}) {
        EXPECT_EQ(offer(long_way, code, i, true, turned(0), 1).used, 200u);
    }
}

TEST_F(Keyframes, AFullStoreRefusesAndKeepsWhatItHas) {
    const KeyframeStore store = made_store({.capacity = 3});
    const Code code = code_of_all(kHasBoth);
    for (uint32_t i = 0; i < 5; ++i) {
        const gpu::KeyframeCounters counters = offer(store, changed(code, 105 * i, gpu::kFernDepth), i);
        EXPECT_EQ(counters.used, std::min(i + 1, 3u));
        EXPECT_EQ(counters.refused, i < 3 ? 0 : i - 2);
    }
    EXPECT_EQ(offer(store, code, 9).refused, 2u);  // it is no new one
    for (uint32_t i = 0; i < 3; ++i) EXPECT_EQ(match(store, changed(code, 105 * i, gpu::kFernDepth), 1)[0].frame, i);
}

TEST_F(Keyframes, MatchesOfRandomCodesAreTheReferences) {
    std::mt19937 random(3);
    for (const uint32_t keyframes : {1u, 127u, 129u}) {
        const KeyframeStore store = made_store({.capacity = 200, .least_dissimilarity = 0});
        std::vector<Code> codes(keyframes + 1, Code(gpu::kFernWords));
        for (Code& code : codes) {
            for (uint32_t& word : code) word = (random() & 0x0f0f0f0f) | 0x30303030;
        }
        for (uint32_t i = 0; i < keyframes; ++i) offer(store, codes[i], i);
        for (uint32_t& word : codes.back()) word &= random() | random();  // forgets some
        for (const KeyframeTests tests : {KeyframeTests::kAll, KeyframeTests::kDepth}) {
            std::vector<std::pair<double, uint32_t>> expected;
            for (uint32_t i = 0; i < keyframes; ++i) {
                expected.emplace_back(reference::dissimilarity(readable(codes[i]), readable(codes.back()),
                                                               tests == KeyframeTests::kDepth),
                                      i);
            }
            std::sort(expected.begin(), expected.end());
            const auto got = match(store, codes.back(), 5, tests);
            for (size_t i = 0; i < std::min<size_t>(5, keyframes); ++i) {
                EXPECT_EQ(got[i].frame, expected[i].second) << keyframes;
                EXPECT_FLOAT_EQ(got[i].dissimilarity, static_cast<float>(expected[i].first));
            }
        }
    }
}

TEST_F(Keyframes, FernsFollowTheSeedAndStayInTheirRanges) {
    const std::vector<gpu::Fern> ferns = make_ferns({.seed = 1}), again = make_ferns({.seed = 1});
    const std::vector<gpu::Fern> others = make_ferns({.seed = 2});
    // mt19937(1) begins 1791095845, 4282876139, 3093770124, 4005303368, 491263, 550290313.
    EXPECT_EQ(ferns[0].pixel, glm::uvec2(16, 29));
    EXPECT_NEAR(ferns[0].color.r, 0.1 + 0.8 * 3093770124 / 4294967296, 1e-6);
    EXPECT_NEAR(ferns[0].depth_m, 0.5 + 5.5 * 550290313 / 4294967296, 1e-6);
    bool differs = false;
    for (size_t i = 0; i < ferns.size(); ++i) {
        EXPECT_EQ(ferns[i].pixel, again[i].pixel);
        EXPECT_EQ(ferns[i].color, again[i].color);
        differs |= ferns[i].pixel != others[i].pixel;
        EXPECT_LT(ferns[i].pixel.x, gpu::kSmallWidth);
        EXPECT_LT(ferns[i].pixel.y, gpu::kSmallHeight);
        EXPECT_TRUE(ferns[i].depth_m >= 0.5f && ferns[i].depth_m <= 6);
    }
    EXPECT_TRUE(differs);
}

TEST_F(Keyframes, RefusesSettingsThatCannotBeMet) {
    const auto message = [](const char* part) { return ThrowsMessage<Error>(HasSubstr(part)); };
    EXPECT_THAT([&] { made_store({.capacity = 0}); }, message("capacity is 0 keyframes"));
    EXPECT_THAT([&] { made_store({.capacity = 20000}); }, message("it must be 1 to 16384"));
    EXPECT_THAT([&] { made_store({.least_depth_m = 4, .most_depth_m = 1}); }, message("from 4 m to 1 m"));
    EXPECT_THAT([&] { made_store({.least_dissimilarity = 1.5f}); }, message("least_dissimilarity is 1.5"));
    EXPECT_THAT([&] { made_store({.near_degrees = 181}); }, message("0.25 m and 181 degrees"));
    const KeyframeStore store = made_store();
    EXPECT_THAT([&] { match(store, code_of_all(0), 33); }, message("33 keyframes, it must be 1 to 32"));
    graph::FrameGraph frame = runner().begin();
    const auto wrong = frame.create_image("wrong", {{30, 40}, vulkan::Format::kRgba32f});
    EXPECT_THAT([&] { add_encode_frame(frame, wrong, store.import(frame).ferns); }, message("30 x 40 pixels"));
}

}  // namespace
}  // namespace patina::keyframes_test
