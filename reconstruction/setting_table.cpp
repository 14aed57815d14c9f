#include "reconstruction/setting_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <locale>
#include <sstream>
#include <string_view>

#include "engine/core/did_you_mean.h"
#include "patina/error.h"
#include "reconstruction/setting_rows.h"

namespace patina {

namespace {

constexpr std::array<std::string_view, 2> kTests = {"all", "depth"};  // by KeyframeTests

/// The shortest text that reads as the same number; digits alone where these are few.
template <class Number>
std::string shown(Number number) {
    std::array<char, 64> buffer{};
    char* const first = buffer.data();
    char* const last = first + buffer.size();
    const bool digits = number == std::floor(number) && std::abs(number) < Number{1e16f};
    const auto end = digits ? std::to_chars(first, last, static_cast<int64_t>(number))
                            : std::to_chars(first, last, number, std::chars_format::general);
    return {first, end.ptr};
}

/// Text of the value at a place; empty where the part is off.
struct ShowValue {
    std::string operator()(std::monostate) const { return {}; }
    std::string operator()(const bool* flag) const { return *flag ? "true" : "false"; }
    std::string operator()(const float* number) const { return shown(*number); }
    std::string operator()(const uint32_t* number) const { return std::to_string(*number); }
    std::string operator()(const uint64_t* number) const { return std::to_string(*number); }
    std::string operator()(const KeyframeTests* tests) const {
        return std::string(kTests[static_cast<size_t>(*tests)]);
    }
};

struct TypeOfValue {
    SettingType operator()(std::monostate) const { return SettingType::kFlag; }
    SettingType operator()(const bool*) const { return SettingType::kFlag; }
    SettingType operator()(const float*) const { return SettingType::kNumber; }
    SettingType operator()(const uint32_t*) const { return SettingType::kWhole; }
    SettingType operator()(const uint64_t*) const { return SettingType::kWhole; }
    SettingType operator()(const KeyframeTests*) const { return SettingType::kWord; }
};

/// Stores a number that fits the place's type; a word by its place in SettingDescriptor::words.
struct StoreValue {
    double number;
    void operator()(std::monostate) const {}
    template <class Value>
    void operator()(Value* value) const {
        *value = static_cast<Value>(number);
    }
    void operator()(bool* flag) const { *flag = number != 0; }
    void operator()(KeyframeTests* tests) const { *tests = static_cast<KeyframeTests>(static_cast<uint8_t>(number)); }
};

std::vector<SettingDescriptor> described() {
    ReconstructionSettings defaults;
    std::vector<SettingDescriptor> settings;
    for (const SettingRow& row : setting_rows()) {
        const SettingPlace place = row.place(defaults, true);
        SettingDescriptor setting{row.key,      row.unit, std::visit(TypeOfValue{}, place),
                                  row.min,      row.max,  std::visit(ShowValue{}, place),
                                  row.sentence, row.note, {}};
        if (setting.type == SettingType::kWord) setting.words.assign(kTests.begin(), kTests.end());
        settings.push_back(std::move(setting));
    }
    return settings;
}

/// What may be meant by a key that there is not: the most similar one, else all there are.
std::string instead_of(const std::string& key) {
    std::vector<std::string> keys;
    for (const SettingRow& row : setting_rows()) keys.emplace_back(row.key);
    if (const std::string meant = did_you_mean(key, keys); !meant.empty()) return meant;
    std::string list;
    for (const std::string& known : keys) list += (list.empty() ? "; known are " : ", ") + known;
    return list;
}

std::string beginning(const std::string& where) { return where.empty() ? "" : where + ": "; }

size_t index_of(const std::string& key, const std::string& where) {
    const auto rows = setting_rows();
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const SettingRow& r) { return key == r.key; });
    if (row == rows.end()) throw Error(beginning(where), "there is no setting '", key, "'", instead_of(key));
    return static_cast<size_t>(row - rows.begin());
}

std::optional<double> number_of(const std::string& text) {
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    double number = 0;
    if (in >> number && in.peek() == std::char_traits<char>::eof()) return number;
    return std::nullopt;
}

/// The number that is stored for a text (StoreValue); empty where the setting does not allow it.
std::optional<double> parsed(const SettingDescriptor& setting, const std::string& text) {
    if (setting.type == SettingType::kWord) {
        const auto word = std::find(setting.words.begin(), setting.words.end(), text);
        if (word == setting.words.end()) return std::nullopt;
        return static_cast<double>(word - setting.words.begin());
    }
    const std::optional<double> number = number_of(text);
    if (setting.type == SettingType::kFlag) {
        if (text == "true" || number == 1) return 1;
        if (text == "false" || number == 0) return 0;
        return std::nullopt;
    }
    if (!number || !(*number >= setting.min && *number <= setting.max)) return std::nullopt;
    if (setting.type == SettingType::kWhole && *number != std::floor(*number)) return std::nullopt;
    return number;
}

}  // namespace

std::span<const SettingDescriptor> setting_descriptors() {
    static const std::vector<SettingDescriptor> settings = described();
    return settings;
}

std::string range_of(const SettingDescriptor& setting) {
    if (setting.type == SettingType::kFlag) return "true or false";
    if (setting.type != SettingType::kWord) return shown(setting.min) + " to " + shown(setting.max);
    std::string range;
    for (const std::string& word : setting.words) range += (range.empty() ? "" : " or ") + word;
    return range;
}

std::string allowed_values(const SettingDescriptor& setting) {
    const std::string range = range_of(setting) + (setting.unit.empty() ? "" : ' ' + setting.unit);
    if (setting.type == SettingType::kNumber) return "a number from " + range;
    if (setting.type == SettingType::kWhole) return "a whole number from " + range;
    return range;
}

void set_setting(ReconstructionSettings& settings, const std::string& key, const std::string& text,
                 const std::string& where) {
    const size_t index = index_of(key, where);
    const SettingDescriptor& setting = setting_descriptors()[index];
    const std::optional<double> number = parsed(setting, text);
    if (!number) {
        const std::string quote = number_of(text) ? "" : "'";
        throw Error(beginning(where), key, " is ", quote, text, quote, ", it must be ", allowed_values(setting));
    }
    std::visit(StoreValue{*number}, setting_rows()[index].place(settings, true));
}

std::optional<std::string> get_setting(const ReconstructionSettings& settings, const std::string& key) {
    const SettingRow& row = setting_rows()[index_of(key, "settings")];
    // Nothing is written: the place is only read, and no part is turned on.
    const SettingPlace place = row.place(const_cast<ReconstructionSettings&>(settings), false);
    if (std::holds_alternative<std::monostate>(place)) return std::nullopt;
    return std::visit(ShowValue{}, place);
}

}  // namespace patina
