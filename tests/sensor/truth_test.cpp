#include "sensor/truth.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/sensor/sequences.h"

namespace patina::sensor::truth_test {
namespace {

using namespace testing;
using ::testing::EndsWith;
using ::testing::HasSubstr;

TEST(Truth, LightsAndMaterialsFollowTheFormat) {
    const TemporaryFolder folder;
    write_lights(folder / "lights.json", std::vector<Light>{{{1, 2, 3}, {4, 5, 6.5}}});
    write_materials(folder / "materials.json",
                    std::vector<Material>{{1, "floor", glm::dvec3(0.25), glm::dvec3(0.5), 0.125},
                                          {2, "wood", std::nullopt, glm::dvec3(0), 1}});
    using Json = nlohmann::json;
    EXPECT_EQ(Json::parse(read_text(folder / "lights.json")),
              Json::parse(R"({"lights": [{"position": [1.0, 2.0, 3.0], "intensity": [4.0, 5.0, 6.5]}]})"));
    EXPECT_EQ(Json::parse(read_text(folder / "materials.json")), Json::parse(R"({"materials": [
        {"id": 1, "name": "floor", "kd": [0.25, 0.25, 0.25], "ks": [0.5, 0.5, 0.5], "alpha": 0.125},
        {"id": 2, "name": "wood", "kd": "texture", "ks": [0.0, 0.0, 0.0], "alpha": 1.0}]})"));
}

TEST(Truth, WhatIsWrittenReadsBackTheSame) {
    const TemporaryFolder folder;
    const std::vector<Light> lights{{{1, -2, 3}, {4, 0, 6.5}, 0.05}, {{0.1, 0.2, 0.3}, {1, 1, 1}, 0, {0, 0, -1}}};
    const std::vector<Material> materials{{1, "floor", glm::dvec3(0.1, 0.2, 1), glm::dvec3(0.5), 0.125},
                                          {65535, "wood", std::nullopt, glm::dvec3(0), 1}};
    write_lights(folder / "lights.json", lights);
    write_materials(folder / "materials.json", materials);
    const auto read = read_lights(folder / "lights.json");
    ASSERT_EQ(read.size(), 2u);
    for (size_t i = 0; i < read.size(); ++i) {
        EXPECT_EQ(read[i].position_m, lights[i].position_m);
        EXPECT_EQ(read[i].intensity, lights[i].intensity);
        EXPECT_EQ(read[i].radius_m, lights[i].radius_m);
        EXPECT_EQ(read[i].axis, lights[i].axis);
    }
    EXPECT_EQ(read_ambient(folder / "lights.json"), glm::dvec3(0));
    write_lights(folder / "lights.json", lights, {0.1, 0.2, 0.3});
    EXPECT_EQ(read_ambient(folder / "lights.json"), glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(read_lights(folder / "lights.json").size(), 2u);
    EXPECT_TRUE(read_windows(folder / "lights.json").empty());
    const std::vector<AreaLight> windows{{{1, 2, 3}, {0.5, 0, 0}, {0, 0, 0.25}, {3, 4, 5}, false},
                                         {{-1, 2, 3}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, true}};
    write_lights(folder / "lights.json", lights, {0.1, 0.2, 0.3}, windows);
    EXPECT_EQ(read_windows(folder / "lights.json"), windows);
    EXPECT_EQ(read_lights(folder / "lights.json").size(), 2u);
    const auto read_back = read_materials(folder / "materials.json");
    ASSERT_EQ(read_back.size(), 2u);
    for (size_t i = 0; i < read_back.size(); ++i) {
        EXPECT_EQ(read_back[i].id, materials[i].id);
        EXPECT_EQ(read_back[i].name, materials[i].name);
        EXPECT_EQ(read_back[i].kd, materials[i].kd);
        EXPECT_EQ(read_back[i].ks, materials[i].ks);
        EXPECT_EQ(read_back[i].alpha, materials[i].alpha);
    }
}

TEST(Truth, AnAxisIsReadWithUnitLength) {
    const TemporaryFolder folder;
    write_text(folder / "l.json",
               R"({"lights": [{"position": [1, 2, 3], "intensity": [1, 1, 1], "axis": [0, 3, -4]}]})");
    EXPECT_LT(glm::distance(read_lights(folder / "l.json").at(0).axis, {0, 0.6, -0.8}), 1e-12);
}

TEST(Truth, SaysWhatIsWrongInWindows) {
    const TemporaryFolder folder;
    const auto complaint = [&](const char* window) {
        write_text(folder / "l.json", std::string("{\"lights\": [], \"area\": [") + window + "]}");
        return error_of([&] { read_windows(folder / "l.json"); });
    };
    EXPECT_THAT(complaint("7"), EndsWith("area[0] is 7, must be an object"));
    EXPECT_THAT(complaint(R"({"center": [0, 0, 1]})"), EndsWith("area[0].half_u is missing"));
    EXPECT_THAT(complaint(R"({"center": [0, 0, 1], "half_u": [1, 0, 0], "half_v": [0, 1, 0], "radiance": [1, -1, 1]})"),
                EndsWith("area[0].radiance is [1,-1,1], must not be negative"));
    EXPECT_THAT(complaint(R"({"center": [0, 0, 1], "half_u": [1, 0, 0], "half_v": [2, 0, 0], "radiance": [1, 1, 1]})"),
                EndsWith("must have an area: half_u and half_v are 0, or parallel"));
}

TEST(Truth, SaysWhatIsWrongInLights) {
    const TemporaryFolder folder;
    const auto complaint = [&](const char* content) {
        write_text(folder / "l.json", content);
        return error_of([&] { read_lights(folder / "l.json"); });
    };
    EXPECT_THAT(error_of([&] { read_lights(folder / "none.json"); }), HasSubstr("none.json"));
    EXPECT_THAT(complaint("{\"lights\": [{]}"), HasSubstr("l.json is not valid JSON"));
    EXPECT_THAT(complaint("{}"), EndsWith("l.json: lights is missing"));
    EXPECT_THAT(complaint(R"({"lights": 3})"), EndsWith("l.json: lights is 3, must be an array"));
    EXPECT_THAT(complaint(R"({"lights": [7]})"), EndsWith("lights[0] is 7, must be an object"));
    EXPECT_THAT(complaint(R"({"lights": [{"position": [1, 2, 3]}]})"), EndsWith("lights[0].intensity is missing"));
    EXPECT_THAT(complaint(R"({"lights": [{"position": [1, 2], "intensity": [1, 1, 1]}]})"),
                EndsWith("lights[0].position is [1,2], must be an array of 3"));
    EXPECT_THAT(complaint(R"({"lights": [{"position": [1, 2, null], "intensity": [1, 1, 1]}]})"),
                EndsWith("lights[0].position[2] is null, must be a number"));
    EXPECT_THAT(complaint(R"({"lights": [{"position": [1, 2, 3], "intensity": [1, -1, 1]}]})"),
                EndsWith("lights[0].intensity is [1,-1,1], must not be negative"));
    EXPECT_THAT(complaint(R"({"lights": [{"position": [1, 2, 3], "intensity": [1, 1, 1], "axis": [0, 0, 0]}]})"),
                EndsWith("lights[0].axis is [0, 0, 0], which is no direction"));
    EXPECT_THAT(complaint(R"({"lights": [{"position": [1, 2, 6000], "intensity": [1, 1, 1], "axis": [0, 0, 1]}]})"),
                EndsWith("lights[0].axis is [0,0,1], must not be there: the lamp is a sun, 5 km away or farther"));
}

TEST(Truth, SaysWhatIsWrongInMaterials) {
    const TemporaryFolder folder;
    const auto complaint = [&](const char* from, const char* to) {
        write_text(folder / "m.json", R"({"materials": [
            {"id": 1, "name": "a", "kd": "texture", "ks": [0.5, 0.5, 0.5], "alpha": 0.1},
            {"id": 2, "name": "b", "kd": [0.2, 0.2, 0.2], "ks": [0, 0, 0], "alpha": 1}]})");
        replace_text(folder / "m.json", from, to);
        return error_of([&] { read_materials(folder / "m.json"); });
    };
    EXPECT_THAT(complaint("\"id\": 2", "\"id\": 1"), EndsWith("materials[1].id is 1, which is another material's"));
    EXPECT_THAT(complaint("\"id\": 2", "\"id\": 0"), HasSubstr("materials[1].id is 0, must be a positive"));
    EXPECT_THAT(complaint("texture", "wood"), HasSubstr("materials[0].kd is \"wood\", must be three numbers"));
    EXPECT_THAT(complaint("[0.2, 0.2, 0.2]", "[0.2, 1.2, 0.2]"), EndsWith("kd is [0.2,1.2,0.2], must lie in 0 to 1"));
    EXPECT_THAT(complaint("[0.5, 0.5, 0.5]", "[-0.5, 0.5, 0.5]"), HasSubstr("materials[0].ks is [-0.5,0.5,0.5]"));
    EXPECT_THAT(complaint("0.1}", "0}"), EndsWith("materials[0].alpha is 0, must lie above 0 and up to 1"));
    EXPECT_THAT(complaint("\"alpha\": 1}", "\"alpha\": 1.5}"), HasSubstr("materials[1].alpha is 1.5"));
}

}  // namespace
}  // namespace patina::sensor::truth_test
