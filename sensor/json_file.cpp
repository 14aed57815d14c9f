#include "sensor/json_file.h"

#include <limits>

#include "engine/core/error.h"
#include "sensor/text_file.h"

namespace patina::sensor {

JsonValue::JsonValue(std::string file, std::string key, nlohmann::json value)
    : file_(std::move(file)), key_(std::move(key)), value_(std::move(value)) {}

JsonValue JsonValue::read(const std::filesystem::path& file) {
    try {
        return {file.string(), "", nlohmann::json::parse(read_bytes(file))};
    } catch (const nlohmann::json::exception& error) {
        throw Error(file.string(), " is not valid JSON: ", error.what());
    }
}

std::optional<JsonValue> JsonValue::find(const std::string& key) const {
    if (!value_.is_object()) fail("must be an object");
    const auto member = value_.find(key);
    if (member == value_.end()) return std::nullopt;
    return JsonValue(file_, key_.empty() ? key : key_ + "." + key, *member);
}

JsonValue JsonValue::at(const std::string& key) const {
    std::optional<JsonValue> member = find(key);
    if (!member) throw Error(JsonValue(file_, key_.empty() ? key : key_ + "." + key, {}).where(), " is missing");
    return *member;
}

std::string JsonValue::string() const {
    if (!value_.is_string()) fail("must be a string");
    return value_.get<std::string>();
}

double JsonValue::number() const {
    if (!value_.is_number()) fail("must be a number");
    return value_.get<double>();
}

double JsonValue::positive() const {
    const double value = number();
    if (!(value > 0)) fail("must be positive");
    return value;
}

uint32_t JsonValue::positive_integer() const {
    const auto most = std::numeric_limits<uint32_t>::max();
    if (!value_.is_number_unsigned() || value_.get<uint64_t>() == 0 || value_.get<uint64_t>() > most) {
        fail("must be a positive whole number");
    }
    return value_.get<uint32_t>();
}

std::vector<double> JsonValue::numbers(size_t count) const {
    if (!value_.is_array() || value_.size() != count) fail(text("must be an array of ", count, " numbers"));
    std::vector<double> values;
    for (size_t i = 0; i < count; ++i) values.push_back(element(i).number());
    return values;
}

std::vector<JsonValue> JsonValue::elements() const {
    if (!value_.is_array()) fail("must be an array");
    std::vector<JsonValue> list;
    for (size_t i = 0; i < value_.size(); ++i) list.push_back(element(i));
    return list;
}

JsonValue JsonValue::element(size_t index) const { return {file_, text(key_, "[", index, "]"), value_[index]}; }

std::string JsonValue::where() const { return key_.empty() ? file_ : file_ + ": " + key_; }

void JsonValue::fail(const std::string& requirement) const {
    throw Error(where(), " is ", value_.dump(), ", ", requirement);
}

}  // namespace patina::sensor
