#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "reconstruction/pipeline.h"

namespace patina {

enum class SettingType {
    kNumber,  ///< floating point
    kWhole,   ///< whole number
    kFlag,    ///< true or false; 1 and 0 are read, too
    kWord     ///< one of SettingDescriptor::words
};

/// One setting of a reconstruction, as TOML files, `--set`, run.json, Python and docs/settings.md know it.
struct SettingDescriptor {
    std::string key;   ///< "fusion.max_depth_m": table and name of the TOML file
    std::string unit;  ///< "m", "px", "degrees", ...; empty: none
    SettingType type = SettingType::kNumber;
    double min = 0;  ///< inclusive; numbers alone have a range
    double max = 0;  ///< inclusive
    std::string default_value;
    std::string sentence;            ///< what it does
    std::string note;                ///< how the default was found, where users should know; else empty
    std::vector<std::string> words;  ///< that a kWord can be
};

/// All settings, in the order of run.json.
std::span<const SettingDescriptor> setting_descriptors();

/// Sets one setting from text, such as "0.005", "true" or "depth". The optional part that it belongs to comes into
/// being. Throws Error, beginning with `where` unless it is empty, for an unknown key, with the nearest one, and for a
/// value of another type or out of its range; the settings stay as they are then.
void set_setting(ReconstructionSettings& settings, const std::string& key, const std::string& text,
                 const std::string& where);

/// A setting as set_setting() reads it, exactly; empty where the optional part that it belongs to is off. Throws Error
/// for an unknown key.
std::optional<std::string> get_setting(const ReconstructionSettings& settings, const std::string& key);

/// Overrides settings from a TOML file, whose tables are the parts of keys before the dot. Throws Error naming the
/// file, the key, and what is wrong. Returns the keys.
std::vector<std::string> load_settings(ReconstructionSettings& settings, const std::filesystem::path& file);

/// Overrides one setting from "fusion.max_depth_m=3". Throws Error as set_setting() does. Returns the key.
std::string apply_setting(ReconstructionSettings& settings, const std::string& assignment, const std::string& where);

/// The settings of all parts that are on by their keys, in the order of setting_descriptors().
nlohmann::ordered_json settings_json(const ReconstructionSettings& settings);

/// The values of a setting: "0 to 90", "true or false", "all or depth".
std::string range_of(const SettingDescriptor& setting);

/// The values with their type and unit, for messages: "a number from 0 to 90 degrees", "true or false".
std::string allowed_values(const SettingDescriptor& setting);

/// docs/settings.md: a page with all settings in Markdown.
std::string settings_page();

}  // namespace patina
