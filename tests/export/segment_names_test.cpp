#include "export/segment_names.h"

#include <gmock/gmock.h>

namespace patina::segment_names_test {
namespace {

using testing::ElementsAre;

/// A room of 4 x 4 x 2.4 m, y up, in patches of 0.1 m: label 1 its floor, 2 and 3 two walls, 4 its ceiling; on the
/// floor a cube of 0.8 m, 5, and above it a shelf, 6.
struct Room {
    std::vector<Patch> patches;
    std::vector<SegmentReflectance> segments = std::vector<SegmentReflectance>(7);
    Upright upright{.source = UpSource::kFloor, .y_up_from_world = {1, 0, 0, 0}, .floor_m = 0};

    Room() {
        add(1, {0, 0, 0}, {0, 0, 4}, {4, 0, 0});
        add(2, {0, 0, 0}, {3.6f, 0, 0}, {0, 2.4f, 0});
        add(3, {0, 0, 0}, {0, 2.4f, 0}, {0, 0, 4});
        add(4, {0, 2.4f, 0}, {4, 0, 0}, {0, 0, 4});
        add(5, {2, 0.8f, 2}, {0, 0, 0.8f}, {0.8f, 0, 0});
        add(5, {2, 0, 2.8f}, {0.8f, 0, 0}, {0, 0.8f, 0});
        add(6, {0, 1.5f, 1}, {0, 0, 2}, {0.6f, 0, 0});
    }
    void add(uint32_t label, glm::vec3 a, glm::vec3 u, glm::vec3 v) {
        const int columns = static_cast<int>(glm::length(u) / 0.1f + 0.5f),
                  rows = static_cast<int>(glm::length(v) / 0.1f + 0.5f);
        const float count = static_cast<float>(columns * rows);
        for (int y = 0; y < rows; ++y) {
            for (int x = 0; x < columns; ++x) {
                const float s = (static_cast<float>(x) + 0.5f) / static_cast<float>(columns),
                            t = (static_cast<float>(y) + 0.5f) / static_cast<float>(rows);
                patches.push_back({a + s * u + t * v, glm::cross(u, v) / count, label});
            }
        }
    }
    std::vector<std::string> names(const std::vector<std::string>& known = {}) const {
        return names_of_segments(segments, known, patches, upright);
    }
};

TEST(SegmentNames, SayWhatSegmentsAre) {
    Room room;
    room.segments[5] = {glm::vec3(0.5f, 0.03f, 0.03f), WardGloss{glm::vec3(0.05f), 0.1f, 0.9f}, 1, 1, 1};
    room.segments[6] = {glm::vec3(0.6f), WardGloss{glm::vec3(0.05f), 0.6f}, 1, 1, 1};
    EXPECT_THAT(room.names(), ElementsAre("", "floor", "wall 2", "wall 1", "ceiling", "object 5, red, glossy",
                                          "object 6, white, matt"));
}

TEST(SegmentNames, AreOfTheTurnedWorld) {
    Room room;
    const glm::quat turn = glm::normalize(glm::quat(0.3f, -0.5f, 0.2f, 0.7f));
    for (Patch& patch : room.patches) {
        patch.center_m = turn * patch.center_m;
        patch.area_m2 = turn * patch.area_m2;
    }
    room.upright.y_up_from_world = glm::inverse(glm::dquat(turn));
    EXPECT_THAT(room.names(), ElementsAre("", "floor", "wall 2", "wall 1", "ceiling", "object 5", "object 6"));
}

TEST(SegmentNames, KnownNamesStayAndNoTwoAreTheSame) {
    const Room room;
    EXPECT_THAT(room.names({"", "", "box", "box", "", "floor"}),
                ElementsAre("", "floor", "box", "box (3)", "ceiling", "floor (5)", "object 6"));
}

TEST(SegmentNames, GlossThatIsAGuessIsNotNamed) {
    Room room;
    room.segments[5].gloss = WardGloss{glm::vec3(0.05f), 0.1f, 0.2f};
    room.segments[6] = {glm::vec3(0.01f), WardGloss{glm::vec3(0.7f), 0.1f}, 1, 1, 1};
    EXPECT_EQ(room.names()[5], "object 5");
    EXPECT_EQ(room.names()[6], "object 6, metal");
}

TEST(SegmentNames, OfNothingAreObjects) {
    EXPECT_THAT(names_of_segments(std::vector<SegmentReflectance>(3), {}, {}, {}),
                ElementsAre("", "object 1", "object 2"));
    EXPECT_TRUE(names_of_segments({}, {}, {}, {}).empty());
}

TEST(SegmentNames, ColoursHaveWords) {
    const std::pair<glm::vec3, const char*> kColors[] = {
        {{0.9f, 0.9f, 0.9f}, "white"},     {{0.2f, 0.2f, 0.2f}, "grey"},    {{0.1f, 0.1f, 0.1f}, "dark grey"},
        {{0.01f, 0.01f, 0.01f}, "black"},  {{0.6f, 0.02f, 0.02f}, "red"},   {{0.02f, 0.5f, 0.05f}, "green"},
        {{0.03f, 0.08f, 0.6f}, "blue"},    {{0.7f, 0.6f, 0.02f}, "yellow"}, {{0.7f, 0.2f, 0.01f}, "orange"},
        {{0.12f, 0.05f, 0.02f}, "brown"},  {{0.7f, 0.55f, 0.4f}, "beige"},  {{0.02f, 0.5f, 0.5f}, "cyan"},
        {{0.3f, 0.03f, 0.5f}, "purple"},   {{0.8f, 0.1f, 0.4f}, "pink"},    {{0.05f, 0.003f, 0.003f}, "dark red"},
        {{0.5f, 0.65f, 0.9f}, "pale blue"}};
    for (const auto& [color, name] : kColors) EXPECT_EQ(color_name(color), name);
    EXPECT_EQ(color_name({-1, 2, 0}), "green");
}

}  // namespace
}  // namespace patina::segment_names_test
