#include "patina/settings.h"

#include <set>

#include "reconstruction/api/access.h"
#include "reconstruction/setting_table.h"

namespace patina {

struct Settings::State {
    ReconstructionSettings values;
    std::set<std::string> given;
};

Settings::Settings() : state_(std::make_unique<State>()) {}
Settings::~Settings() = default;
Settings::Settings(const Settings& other) : state_(std::make_unique<State>(*other.state_)) {}

Settings& Settings::operator=(const Settings& other) {
    *state_ = *other.state_;
    return *this;
}

void Settings::set(const std::string& key, const std::string& value) {
    set_setting(state_->values, key, value, "");
    state_->given.insert(key);
}

void Settings::load(const std::filesystem::path& file) {
    for (std::string& key : load_settings(state_->values, file)) state_->given.insert(std::move(key));
}

std::optional<std::string> Settings::get(const std::string& key) const {
    const nlohmann::ordered_json all = settings_json(state_->values);
    const auto found = all.find(key);
    return found == all.end() ? std::nullopt : std::optional(found->dump());
}

ReconstructionSettings& Access::values(Settings& settings) { return settings.state_->values; }
const ReconstructionSettings& Access::values(const Settings& settings) { return settings.state_->values; }

void Access::assign(Settings& settings, const std::string& assignment, const std::string& where) {
    settings.state_->given.insert(apply_setting(settings.state_->values, assignment, where));
}

bool Access::is_given(const Settings& settings, const std::string& key) { return settings.state_->given.contains(key); }

}  // namespace patina
