#include "scenes/description/texture.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "scenes/description/periodic_noise.h"
#include "sensor/files/picture_file.h"

namespace patina::scenes::texture_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Settings that every pattern takes.
PatternSettings settings(uint32_t seed = 7) {
    return {
        {glm::vec3(0.6f, 0.5f, 0.4f), {0.1f, 0.2f, 0.3f}, {0.9f, 0.1f, 0.2f}, {0.2f, 0.6f, 0.1f}}, {8, 8}, seed, 256};
}

class Patterns : public ::testing::TestWithParam<std::string> {
  protected:
    Image<glm::vec3> draw(const PatternSettings& with = settings()) const {
        return draw_pattern(pattern_named(GetParam()), with);
    }
};

INSTANTIATE_TEST_SUITE_P(All, Patterns, ::testing::ValuesIn(pattern_names()), [](const auto& p) { return p.param; });

TEST_P(Patterns, AreAlbedosOfMoreThanOneColor) {
    const Image<glm::vec3> picture = draw();
    ASSERT_EQ(picture.extent(), (Extent2D{256, 256}));
    for (const glm::vec3& kd : picture.pixels()) {
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(kd, glm::vec3(0))) &&
                    glm::all(glm::lessThanEqual(kd, glm::vec3(1))));
    }
    EXPECT_TRUE(std::any_of(picture.pixels().begin(), picture.pixels().end(),
                            [&](glm::vec3 kd) { return glm::distance(kd, picture.at(0, 0)) > 0.1f; }));
}

/// Sums of |difference| between neighbours across the line between rows y - 1 and y, and columns x - 1 and x.
float step_between_rows(const Image<glm::vec3>& picture, uint32_t y) {
    const auto [width, height] = picture.extent();
    float sum = 0;
    for (uint32_t x = 0; x < width; ++x)
        sum += glm::distance(picture.at(x, y), picture.at(x, (y + height - 1) % height));
    return sum;
}
float step_between_columns(const Image<glm::vec3>& picture, uint32_t x) {
    const auto [width, height] = picture.extent();
    float sum = 0;
    for (uint32_t y = 0; y < height; ++y)
        sum += glm::distance(picture.at(x, y), picture.at((x + width - 1) % width, y));
    return sum;
}

TEST_P(Patterns, RepeatWithoutSeams) {
    const Image<glm::vec3> picture = draw();
    float rows = 0, columns = 0;  // the greatest steps inside
    for (uint32_t i = 1; i < 256; ++i) {
        rows = std::max(rows, step_between_rows(picture, i));
        columns = std::max(columns, step_between_columns(picture, i));
    }
    EXPECT_LE(step_between_rows(picture, 0), rows * 1.1f + 0.1f);
    EXPECT_LE(step_between_columns(picture, 0), columns * 1.1f + 0.1f);
}

TEST_P(Patterns, HaveNoDetailOfOneTexel) {
    // A texel that stands out from both its neighbours by more than a fifth is a speck that bilinear samples lose.
    const Image<glm::vec3> picture = draw();
    size_t specks = 0;
    const auto out = [&](glm::vec3 before, glm::vec3 here, glm::vec3 after) {
        const glm::vec3 a = here - before, b = here - after;
        return glm::any(
            glm::greaterThan(glm::min(glm::abs(a), glm::abs(b)) * glm::step(glm::vec3(0), a * b), glm::vec3(0.2f)));
    };
    for (uint32_t y = 1; y < 255; ++y) {
        for (uint32_t x = 1; x < 255; ++x) {
            const glm::vec3 here = picture.at(x, y);
            specks += out(picture.at(x - 1, y), here, picture.at(x + 1, y)) ||
                      out(picture.at(x, y - 1), here, picture.at(x, y + 1));
        }
    }
    EXPECT_LE(specks, 4u);
}

TEST_P(Patterns, TheSameSettingsGiveTheSamePicture) { EXPECT_EQ(draw().pixels(), draw().pixels()); }

TEST_P(Patterns, AnotherSeedGivesAnotherPictureWhereAnythingIsDrawnByLot) {
    const bool regular = GetParam() == "checker" || GetParam() == "stripes";
    EXPECT_EQ(draw(settings(1)).pixels() == draw(settings(2)).pixels(), regular);
}

TEST_P(Patterns, TooFewColorsTooManyCellsAndColorsThatAreNoAlbedoAreErrors) {
    const auto message = [&](auto change) {
        PatternSettings changed = settings();
        change(changed);
        try {
            draw(changed);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    EXPECT_THAT(message([](PatternSettings& s) { s.colors.resize(1); }), AllOf(HasSubstr(GetParam()), HasSubstr("1")));
    EXPECT_THAT(message([](PatternSettings& s) { s.count.x = 40; }), AllOf(HasSubstr("40 across"), HasSubstr("32")));
    EXPECT_THAT(message([](PatternSettings& s) { s.count.y = 0; }), HasSubstr("0 down"));
    EXPECT_THAT(message([](PatternSettings& s) { s.colors[1].g = 1.5f; }), HasSubstr("0.1 1.5 0.3"));
    EXPECT_THAT(message([](PatternSettings& s) { s.colors[0].r = NAN; }), HasSubstr("nan"));
    EXPECT_THAT(message([](PatternSettings& s) { s.size_px = 16; }), HasSubstr("16 texels"));
}

TEST(Checker, CellsTakeTheColorsInTurn) {
    const glm::vec3 dark(0.1f), light(0.8f);
    const Image<glm::vec3> picture = draw_pattern(Pattern::kChecker, {{dark, light}, {4, 2}, 0, 64});
    EXPECT_LT(glm::distance(picture.at(8, 16), dark), 1e-6f);  // a texel is a mean of samples
    EXPECT_LT(glm::distance(picture.at(24, 16), light), 1e-6f);
    EXPECT_LT(glm::distance(picture.at(8, 48), light), 1e-6f);
}

TEST(Checker, ColorsThatWouldNotMeetAtTheSeamAreAnError) {
    EXPECT_THROW(draw_pattern(Pattern::kChecker, {{glm::vec3(0), glm::vec3(1)}, {4, 3}, 0, 64}), Error);
}

TEST(Pattern, AnUnknownNameIsAnErrorThatListsTheKnown) {
    try {
        pattern_named("plaid");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("'plaid'"), HasSubstr("checker, stripes"), HasSubstr("poster")));
    }
}

TEST(PeriodicNoise, TilesAndIsEvenlySpread) {
    double sum = 0;
    for (uint32_t i = 0; i < 4096; ++i) sum += random_of_cell({i % 64, i / 64}, 3);
    EXPECT_NEAR(sum / 4096, 0.5, 0.02);  // sigma is 1 / sqrt(12 * 4096) = 0.0045
    for (const float v : {0.1f, 0.37f, 0.9f}) {
        EXPECT_NEAR(periodic_noise({0, v}, {5, 7}, 1), periodic_noise({0.99999f, v}, {5, 7}, 1), 1e-3f);
        EXPECT_NEAR(periodic_noise({v, 0}, {5, 7}, 1), periodic_noise({v, 0.99999f}, {5, 7}, 1), 1e-3f);
    }
}

TEST(TextureFile, CodesAreDecodedToLinearAlbedo) {
    const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "patina_texture.png";
    sensor::write_png(file, Image<SrgbPixel>({2, 1}, {SrgbPixel(255, 0, 188), SrgbPixel(10, 128, 64)}));
    const Image<glm::vec3> kd = read_texture(file);
    std::filesystem::remove(file);
    ASSERT_EQ(kd.extent(), (Extent2D{2, 1}));
    // IEC 61966-2-1: 188 / 255 is 0.5029, 128 / 255 is 0.2159, 64 / 255 is 0.0513; 10 lies on the linear piece.
    EXPECT_LT(glm::distance(kd.at(0, 0), glm::vec3(1, 0, 0.5029f)), 1e-4f);
    EXPECT_LT(glm::distance(kd.at(1, 0), glm::vec3(10 / 255.0f / 12.92f, 0.2159f, 0.0513f)), 1e-4f);
}

}  // namespace
}  // namespace patina::scenes::texture_test
