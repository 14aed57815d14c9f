#include "scenes/render/environment_table.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/error.h"

namespace patina::scenes::environment_table_test {
namespace {

Image<glm::vec3> random_picture(Extent2D extent) {
    std::mt19937 random(1);
    std::exponential_distribution<float> exponential;
    Image<glm::vec3> picture(extent);
    for (glm::vec3& rgb : picture.pixels())
        rgb = std::pow(exponential(random), 4.0f) * glm::vec3(1, exponential(random), 0.5f);
    return picture;
}

/// With which probability each cell is drawn.
std::vector<double> probabilities(const EnvironmentTable& table) {
    std::vector<double> drawn(table.cells.size());
    const double each = 1.0 / static_cast<double>(drawn.size());
    for (size_t i = 0; i < drawn.size(); ++i) {
        drawn[i] += each * table.aliases[i].keep;
        drawn[table.aliases[i].other] += each * (1.0 - table.aliases[i].keep);
    }
    return drawn;
}

TEST(EnvironmentTable, SolidAnglesCoverTheSphere) {
    for (const Extent2D extent : {Extent2D{1, 1}, {7, 3}, {64, 1000}}) {
        double sum = 0;
        for (uint32_t row = 0; row < extent.height; ++row) sum += extent.width * cell_solid_angle(extent, row);
        EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-12);
    }
}

TEST(EnvironmentTable, CellsAreDrawnInProportionToTheirLight) {
    for (const Extent2D extent : {Extent2D{1, 1}, {2, 1}, {33, 17}, {128, 64}}) {
        const Image<glm::vec3> picture = random_picture(extent);
        const EnvironmentTable table = make_environment_table("test", picture);
        ASSERT_EQ(table.cells.size(), extent.area());
        const std::vector<double> drawn = probabilities(table);
        double light = 0, sum = 0;
        for (size_t i = 0; i < drawn.size(); ++i) {
            const glm::dvec3 rgb(picture.pixels()[i]);
            light += (rgb.r + rgb.g + rgb.b) * cell_solid_angle(extent, static_cast<uint32_t>(i / extent.width));
        }
        for (size_t i = 0; i < drawn.size(); ++i) {
            const double omega = cell_solid_angle(extent, static_cast<uint32_t>(i / extent.width));
            const glm::dvec3 rgb(picture.pixels()[i]);
            const double expected = (rgb.r + rgb.g + rgb.b) * omega / light;
            EXPECT_NEAR(drawn[i], expected, 1e-6 * expected + 1e-7 / static_cast<double>(drawn.size()));
            EXPECT_NEAR(table.cells[i].w * omega, expected, 1e-6 * expected);
            EXPECT_EQ(glm::vec3(table.cells[i]), picture.pixels()[i]);
            sum += table.cells[i].w * omega;
        }
        EXPECT_NEAR(sum, 1, 1e-6);
    }
}

TEST(EnvironmentTable, BlackIsDrawnUniformlyOverTheSphere) {
    const EnvironmentTable table = make_environment_table("test", Image<glm::vec3>({8, 5}));
    const auto drawn = probabilities(table);
    for (size_t i = 0; i < drawn.size(); ++i) {
        EXPECT_NEAR(table.cells[i].w, 1 / (4 * std::numbers::pi), 1e-7);
        EXPECT_NEAR(drawn[i], cell_solid_angle({8, 5}, static_cast<uint32_t>(i / 8)) / (4 * std::numbers::pi), 1e-7);
    }
}

TEST(EnvironmentTable, RefusesWhatIsNoLight) {
    const auto expect_error = [](const Image<glm::vec3>& picture, const char* message) {
        try {
            make_environment_table("hall", picture);
            ADD_FAILURE() << "no error: " << message;
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr("scene 'hall'"));
            EXPECT_THAT(error.what(), testing::HasSubstr(message));
        }
    };
    expect_error({}, "0 x 0 pixels");
    expect_error(Image<glm::vec3>({4096, 2049}), "4096 x 2049 pixels");
    Image<glm::vec3> picture({4, 3}, glm::vec3(1));
    picture.at(2, 1).g = -0.5f;
    expect_error(picture, "-0.5 in pixel (2, 1)");
    picture.at(2, 1).g = std::numeric_limits<float>::infinity();
    expect_error(picture, "inf in pixel (2, 1)");
    picture.at(2, 1).g = std::numeric_limits<float>::quiet_NaN();
    expect_error(picture, "nan in pixel (2, 1)");
}

}  // namespace
}  // namespace patina::scenes::environment_table_test
