// Settings in files and in assignments.

#include <array>
#include <charconv>
#include <sstream>

#include <toml++/toml.h>

#include "engine/core/input_file.h"
#include "patina/error.h"
#include "reconstruction/setting_table.h"

namespace patina {

namespace {

/// A value as set_setting() reads it. Text that looks like a number stays in quotes, so that it is refused.
std::string text_of(const toml::node& node) {
    if (const auto word = node.value_exact<std::string>()) {
        const bool is_word = word->find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos;
        const bool is_flag = *word == "true" || *word == "false";
        return is_word && !is_flag ? *word : '"' + *word + '"';
    }
    if (const auto flag = node.value_exact<bool>()) return *flag ? "true" : "false";
    if (const auto whole = node.value_exact<int64_t>()) return std::to_string(*whole);
    if (const auto number = node.value_exact<double>()) {
        std::array<char, 64> buffer{};
        return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), *number).ptr};
    }
    std::ostringstream out;
    node.visit([&](const auto& value) { out << value; });
    return out.str();
}

}  // namespace

std::vector<std::string> load_settings(ReconstructionSettings& settings, const std::filesystem::path& file) {
    const std::vector<uint8_t> bytes = read_file(file, limits::kSettingsBytes);
    toml::table root;
    try {
        root = toml::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), file.string());
    } catch (const toml::parse_error& error) {
        throw Error(file.string(), ", line ", error.source().begin.line, ": ", error.description());
    }
    std::vector<std::string> keys;
    for (const auto& [table_name, table] : root) {
        const std::string prefix(table_name.str());
        if (!table.is_table()) throw Error(file.string(), ": '", prefix, "' is not a table of settings");
        for (const auto& [name, node] : *table.as_table()) {
            keys.push_back(prefix + '.' + std::string(name.str()));
            set_setting(settings, keys.back(), text_of(node), file.string());
        }
    }
    return keys;
}

std::string apply_setting(ReconstructionSettings& settings, const std::string& assignment, const std::string& where) {
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw Error(where, ": '", assignment, "' has no '=' between key and value");
    std::string key = assignment.substr(0, equals);
    set_setting(settings, key, assignment.substr(equals + 1), where);
    return key;
}

nlohmann::ordered_json settings_json(const ReconstructionSettings& settings) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const SettingDescriptor& setting : setting_descriptors()) {
        const std::optional<std::string> value = get_setting(settings, setting.key);
        if (!value) continue;
        switch (setting.type) {
            // Floats as they are written: 0.005, not the double nearest to the float.
            case SettingType::kNumber: json[setting.key] = std::stod(*value); break;
            case SettingType::kWhole: json[setting.key] = std::stoull(*value); break;
            case SettingType::kFlag: json[setting.key] = *value == "true"; break;
            case SettingType::kWord: json[setting.key] = *value; break;
        }
    }
    return json;
}

}  // namespace patina
