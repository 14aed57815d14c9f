#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace patina {

/// One setting of a reconstruction, as TOML files, `--set`, run.json and Python know it.
struct SettingDescriptor;

/// All settings of a reconstruction, by their keys. A copy is a copy of the values. docs/settings.md lists them.
class Settings {
  public:
    Settings();
    ~Settings();
    Settings(const Settings& other);
    Settings& operator=(const Settings& other);

    /// Sets one value: set("fusion.max_depth_m", "3"). Throws Error for a key that there is not, with the one that is
    /// nearest, and for a value of another kind or outside its range.
    void set(const std::string& key, const std::string& value);

    /// Sets all values of a TOML file, whose tables are the parts of the keys before the dot. Throws Error as set()
    /// does, and when the file cannot be read.
    void load(const std::filesystem::path& file);

    /// A value as it would be set. Empty where the part that it belongs to is off. Throws Error for a key that there is
    /// not.
    std::optional<std::string> get(const std::string& key) const;

  private:
    friend struct Access;
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace patina
