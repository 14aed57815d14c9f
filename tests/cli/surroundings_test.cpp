#include <cmath>
#include <fstream>
#include <numbers>

#include <glm/glm.hpp>

#include "patina/lighting.h"
#include "patina/session.h"
#include "tests/cli/run_folder.h"

// A room of which nothing tells the lamps: no file, no lighting sequence. A lamp under the ceiling, that no picture
// shows, lights it.

namespace patina::testing::surroundings_test {
namespace {

using nlohmann::json;

/// One wall of a box, or its floor or ceiling.
json rectangle(const char* name, const json& kd, const json& extent_m, const json& at_m, const json& axis,
               double degrees) {
    const json turned = {{"axis", axis}, {"degrees", degrees}};
    const json part = {{"rectangle", {{"size", extent_m}}}, {"position", at_m}, {"rotations", json::array({turned})}};
    return {{"name", name}, {"material", {{"kd", kd}, {"ks", 0.02}, {"alpha", 0.4}}}, {"parts", json::array({part})}};
}

json walls() {
    const json plaster = {0.62, 0.6, 0.56}, floor_m = {3, 3}, wall_m = {3, 2.4}, x = {1, 0, 0}, y = {0, 1, 0};
    return {rectangle("floor", {0.3, 0.25, 0.2}, floor_m, {0, 0, 0}, x, 90),
            rectangle("ceiling", {0.75, 0.75, 0.74}, floor_m, {0, -2.4, 0}, x, -90),
            rectangle("west", plaster, wall_m, {-1.5, -1.2, 0}, y, -90),
            rectangle("east", {0.2, 0.32, 0.36}, wall_m, {1.5, -1.2, 0}, y, 90),
            rectangle("south", plaster, wall_m, {0, -1.2, -1.5}, y, 180),
            rectangle("north", plaster, wall_m, {0, -1.2, 1.5}, y, 0)};
}

/// Once round in 24 frames, looking at the walls from the other side of the room.
json path() {
    json waypoints = json::array();
    for (int i = 0; i < 8; ++i) {
        const double turn = i * std::numbers::pi / 4, x = std::sin(turn), z = std::cos(turn);
        waypoints.push_back({{"position", {-0.5 * x, -1.3, -0.5 * z}}, {"target", {1.4 * x, -1, 1.4 * z}}});
    }
    return {{"tour", {{"period_s", 0.8}, {"waypoints", waypoints}}}};
}

const glm::dvec3 kLamp_m(0.4, -2.1, 0.2);
constexpr double kIntensity = 4.8;

class Surroundings : public RunFolderTest {
  protected:
    Surroundings() {
        const json lamp = {{"position", {kLamp_m.x, kLamp_m.y, kLamp_m.z}},
                           {"intensity", {kIntensity, kIntensity, kIntensity}},
                           {"radius", 0.06}};
        const json scene = {
            {"name", "room"},
            {"fps", 30},
            {"camera", {{"width", 512}, {"height", 424}, {"fx", 300}, {"fy", 300}, {"cx", 255.5}, {"cy", 211.5}}},
            {"objects", walls()},
            {"lights", json::array({lamp})},
            {"path", path()},
            {"recording", {{"shadows", true}, {"bounces", 3}}}};
        std::ofstream(beside("room.json")) << scene;
        const Outcome synth = patina({"synth", beside("room.json"), "--frames", "24", "--extent", "128x106",
                                      "--samples", "2", "--truth-every", "100", "--out", room(), "--quiet"});
        EXPECT_EQ(synth.exit_code, 0) << synth.err;
    }

    std::string room() const { return beside("room"); }
};

// All 24 frames tell of it, and not yet the first 16.
TEST_F(Surroundings, ALampIsFoundInWhatItLightsByTheProgramAndTheLibrary) {
    const json summary =
        run_quietly(room(), {"--texture", "off", "--set", "map.voxel_m=0.02", "--set", "fusion.truncation_m=0.06"});
    EXPECT_EQ(summary["lights"]["found_by"], "surroundings");
    ASSERT_EQ(summary["lights"]["lamps"].size(), 1u);
    EXPECT_EQ(summary["lights"]["lamps"][0]["unseen"], true);
    const Lighting found = read_lighting(out() / "lights.json");
    EXPECT_LT(glm::distance(found.lights[0].position_m, kLamp_m), 0.3);
    EXPECT_NEAR(found.lights[0].intensity.g, kIntensity, 0.3 * kIntensity);
    EXPECT_LT(found.ambient.g, 0.4) << "before it was found, 0.74 was assumed";
    EXPECT_EQ(summary["settings"]["specular"], "both") << "its highlights are looked at";
    EXPECT_FALSE(summary.contains("materials_missing"));

    SessionOptions options;
    options.sequence = room();
    for (const auto& [key, value] : {std::pair{"map.voxel_m", "0.02"}, {"fusion.truncation_m", "0.06"}})
        options.settings.set(key, value);
    Device device;
    Session session(device, options);
    while (session.step()) continue;
    EXPECT_TRUE(session.lighting().lights.empty());
    for (const bool again : {false, true}) {
        const Scene scene = session.finish();
        ASSERT_EQ(scene.lighting.lights.size(), 1u) << again;
        const Light& lamp = scene.lighting.lights[0];
        EXPECT_LT(glm::distance(lamp.position_m, found.lights[0].position_m), 1e-5) << again;  // the file rounds
        EXPECT_LT(glm::distance(lamp.intensity, found.lights[0].intensity), 1e-5) << again;
    }
}

}  // namespace
}  // namespace patina::testing::surroundings_test
