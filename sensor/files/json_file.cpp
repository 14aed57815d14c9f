#include "sensor/files/json_file.h"

#include <algorithm>
#include <limits>
#include <set>

#include "engine/core/error.h"
#include "engine/core/input_file.h"

namespace patina::sensor {
namespace {

using nlohmann::json;

/// nlohmann's messages begin with "[json.exception.NAME.NUMBER] ".
std::string message_of(const json::exception& error) {
    const std::string message = error.what();
    const size_t end = message.find("] ");
    return end == std::string::npos ? message : message.substr(end + 2);
}

/// Reads a document without keeping it, and throws Error where it is none. json::parse() keeps the last of two equal
/// keys and does not tell where a number is too large; with a callback, its time is quadratic in an array's length.
class Checker : public nlohmann::json_sax<json> {
  public:
    explicit Checker(const std::string& file) : file_(file) {}

    bool null() override { return value(); }
    bool boolean(bool) override { return value(); }
    bool number_integer(number_integer_t) override { return value(); }
    bool number_unsigned(number_unsigned_t) override { return value(); }
    bool number_float(number_float_t, const string_t&) override { return value(); }
    bool string(string_t&) override { return value(); }
    bool binary(binary_t&) override { return value(); }
    bool start_object(std::size_t) override { return start(false); }
    bool start_array(std::size_t) override { return start(true); }
    bool end_object() override { return end(); }
    bool end_array() override { return end(); }

    bool key(string_t& key) override {
        levels_.back().key = key;
        if (!levels_.back().keys.insert(key).second) throw Error(file_, ": ", key_path(), " is there twice");
        return true;
    }

    bool parse_error(std::size_t, const std::string&, const json::exception& error) override {
        const bool out_of_range = dynamic_cast<const json::out_of_range*>(&error) != nullptr;
        throw Error(file_, " is not valid JSON: ", out_of_range ? key_path() + ": " : "", message_of(error));
    }

  private:
    struct Level {
        bool is_array;
        size_t elements = 0;  ///< that are complete
        std::string key{};    ///< the latest
        std::set<std::string> keys{};
    };

    /// "lights[2].radius"
    std::string key_path() const {
        std::string path;
        for (const Level& level : levels_) {
            if (level.is_array) {
                path += text("[", level.elements, "]");
            } else {
                path += (path.empty() ? "" : ".") + level.key;
            }
        }
        return path;
    }

    bool start(bool is_array) {
        levels_.push_back({.is_array = is_array});
        return true;
    }

    bool end() {
        levels_.pop_back();
        return value();
    }

    bool value() {
        if (!levels_.empty()) ++levels_.back().elements;
        return true;
    }

    const std::string& file_;
    std::vector<Level> levels_;
};

json parse_json(const std::string& file, std::span<const uint8_t> bytes) {
    check_json_depth(file, bytes);
    Checker checker(file);
    json::sax_parse(bytes.begin(), bytes.end(), &checker);
    return json::parse(bytes.begin(), bytes.end());
}

}  // namespace

JsonValue::JsonValue(std::shared_ptr<const std::string> file, std::string key, std::shared_ptr<const json> value)
    : file_(std::move(file)), key_(std::move(key)), value_(std::move(value)) {}

JsonValue JsonValue::part(std::string key, const json& value) const {
    return {file_, std::move(key), std::shared_ptr<const json>(value_, &value)};
}

std::string JsonValue::key_of(const std::string& member) const { return key_.empty() ? member : key_ + "." + member; }

JsonValue JsonValue::read(const std::filesystem::path& file) {
    return parse(file.string(), read_file(file, limits::kTextBytes));
}

JsonValue JsonValue::parse(const std::string& file, std::span<const uint8_t> bytes) {
    return {std::make_shared<std::string>(file), "", std::make_shared<json>(parse_json(file, bytes))};
}

std::optional<JsonValue> JsonValue::find(const std::string& key) const {
    if (!value_->is_object()) fail("must be an object");
    const auto member = value_->find(key);
    if (member == value_->end()) return std::nullopt;
    return part(key_of(key), *member);
}

JsonValue JsonValue::patched(const JsonValue& changes) const {
    for (const JsonValue* value : {this, &changes})
        if (!value->is_object()) value->fail("must be an object");
    auto document = std::make_shared<json>(*value_);
    document->merge_patch(*changes.value_);
    return {changes.file_, "", std::move(document)};
}

JsonValue JsonValue::at(const std::string& key) const {
    std::optional<JsonValue> member = find(key);
    if (!member) throw Error(part(key_of(key), *value_).where(), " is missing");
    return *member;
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::members() const {
    if (!value_->is_object()) fail("must be an object");
    std::vector<std::pair<std::string, JsonValue>> members;
    for (const auto& [key, value] : value_->items()) members.emplace_back(key, part(key_of(key), value));
    return members;
}

void JsonValue::expect_keys(const std::vector<std::string>& known) const {
    for (const auto& [key, value] : members()) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        std::string list;
        for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
        value.fail("an unknown key; known are: " + list);
    }
}

std::vector<JsonValue> JsonValue::elements() const {
    if (!value_->is_array()) fail("must be an array");
    std::vector<JsonValue> elements;
    for (size_t i = 0; i < value_->size(); ++i) elements.push_back(part(text(key_, "[", i, "]"), (*value_)[i]));
    return elements;
}

std::vector<JsonValue> JsonValue::elements_of(size_t count) const {
    if (!value_->is_array() || value_->size() != count) fail(text("must be an array of ", count));
    return elements();
}

std::string JsonValue::string() const {
    if (!value_->is_string()) fail("must be a string");
    return value_->get<std::string>();
}

bool JsonValue::boolean() const {
    if (!value_->is_boolean()) fail("must be true or false");
    return value_->get<bool>();
}

double JsonValue::number() const {
    if (!value_->is_number()) fail("must be a number");
    return value_->get<double>();
}

double JsonValue::positive() const {
    const double value = number();
    if (!(value > 0)) fail("must be positive");
    return value;
}

double JsonValue::not_negative() const {
    const double value = number();
    if (!(value >= 0)) fail("must not be negative");
    return value;
}

double JsonValue::number_within(double low, double high) const {
    const double value = number();
    if (!(value >= low && value <= high)) fail(text("must be from ", low, " to ", high));
    return value;
}

uint32_t JsonValue::positive_integer() const {
    const auto most = std::numeric_limits<uint32_t>::max();
    if (!value_->is_number_unsigned() || value_->get<uint64_t>() == 0 || value_->get<uint64_t>() > most) {
        fail("must be a positive whole number");
    }
    return value_->get<uint32_t>();
}

uint64_t JsonValue::whole_number(uint64_t most) const {
    if (!value_->is_number_unsigned() || value_->get<uint64_t>() > most) {
        fail(text("must be a whole number from 0 to ", most));
    }
    return value_->get<uint64_t>();
}

std::vector<double> JsonValue::numbers(size_t count) const {
    std::vector<double> values;
    for (const JsonValue& element : elements_of(count)) values.push_back(element.number());
    return values;
}

std::string JsonValue::where() const { return key_.empty() ? *file_ : *file_ + ": " + key_; }

void JsonValue::fail(const std::string& requirement) const {
    constexpr size_t kLongest = 100;
    std::string value = value_->dump();
    if (value.size() > kLongest) value = value.substr(0, kLongest) + " ...";
    throw Error(where(), " is ", value, ", ", requirement);
}

}  // namespace patina::sensor
