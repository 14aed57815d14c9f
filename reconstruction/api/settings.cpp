#include "patina/settings.h"

#include "reconstruction/api/access.h"
#include "reconstruction/setting_table.h"

namespace patina {

struct Settings::State {
    ReconstructionSettings values;
};

Settings::Settings() : state_(std::make_unique<State>()) {}
Settings::~Settings() = default;
Settings::Settings(const Settings& other) : state_(std::make_unique<State>(*other.state_)) {}

Settings& Settings::operator=(const Settings& other) {
    *state_ = *other.state_;
    return *this;
}

void Settings::set(const std::string& key, const std::string& value) { set_setting(state_->values, key, value, ""); }

void Settings::load(const std::filesystem::path& file) { load_settings(state_->values, file); }

std::optional<std::string> Settings::get(const std::string& key) const {
    const nlohmann::ordered_json all = settings_json(state_->values);
    const auto found = all.find(key);
    return found == all.end() ? std::nullopt : std::optional(found->dump());
}

ReconstructionSettings& Access::values(Settings& settings) { return settings.state_->values; }
const ReconstructionSettings& Access::values(const Settings& settings) { return settings.state_->values; }

}  // namespace patina
