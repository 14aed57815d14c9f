// docs/settings.md, printed from the table of settings.

#include <algorithm>
#include <string>
#include <vector>

#include "reconstruction/setting_table.h"

namespace patina {

namespace {

constexpr const char* kIntroduction = R"(# Settings

`patina settings --markdown` prints this page. A setting is given as `--set KEY=VALUE`, or in a TOML file that
`--settings FILE` names. The part of a key before the dot is the file's table:

```toml
[fusion]
max_depth_m = 3
```

`run.json` repeats the settings of a run under the same keys. A value of another type or outside its range is refused.
)";

/// When a table's settings matter; empty: always.
std::string condition_of(const std::string& table) {
    if (table == "segmentation") return "Segments of the map; without them (`--labels off`) these settings do nothing.";
    if (table == "gains") return "Exposure and white balance of each frame (`--gains`).";
    if (table == "reflectance" || table == "observe") return "Needs lights; without them these settings do nothing.";
    if (table == "tracking") return "Needed where poses are not given (`--poses`).";
    if (table == "keyframes") return "How a lost camera is found again, where poses are tracked.";
    if (table == "specular") return "Needs lights and segments (`--specular`).";
    return "";
}

std::string table_of(const SettingDescriptor& setting) { return setting.key.substr(0, setting.key.find('.')); }

const char* name_of(SettingType type) {
    switch (type) {
        case SettingType::kNumber: return "number";
        case SettingType::kWhole: return "whole number";
        case SettingType::kFlag: return "flag";
        case SettingType::kWord: return "word";
    }
    return "";
}

std::string row_of(const SettingDescriptor& setting) {
    return "| `" + setting.key + "` | " + setting.default_value + " | " + setting.unit + " | " + name_of(setting.type) +
           " | " + range_of(setting) + " | " + setting.sentence + (setting.note.empty() ? "" : " " + setting.note) +
           " |\n";
}

}  // namespace

std::string settings_page() {
    std::vector<std::string> tables;
    for (const SettingDescriptor& setting : setting_descriptors()) {
        const std::string table = table_of(setting);
        if (std::find(tables.begin(), tables.end(), table) == tables.end()) tables.push_back(table);
    }
    std::string page = kIntroduction;
    for (const std::string& table : tables) {
        page += "\n## " + table + "\n\n";
        if (const std::string condition = condition_of(table); !condition.empty()) page += condition + "\n\n";
        page += "| key | default | unit | type | range | what it does |\n| --- | --- | --- | --- | --- | --- |\n";
        for (const SettingDescriptor& setting : setting_descriptors())
            if (table_of(setting) == table) page += row_of(setting);
    }
    return page;
}

}  // namespace patina
