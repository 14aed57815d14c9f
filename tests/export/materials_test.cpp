#include "export/materials.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace patina::materials_test {
namespace {

TEST(Materials, TellWhatIsKnownOfEverySegmentThatWasSeen) {
    std::vector<SegmentReflectance> segments(4);
    segments[1] = {glm::vec3(0.25f, 0.5f, 0.12344f), WardGloss{glm::vec3(0.125f), 0.2f}, 1200, 20000, 0.75f};
    segments[2].gloss = WardGloss{};  // never seen
    segments[3].voxels = 2;
    const std::vector<std::string> names{"", "floor"};
    const std::string text = materials_json(segments, names);
    EXPECT_EQ(nlohmann::json::parse(text), nlohmann::json::parse(R"({"materials": [
        {"id": 1, "name": "floor", "kd": [0.25, 0.5, 0.1234], "ks": [0.125, 0.125, 0.125], "alpha": 0.2,
         "voxels": 1200, "observations": 20000, "confidence": 0.75},
        {"id": 3, "gloss": "not observed", "voxels": 2, "observations": 0, "confidence": 0.0}]})"));
    EXPECT_EQ(text.find("19999"), std::string::npos) << "floats are written as they are meant: " << text;
}

TEST(Materials, IntervalsStandBesideWhatTheyAreOf) {
    std::vector<SegmentReflectance> segments(3);
    segments[1] = {glm::vec3(0.5f), WardGloss{glm::vec3(0.125f), 0.2f, 0.75f}, 12, 20, 0.5f};
    segments[1].intervals.emplace();
    (*segments[1].intervals)[kIntervalLevel] = {glm::vec3(0.25f, 0.3f, 0.4f),  glm::vec3(0.75f), glm::vec3(0),
                                                glm::vec3(0.25f, 0.2f, 0.15f), 0.125f,           0.25f};
    segments[2] = segments[1];
    segments[2].kd.reset();
    const auto json = nlohmann::json::parse(materials_json(segments, {}));
    const auto& known = json["materials"][0];
    EXPECT_EQ(known["interval"], nlohmann::json::parse(R"({"kd": [[0.25, 0.75], [0.3, 0.75], [0.4, 0.75]],
        "ks": [[0, 0.25], [0, 0.2], [0, 0.15]], "alpha": [0.125, 0.25]})"));
    for (const char* key : {"interval_50", "interval_80", "interval_95"}) EXPECT_TRUE(known.contains(key)) << key;
    EXPECT_FALSE(json["materials"][1]["interval"].contains("kd")) << "as long as kd is not known";
}

TEST(Materials, AGuessIsNotTakenForWhatWasObserved) {
    std::vector<SegmentReflectance> segments(2);
    segments[1] = {glm::vec3(0.5f), WardGloss{glm::vec3(0.04f), 0.25f, 0.125f}, 12, 20, 0.5f};
    const auto json = nlohmann::json::parse(materials_json(segments, {}));
    EXPECT_EQ(json["materials"][0], nlohmann::json::parse(R"({"id": 1, "kd": [0.5, 0.5, 0.5],
        "gloss": "not observed", "guess": {"ks": [0.04, 0.04, 0.04], "alpha": 0.25}, "specular_confidence": 0.125,
        "voxels": 12, "observations": 20, "confidence": 0.5})"));
}

TEST(Materials, OfNothingAreAnEmptyList) {
    EXPECT_EQ(nlohmann::json::parse(materials_json({}, {})), nlohmann::json::parse(R"({"materials": []})"));
}

}  // namespace
}  // namespace patina::materials_test
