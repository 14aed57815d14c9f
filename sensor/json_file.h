#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace patina::sensor {

/// A value in a JSON file that knows its file and key path, so that every error names both:
/// "x/sequence.json: depth.fx is -3, must be positive".
class JsonValue {
  public:
    /// Parses a file. Throws Error when it is missing or no JSON.
    static JsonValue read(const std::filesystem::path& file);

    /// The member `key`. Throws Error when it is missing or this is no object.
    JsonValue at(const std::string& key) const;

    /// The member `key`, empty where it is missing. Throws Error when this is no object.
    std::optional<JsonValue> find(const std::string& key) const;

    std::string string() const;
    double number() const;
    double positive() const;
    uint32_t positive_integer() const;
    /// An array of exactly `count` numbers.
    std::vector<double> numbers(size_t count) const;
    /// The elements of an array.
    std::vector<JsonValue> elements() const;
    bool is_string() const { return value_.is_string(); }

    /// "file: key.path", for messages.
    std::string where() const;
    /// Throws Error: "file: key.path is VALUE, `requirement`".
    [[noreturn]] void fail(const std::string& requirement) const;

  private:
    JsonValue(std::string file, std::string key, nlohmann::json value);
    JsonValue element(size_t index) const;

    std::string file_;
    std::string key_;
    nlohmann::json value_;
};

}  // namespace patina::sensor
