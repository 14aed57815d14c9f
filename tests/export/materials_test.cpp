#include "export/materials.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace patina {
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
        {"id": 3, "voxels": 2, "observations": 0, "confidence": 0.0}]})"));
    EXPECT_EQ(text.find("19999"), std::string::npos) << "floats are written as they are meant: " << text;
}

TEST(Materials, OfNothingAreAnEmptyList) {
    EXPECT_EQ(nlohmann::json::parse(materials_json({}, {})), nlohmann::json::parse(R"({"materials": []})"));
}

}  // namespace
}  // namespace patina
