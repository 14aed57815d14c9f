#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "patina/session.h"

namespace patina::python {

/// A choice by its word, such as "geometry". Throws Error for another word, with those that there are.
Labels to_labels(const std::string& word);
Materials to_materials(const std::string& word);
Poses to_poses(const std::string& word);
Gains to_gains(const std::string& word);

/// What `lighting=` may be. A path or word is short for one of the classes: "" is LightsBeside, "none" NoLights, "self"
/// LightsFromMain, a path that ends in .json LightsFromFile, any other path LightsFromSequence.
using GivenLighting = std::variant<std::filesystem::path, LightsBeside, NoLights, LightsFromFile, LightsFromSequence,
                                   LightsFromMain, Lighting>;
LightingChoice to_choice(const GivenLighting& given);

}  // namespace patina::python
