#include "python/choices.h"

#include <type_traits>
#include <utility>
#include <vector>

#include "patina/error.h"

namespace patina::python {

namespace {

template <class Value>
Value choice(const std::string& word, const char* name, const std::vector<std::pair<std::string, Value>>& words) {
    std::string known;
    for (const auto& [each, value] : words) {
        if (each == word) return value;
        known += (known.empty() ? "" : ", ") + each;
    }
    throw Error(name, " is '", word, "', must be one of: ", known);
}

LightingChoice from_word(const std::filesystem::path& path) {
    if (path.empty()) return LightsBeside{};
    if (path == "none") return NoLights{};
    if (path == "self") return LightsFromMain{};
    if (path.extension() == ".json") return LightsFromFile{path};
    return LightsFromSequence{path.string()};
}

}  // namespace

Labels to_labels(const std::string& word) {
    return choice<Labels>(word, "labels",
                          {{"geometry", Labels::kGeometry}, {"off", Labels::kOff}, {"truth", Labels::kTruth}});
}

Materials to_materials(const std::string& word) {
    return choice<Materials>(word, "materials",
                             {{"auto", Materials::kAuto},
                              {"fit", Materials::kFit},
                              {"hemicnn", Materials::kNetwork},
                              {"both", Materials::kBoth},
                              {"off", Materials::kOff},
                              {"truth", Materials::kTruth}});
}

Poses to_poses(const std::string& word) {
    return choice<Poses>(
        word, "poses",
        {{"auto", Poses::kAuto}, {"given", Poses::kGiven}, {"track", Poses::kTrack}, {"prior", Poses::kPrior}});
}

Gains to_gains(const std::string& word) {
    return choice<Gains>(word, "gains", {{"auto", Gains::kAuto}, {"on", Gains::kOn}, {"off", Gains::kOff}});
}

Detail to_detail(const std::string& word) {
    return choice<Detail>(
        word, "detail",
        {{"auto", Detail::kAuto}, {"fine", Detail::kFine}, {"normal", Detail::kNormal}, {"coarse", Detail::kCoarse}});
}

LightingChoice to_choice(const GivenLighting& given) {
    return std::visit(
        [](const auto& choice) -> LightingChoice {
            if constexpr (std::is_same_v<std::decay_t<decltype(choice)>, std::filesystem::path>)
                return from_word(choice);
            else
                return choice;
        },
        given);
}

}  // namespace patina::python
