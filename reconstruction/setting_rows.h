#pragma once

#include <span>
#include <string_view>
#include <variant>

#include "reconstruction/pipeline.h"
#include "reconstruction/setting_table.h"

namespace patina {

/// A setting's place in the structs; monostate where its part is off.
using SettingPlace = std::variant<std::monostate, float*, uint32_t*, uint64_t*, bool*, KeyframeTests*>;

/// One row of the table of settings; its default value is what a default-constructed struct holds.
struct SettingRow {
    const char* key;
    const char* unit;
    double min;  ///< inclusive; of numbers alone
    double max;
    const char* sentence;
    const char* note;
    /// Where the value is. `create` turns the part on that it belongs to.
    SettingPlace (*place)(ReconstructionSettings& settings, bool create);
    std::string_view owner;  ///< a name for the struct that holds it
};

/// The table.
std::span<const SettingRow> setting_rows();

}  // namespace patina
