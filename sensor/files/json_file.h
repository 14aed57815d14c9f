#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace patina::sensor {

/// A value in a JSON file that knows its file and key path, so that every error names both:
/// "x/sequence.json: depth.fx is -3, must be positive". Copies are cheap.
class JsonValue {
  public:
    /// Parses a file. Throws Error when it is missing or no JSON, when an object has the same key twice, or when a
    /// number is too large for a double.
    static JsonValue read(const std::filesystem::path& file);

    /// Parses what is no file of its own, but for example the part of one; `file` names it in messages. Throws as
    /// read().
    static JsonValue parse(const std::string& file, std::span<const uint8_t> bytes);

    /// This object with the members of `changes` in place of its own, and so on in members that are objects in both
    /// (RFC 7396, JSON Merge Patch). Messages name the file of `changes`. Throws Error when one of them is no object.
    JsonValue patched(const JsonValue& changes) const;

    /// The member `key`. Throws Error when it is missing or this is no object.
    JsonValue at(const std::string& key) const;

    /// The member `key`, empty where it is missing. Throws Error when this is no object.
    std::optional<JsonValue> find(const std::string& key) const;

    /// All members, by key in alphabetical order. Throws Error when this is no object.
    std::vector<std::pair<std::string, JsonValue>> members() const;

    /// Throws Error, naming the first member with another key, and the known ones; also when this is no object.
    void expect_keys(const std::vector<std::string>& known) const;

    /// The elements of an array; the key path of one is "lights[2]".
    std::vector<JsonValue> elements() const;
    /// The elements of an array of exactly `count`.
    std::vector<JsonValue> elements_of(size_t count) const;

    bool is_object() const { return value_->is_object(); }
    bool is_array() const { return value_->is_array(); }
    bool is_string() const { return value_->is_string(); }

    std::string string() const;
    bool boolean() const;
    double number() const;
    double positive() const;
    double not_negative() const;
    /// A number within [low, high].
    double number_within(double low, double high) const;
    uint32_t positive_integer() const;
    /// A whole number from 0 to `most`.
    uint64_t whole_number(uint64_t most) const;
    /// An array of exactly `count` numbers.
    std::vector<double> numbers(size_t count) const;

    /// "file: key.path", for messages.
    std::string where() const;
    /// The file as it was named to read().
    const std::string& file() const { return *file_; }
    /// Throws Error: "file: key.path is value, requirement"; a long value is cut.
    [[noreturn]] void fail(const std::string& requirement) const;

  private:
    JsonValue(std::shared_ptr<const std::string> file, std::string key, std::shared_ptr<const nlohmann::json> value);
    JsonValue part(std::string key, const nlohmann::json& value) const;
    std::string key_of(const std::string& member) const;

    std::shared_ptr<const std::string> file_;
    std::string key_;
    std::shared_ptr<const nlohmann::json> value_;  ///< keeps the whole document alive
};

}  // namespace patina::sensor
