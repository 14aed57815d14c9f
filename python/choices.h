#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "patina/session.h"

namespace patina::python {

/// A choice by its word, such as "geometry". Throws Error for another word, with those that there are.
Labels to_labels(const std::string& word);
Materials to_materials(const std::string& word);
Poses to_poses(const std::string& word);
Gains to_gains(const std::string& word);
Detail to_detail(const std::string& word);

/// Takes over the choices that a session and a reconstruction have in common.
template <class Options>
void set_choices(Options& options, const std::string& labels, const std::string& materials, const std::string& poses,
                 const std::string& gains, const std::filesystem::path& network, std::optional<uint64_t> seed,
                 const std::optional<Settings>& settings) {
    options.labels = to_labels(labels);
    options.materials = to_materials(materials);
    options.poses = to_poses(poses);
    options.gains = to_gains(gains);
    options.network = network;
    options.seed = seed;
    if (settings) options.settings = *settings;
}

/// What `lighting=` may be. A path or word is short for one of the classes: "" is LightsBeside, "none" NoLights, "self"
/// LightsFromMain, a path that ends in .json LightsFromFile, any other path LightsFromSequence.
using GivenLighting = std::variant<std::filesystem::path, LightsBeside, NoLights, LightsFromFile, LightsFromSequence,
                                   LightsFromMain, Lighting>;
LightingChoice to_choice(const GivenLighting& given);

}  // namespace patina::python
