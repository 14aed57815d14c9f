#include "passes/segmentation/label_components.h"

#include <random>

#include "tests/gpu/gpu_test.h"
#include "tests/reference/segmentation/frame_segments.h"

namespace patina::label_components_test {
namespace {

/// Every pixel inside with this chance; some of them farther away, which separates them.
Image<float> random_mask(Extent2D extent, double density, uint32_t seed, double far_share = 0) {
    std::mt19937 random(seed);
    std::bernoulli_distribution inside(density), far(far_share);
    Image<float> mask(extent);
    for (float& depth_m : mask.pixels()) {
        depth_m = inside(random) ? 1.0f : -1.0f;
        if (far(random)) depth_m *= 1.5f;
    }
    return mask;
}

template <class Inside>
Image<float> mask_where(Extent2D extent, Inside inside) {
    Image<float> mask(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) mask.at(x, y) = inside(x, y) ? 1.0f : 0.0f;
    }
    return mask;
}

/// One line of pixels that winds through the whole picture, from row to row (or column to column).
Image<float> serpentine(Extent2D extent, bool columns) {
    return mask_where(extent, [&](uint32_t x, uint32_t y) {
        const uint32_t along = columns ? y : x, across = columns ? x : y;
        const uint32_t end = (columns ? extent.height : extent.width) - 1;
        return across % 2 == 0 || along == (across % 4 == 1 ? end : 0);
    });
}

/// A line that winds inwards.
Image<float> spiral(Extent2D extent) {
    Image<float> mask(extent, 0.0f);
    const auto filled = [&](glm::ivec2 p) { return extent.contains(p.x, p.y) && mask.at(p.x, p.y) > 0; };
    glm::ivec2 place(0, 0), step(1, 0);
    mask.at(0, 0) = 1;
    for (int turns = 0; turns < 2;) {
        const glm::ivec2 next = place + step;
        if (extent.contains(next.x, next.y) && !filled(next + step) && !filled(next)) {
            place = next;
            mask.at(place.x, place.y) = 1;
            turns = 0;
        } else {
            step = {-step.y, step.x};
            ++turns;
        }
    }
    return mask;
}

/// Teeth that meet in the last row only, and rows that meet in the last column only.
Image<float> comb(Extent2D extent, bool rows) {
    return mask_where(extent, [&](uint32_t x, uint32_t y) {
        return rows ? y % 2 == 0 || x == extent.width - 1 : x % 2 == 0 || y == extent.height - 1;
    });
}

class LabelComponents : public GpuTest {
  protected:
    struct Result {
        Image<uint32_t> component;
        std::vector<uint32_t> pixels;  ///< per key
        bool operator==(const Result& other) const {
            return component.pixels() == other.component.pixels() && pixels == other.pixels;
        }
    };

    Result label(const Image<float>& mask) {
        graph::FrameGraph frame = runner().begin();
        const auto id =
            frame.upload("mask", {mask.extent(), vulkan::Format::kR32f}, std::as_bytes(std::span(mask.pixels())));
        const Components found = add_label_components(frame, id, 0.01f, 0.015f);
        const graph::Readback read = frame.read_back(found.component), counts = frame.read_back(found.pixels);
        run(std::move(frame));
        return {read.image<uint32_t>(), counts.as<uint32_t>()};
    }

    void expect_components(const Image<float>& mask, const std::string& what) {
        SCOPED_TRACE(::testing::Message() << what << " of " << mask.extent());
        const Result got = label(mask);
        const Image<uint32_t> expected = reference::components(mask);
        EXPECT_TRUE(got.component.pixels() == expected.pixels());
        std::vector<uint32_t> pixels(got.pixels.size());
        for (const uint32_t key : expected.pixels()) ++pixels[key];
        pixels[0] = 0;
        EXPECT_TRUE(got.pixels == pixels);
    }
};

constexpr Extent2D kExtents[] = {{1, 1}, {1, 40}, {70, 1}, {32, 4}, {33, 17}, {131, 65}, {512, 424}};

TEST_F(LabelComponents, TwoStripsAndADropAreThreeComponents) {
    //  x x . x
    //  . . . x
    //  x . . x     the corners at (0, 2) and (1, 3) do not touch
    //  . x x x
    const Image<float> mask({4, 4}, {1, 1, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 0, 1, 1, 1});
    const Result got = label(mask);
    EXPECT_THAT(got.component.pixels(), ::testing::ElementsAre(1, 1, 0, 4, 0, 0, 0, 4, 9, 0, 0, 4, 0, 4, 4, 4));
    EXPECT_EQ(got.pixels[4], 6u);
}

TEST_F(LabelComponents, PixelsAcrossAJumpAreNotConnected) {
    // At 1 m neighbours may differ by 0.025 m.
    const Result got = label(Image<float>({6, 1}, {1.0f, 1.02f, 1.04f, 1.08f, -1.09f, 1.1f}));
    EXPECT_THAT(got.component.pixels(), ::testing::ElementsAre(1, 1, 1, 4, 0, 6));
}

TEST_F(LabelComponents, RandomMasksOfAllDensities) {
    for (const Extent2D extent : kExtents) {
        for (int tenths = 1; tenths <= 9; ++tenths) {
            expect_components(random_mask(extent, 0.1 * tenths, 7 * tenths), "a random mask");
        }
        expect_components(random_mask(extent, 0.9, 3, 0.3), "a random mask with jumps");
    }
}

TEST_F(LabelComponents, WindingLines) {
    for (const Extent2D extent : kExtents) {
        expect_components(spiral(extent), "a spiral");
        for (const bool flag : {false, true}) {
            expect_components(serpentine(extent, flag), "a serpentine");
            expect_components(comb(extent, flag), "a comb");
        }
    }
}

TEST_F(LabelComponents, FullEmptyAndChequered) {
    for (const Extent2D extent : kExtents) {
        expect_components(Image<float>(extent, 1.0f), "all inside");
        expect_components(Image<float>(extent, -1.0f), "all edges");
        expect_components(Image<float>(extent, 0.0f), "no surface");
        expect_components(mask_where(extent, [](uint32_t x, uint32_t y) { return (x + y) % 2 == 0; }),
                          "a chequerboard");
    }
}

TEST_F(LabelComponents, LargePictures) {
    const Extent2D extent{1920, 1080};
    expect_components(random_mask(extent, 0.6, 5), "a random mask");
    expect_components(serpentine(extent, true), "a serpentine");
}

TEST_F(LabelComponents, TheSameBytesEveryTime) {
    for (const auto& [extent, times] : {std::pair(Extent2D{129, 97}, 100), {Extent2D{512, 424}, 5}}) {
        const Image<float> mask = random_mask(extent, 0.6, 11);
        const Result first = label(mask);
        for (int i = 1; i < times; ++i) ASSERT_TRUE(label(mask) == first) << extent << ", time " << i;
    }
}

}  // namespace
}  // namespace patina::label_components_test
