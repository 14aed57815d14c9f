#include "scenes/render/environment.h"

#include <cmath>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "engine/core/latitude_longitude.h"
#include "tests/data_folder.h"

namespace patina::scenes::environment_test {
namespace {

constexpr Extent2D kExtent{128, 64};
constexpr float kPi = std::numbers::pi_v<float>;

/// A temporary file that holds some bytes.
struct TemporaryFile {
    explicit TemporaryFile(const std::string& name, const std::string& bytes)
        : path(std::filesystem::path(::testing::TempDir()) / name) {
        std::ofstream(path, std::ios::binary) << bytes;
    }
    ~TemporaryFile() { std::filesystem::remove(path); }
    std::filesystem::path path;
};

TEST(Environment, CentreIsAheadTopIsUpAndRightIsRight) {
    EXPECT_LT(glm::distance(direction_of({64, 32}, kExtent), glm::vec3(0, 0, 1)), 1e-6f);
    EXPECT_LT(glm::distance(direction_of({96, 32}, kExtent), glm::vec3(1, 0, 0)), 1e-6f);
    EXPECT_LT(glm::distance(direction_of({0, 32}, kExtent), glm::vec3(0, 0, -1)), 1e-6f);
    EXPECT_LT(glm::distance(direction_of({10, 0}, kExtent), glm::vec3(0, -1, 0)), 1e-6f);
    EXPECT_LT(glm::distance(direction_of({10, 64}, kExtent), glm::vec3(0, 1, 0)), 1e-6f);
}

TEST(Environment, PixelsCoverTheWholeSphere) {
    double sum = 0;
    for (uint32_t y = 0; y < kExtent.height; ++y) sum += solid_angle_of_row(y, kExtent) * kExtent.width;
    EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-5);
}

TEST(Environment, MeanIsWeightedBySolidAngle) {
    EXPECT_LT(glm::distance(mean_radiance(draw_environment(UniformEnvironment{{1, 2, 3}}, kExtent)), {1, 2, 3}), 1e-5f);
    // The band of 30 degrees on both sides of the horizon is half of the sphere, though a third of the rows.
    Image<glm::vec3> band({12, 6});
    for (uint32_t x = 0; x < 12; ++x) band.at(x, 2) = band.at(x, 3) = glm::vec3(1);
    EXPECT_NEAR(mean_radiance(band).r, 0.5f, 1e-6f);
}

/// What a surface with that normal receives.
glm::vec3 irradiance(const Image<glm::vec3>& environment, glm::vec3 normal) {
    glm::dvec3 sum(0);
    const Extent2D extent = environment.extent();
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const float facing = glm::dot(direction_of(glm::vec2(x, y) + 0.5f, extent), normal);
            sum += glm::dvec3(environment.at(x, y)) * double{std::max(0.0f, facing)} * solid_angle_of_row(y, extent);
        }
    }
    return glm::vec3(sum);
}

TEST(Sky, SunHasItsIrradianceAtItsPlaceAtAnySize) {
    for (const float radius : {0.001f, 0.1f}) {
        SkyEnvironment sky;
        sky.zenith = sky.horizon = sky.ground = glm::vec3(0);
        sky.sun_azimuth_rad = 0.5f;
        sky.sun_elevation_rad = 0.8f;
        sky.sun_radius_rad = radius;
        const glm::vec3 sun(std::cos(0.8f) * std::sin(0.5f), -std::sin(0.8f), std::cos(0.8f) * std::cos(0.5f));
        const Image<glm::vec3> picture = draw_environment(sky, kExtent);
        EXPECT_LT(glm::distance(irradiance(picture, sun), sky.sun_irradiance), 1e-3f);
        for (uint32_t y = 0; y < kExtent.height; ++y) {
            for (uint32_t x = 0; x < kExtent.width; ++x) {
                const glm::vec3 direction = direction_of(glm::vec2(x, y) + 0.5f, kExtent);
                // A pixel of 2.8 degrees may hold a sun that is smaller.
                EXPECT_TRUE(picture.at(x, y).r == 0 || std::acos(glm::dot(direction, sun)) < radius + 0.036f);
            }
        }
    }
}

TEST(Sky, IsBlueAboveBrightAtTheHorizonAndDarkBelow) {
    const SkyEnvironment sky;
    const Image<glm::vec3> picture = draw_environment(sky, kExtent);
    EXPECT_LT(glm::distance(picture.at(0, 0), sky.zenith), 0.02f);
    EXPECT_LT(glm::distance(picture.at(0, 31), sky.horizon), 0.15f);
    EXPECT_EQ(picture.at(0, 40), sky.ground);
}

TEST(Studio, BoxesShineFromTheirPlaceWithTheirSize) {
    const SoftBox box{kPi, 0, {0.4f, 0.3f}, glm::vec3(5)};  // behind, across the seam
    const Image<glm::vec3> picture = draw_environment(StudioEnvironment{glm::vec3(0), {box}}, {512, 256});
    EXPECT_EQ(picture.at(0, 128), glm::vec3(5));
    EXPECT_EQ(picture.at(511, 128), glm::vec3(5));
    EXPECT_EQ(picture.at(256, 128), glm::vec3(0));
    // 0.8 rad of azimuth between the sines of -0.3 and 0.3.
    EXPECT_NEAR(mean_radiance(picture).r * 4 * kPi, 5 * 0.8f * 2 * std::sin(0.3f), 0.02f);
}

TEST(EnvironmentFile, RadianceFilesAreReadUpright) {
    // Two rows of two pixels, not run-length coded: red 1 and green 2 above blue 0.5 and black. Mantissa m and exponent
    // e stand for m 2^(e - 136).
    const std::string pixels(
        "\x80\0\0\x81"
        "\0\x80\0\x82"
        "\0\0\x80\x80"
        "\0\0\0\0",
        16);
    const TemporaryFile file("patina_environment.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n" + pixels);
    const Image<glm::vec3> environment = read_environment(file.path);
    ASSERT_EQ(environment.extent(), (Extent2D{2, 2}));
    EXPECT_EQ(environment.at(0, 0), glm::vec3(1, 0, 0));
    EXPECT_EQ(environment.at(1, 0), glm::vec3(0, 2, 0));
    EXPECT_EQ(environment.at(0, 1), glm::vec3(0, 0, 0.5f));
    EXPECT_EQ(environment.at(1, 1), glm::vec3(0));
}

TEST(EnvironmentFile, DamagedAndForeignFilesAreErrorsThatNameThem) {
    const TemporaryFile damaged("patina_damaged.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9 +X 9\nab");
    const TemporaryFile empty("patina_empty.hdr", "");
    for (const std::filesystem::path& path :
         {damaged.path, empty.path, std::filesystem::path("patina_missing.hdr"), std::filesystem::path("a.png")}) {
        try {
            read_environment(path);
            ADD_FAILURE() << "no error for " << path;
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), ::testing::HasSubstr(path.filename().string()));
        }
    }
}

TEST(EnvironmentFile, RecordedOnesHaveTheirPublishedMean) {
    const auto folder = testing::data_folder("hdr");
    if (!folder) GTEST_SKIP() << testing::kNoData;
    const Image<glm::vec3> lobby = read_environment(*folder / "st_fagans_interior_1k.hdr");
    EXPECT_EQ(lobby.extent(), (Extent2D{1024, 512}));
    // The solid-angle weighted mean that the data's README lists, to its two decimals.
    EXPECT_LT(glm::distance(mean_radiance(lobby), glm::vec3(0.98f, 0.81f, 0.54f)), 0.01f);
}

}  // namespace
}  // namespace patina::scenes::environment_test
