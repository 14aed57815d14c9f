// A sun found in the patches that it makes of an analytic room.

#include "reconstruction/lights/search_sun.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace patina::search_sun_test {
namespace {

/// A wall with a window, the floor before it, and the wall across: x to the right, y up, the window's wall at z = 0.
struct Room {
    glm::vec3 to_sun = glm::normalize(glm::vec3(0.3f, 0.8f, -1.0f));
    glm::vec3 sun{6, 5.4f, 5};                    ///< irradiance over pi of what faces it
    glm::vec2 low{1.2f, 0.9f}, high{2.4f, 2.1f};  ///< the window, x and y
    float noise = 0.05f;
    float from_m = 0, to_m = 5;  ///< the part of the floor that was seen, z
};

constexpr glm::vec3 kSize{4, 2.5f, 5};
constexpr glm::vec3 kRoomLight{0.3f, 0.28f, 0.25f};

/// Where a ray from a point in the room leaves it through the window's wall.
bool through_window(const Room& room, glm::vec3 from, glm::vec3 direction) {
    if (direction.z >= 0) return false;
    const glm::vec3 at = from + direction * (-from.z / direction.z);
    return at.x > room.low.x && at.x < room.high.x && at.y > room.low.y && at.y < room.high.y;
}

float cosine_to(const Room& room, const gpu::LightSample& sample, glm::vec3 direction) {
    const float cosine = glm::dot(glm::vec3(sample.normal), direction);
    return cosine > 0.05f && through_window(room, glm::vec3(sample.point_m), direction) ? cosine : 0;
}

TrySuns try_suns(const Room& room) {
    return [&room](std::span<const gpu::LightSample> samples, std::span<const glm::vec3> directions) {
        std::vector<float> rows;
        for (const glm::vec3& direction : directions)
            for (const gpu::LightSample& sample : samples) rows.push_back(cosine_to(room, sample, direction));
        return rows;
    };
}

/// Samples of floor and walls, of three albedos; every third of the places is empty.
std::vector<gpu::LightSample> samples_of(const Room& room, const std::vector<glm::vec3>& known) {
    std::mt19937 random(3);
    const auto uniform = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    std::vector<gpu::LightSample> samples(known.size());
    for (size_t i = 0; i < samples.size(); ++i) {
        gpu::LightSample& s = samples[i];
        if (i % 3 == 0) continue;
        const glm::vec3 at(uniform(0, kSize.x), uniform(0, kSize.y), uniform(0, kSize.z));
        const bool floor = i % 3 == 1;
        s.point_m = floor ? glm::vec4(at.x, 0, room.from_m + (room.to_m - room.from_m) * at.z / kSize.z, 8)
                          : glm::vec4(at.x, at.y, kSize.z, 8);
        s.normal = floor ? glm::vec4(0, 1, 0, 0) : glm::vec4(0, 0, -1, 0);
        const glm::vec3 kd = !floor     ? glm::vec3(0.75f, 0.73f, 0.7f)
                             : at.x < 2 ? glm::vec3(0.3f, 0.18f, 0.1f)
                                        : glm::vec3(0.1f, 0.12f, 0.16f);
        const glm::vec3 light = known[i] + cosine_to(room, s, room.to_sun) * room.sun;
        s.diffuse = glm::vec4(kd * light * (1 + uniform(-room.noise, room.noise)), 0);
    }
    return samples;
}

std::optional<SunInPatches> found_in(const Room& room, const Room& seen) {
    const std::vector<glm::vec3> known(gpu::kLightSamples, kRoomLight);
    const std::vector<gpu::LightSample> samples = samples_of(room, known);
    return search_sun(samples, known, try_suns(seen));
}

TEST(SearchSun, FindsDirectionAndColourOfThePatchesOnFloorAndWall) {
    const Room room;
    const auto sun = found_in(room, room);
    ASSERT_TRUE(sun);
    EXPECT_GT(glm::dot(sun->direction, room.to_sun), std::cos(0.01f));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sun->irradiance[c], room.sun[c], 0.05 * double{room.sun[c]});
    EXPECT_GT(sun->precision, 0.95f);
    EXPECT_GT(sun->recall, 0.95f);
    EXPECT_GT(sun->samples, 100u);
}

TEST(SearchSun, IsSoughtInVainWhereNothingIsBright) {
    Room dark;
    dark.sun = glm::vec3(0);
    EXPECT_FALSE(found_in(dark, dark));
    dark.sun = glm::vec3(0.3f);  // less than the room's own light
    EXPECT_FALSE(found_in(dark, dark));
}

TEST(SearchSun, IsNoneOfAPatchSmallerThanALampsRim) {
    Room room;
    room.low = {1.75f, 1.45f};
    room.high = {1.85f, 1.55f};
    EXPECT_FALSE(found_in(room, room));
}

TEST(SearchSun, IsNoneWhereTheWindowThatLetsItInWasNotSeen) {
    Room seen;
    seen.low = seen.high = {-9, -9};
    EXPECT_FALSE(found_in(Room(), seen));
}

/// Were the whole wall open, the patch could be anywhere on it: each direction lights far more than the patch.
TEST(SearchSun, IsNoneWhereTheWholeWallIsOpen) {
    Room seen;
    seen.low = {-100, -100};
    seen.high = {100, 100};
    EXPECT_FALSE(found_in(Room(), seen));
}

/// A strip of the floor tells how far to the side the sun stands, and not how high.
TEST(SearchSun, IsNoneWhereTooLittleOfThePatchWasSeen) {
    Room room;
    room.low.x = 1.9f;  // so that less than half of the strip is lit
    room.high.x = 2.7f;
    EXPECT_TRUE(found_in(room, room));
    room.from_m = 1.75f;
    room.to_m = 1.95f;
    EXPECT_FALSE(found_in(room, room));
}

/// Most of either floor is lit, so that what its samples mostly reflect is sunlight, too. Only its own shade tells.
TEST(SearchSun, LightsMostOfASurface) {
    Room room;
    room.low = {0.8f, -1};
    room.high = {4.2f, 5};
    const auto sun = found_in(room, room);
    ASSERT_TRUE(sun);
    EXPECT_GT(glm::dot(sun->direction, room.to_sun), std::cos(0.1f));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sun->irradiance[c], room.sun[c], 0.1 * double{room.sun[c]});
}

/// What is not observed, or of which nobody looked what is around it, tells nothing.
TEST(SearchSun, LeavesOutSamplesThatTellNothing) {
    const Room room;
    const std::vector<glm::vec3> known(gpu::kLightSamples, kRoomLight);
    std::vector<gpu::LightSample> samples = samples_of(room, known);
    for (gpu::LightSample& sample : samples) sample.around.w = -1;
    EXPECT_FALSE(search_sun(samples, known, try_suns(room)));
}

}  // namespace
}  // namespace patina::search_sun_test
