#include "reconstruction/session/bright_surfaces.h"

#include <limits>
#include <random>

#include <gmock/gmock.h>

#include "reconstruction/session/session_lights.h"
#include "reconstruction/session/surroundings.h"

namespace patina::tools::bright_surfaces_test {
namespace {

constexpr uint32_t kTaken = 61;  // of so many pixels one is taken, the first of a row here
constexpr float kUsualAlbedo = 0.8f;

/// A picture of which these values are taken, and no others.
Image<glm::vec3> picture_of(const std::vector<float>& values) {
    Image<glm::vec3> picture({kTaken, static_cast<uint32_t>(values.size())}, glm::vec3(100));
    for (uint32_t y = 0; y < values.size(); ++y) picture.at(0, y) = glm::vec3(0.5f * values[y], values[y], 0);
    return picture;
}

TEST(BrightSurfaces, WithoutAPixelThereIsNoLight) {
    BrightSurfaces bright;
    EXPECT_EQ(bright.ambient(kUsualAlbedo), glm::vec3(0));
    bright.add(picture_of({std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}));
    EXPECT_EQ(bright.ambient(kUsualAlbedo), glm::vec3(0));
}

TEST(BrightSurfaces, AValueThatIsAloneComesOutAsItIs) {
    BrightSurfaces bright;
    bright.add(picture_of(std::vector<float>(30, 0.37f)));
    EXPECT_FLOAT_EQ(bright.ambient(kUsualAlbedo).g, 0.37f / kUsualAlbedo);
    bright.add(picture_of(std::vector<float>(30, 0)));
    EXPECT_FLOAT_EQ(bright.ambient(kUsualAlbedo).g, 0.37f / kUsualAlbedo) << "half of the pixels are more than a tenth";
    bright.add(Image<SrgbPixel>({kTaken, 2000}, SrgbPixel(10, 200, 30)));
    EXPECT_FLOAT_EQ(bright.ambient(kUsualAlbedo).r, linear_color(SrgbPixel(10, 200, 30)).g / kUsualAlbedo);
}

TEST(BrightSurfaces, ClippedPixelsAreNoSurfaces) {
    Image<SrgbPixel> room({kTaken, 1000}, SrgbPixel(60, 120, 90));
    BrightSurfaces alone, with_window;
    alone.add(room);
    for (uint32_t y = 0; y < 300; ++y) room.at(0, y) = y % 2 == 0 ? SrgbPixel(255, 255, 255) : SrgbPixel(40, 254, 90);
    with_window.add(room);
    EXPECT_EQ(with_window.ambient(kUsualAlbedo), alone.ambient(kUsualAlbedo));

    BrightSurfaces clipped;
    clipped.add(Image<SrgbPixel>({kTaken, 100}, SrgbPixel(255, 255, 255)));
    EXPECT_FLOAT_EQ(clipped.ambient(kUsualAlbedo).g, 1 / kUsualAlbedo) << "there is no light that is less";

    BrightSurfaces linear;  // is not clipped
    linear.add(picture_of(std::vector<float>(30, 3)));
    EXPECT_FLOAT_EQ(linear.ambient(kUsualAlbedo).g, 3 / kUsualAlbedo);
}

TEST(BrightSurfaces, IsTheQuantileOfAllFramesWithinABin) {
    std::mt19937 random(7);
    std::lognormal_distribution<float> values(-2, 3);  // over ten decades
    BrightSurfaces bright;
    std::vector<float> all;
    for (int frame = 0; frame < 20; ++frame) {
        std::vector<float> some(101);
        for (float& value : some) value = values(random);
        bright.add(picture_of(some));
        all.insert(all.end(), some.begin(), some.end());
    }
    std::sort(all.begin(), all.end());
    const float quantile = all[static_cast<size_t>(0.9 * static_cast<double>(all.size() - 1))];
    EXPECT_NEAR(bright.ambient(kUsualAlbedo).g * kUsualAlbedo, quantile, quantile / 128);
    EXPECT_EQ(bright.ambient(kUsualAlbedo).r, bright.ambient(kUsualAlbedo).b);
}

TEST(SurroundingsSeen, TellTheLightWheneverThereAreTwiceAsManyFrames) {
    SurroundingsSeen seen(kUsualAlbedo);
    std::vector<int> told;
    for (int frame = 1; frame <= 1000; ++frame) {
        const auto ambient = seen.add(picture_of(std::vector<float>(3, 0.4f)));
        if (!ambient) continue;
        told.push_back(frame);
        EXPECT_FLOAT_EQ(ambient->g, 0.5f);
    }
    EXPECT_THAT(told, ::testing::ElementsAre(1, 2, 4, 8, 16, 32, 64, 128));
}

TEST(SurroundingsSeen, BlackPicturesTellNothing) {
    SurroundingsSeen seen(kUsualAlbedo);
    EXPECT_FALSE(seen.add(picture_of(std::vector<float>(30, 0))));
    EXPECT_TRUE(seen.add(picture_of(std::vector<float>(30, 0.4f))));
}

TEST(MayLackLamps, NotWhereTheCallerGaveThemHoweverTheyWereFound) {
    for (const char* found_by : {"surroundings", "lighting sequence"}) {
        Lighting earlier;
        earlier.found_by = found_by;
        Illumination light = illumination_of(earlier, glm::dvec3(0));
        EXPECT_FALSE(may_lack_lamps(light));
        light.given = false;
        EXPECT_TRUE(may_lack_lamps(light));
    }
}

}  // namespace
}  // namespace patina::tools::bright_surfaces_test
