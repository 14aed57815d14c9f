#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina::tools {

/// Parses all of `text` as a number.
template <class Number>
bool parse(std::string_view text, Number& number) {
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    return failure == std::errc{} && end == text.data() + text.size();
}

/// Two numbers with `separator` between them.
template <class Number>
bool parse_pair(std::string_view text, char separator, Number& first, Number& second) {
    const size_t at = text.find(separator);
    return at != text.npos && parse(text.substr(0, at), first) && parse(text.substr(at + 1), second);
}

/// Takes one of the words. Another is refused with the list of them, and with the one that was meant.
CLI::Validator one_of(const std::vector<std::string>& words);

/// The same for an option that is an enumeration: each word stands for a value.
template <class Value>
CLI::Validator one_of(const std::vector<std::pair<std::string, Value>>& values) {
    std::vector<std::string> words;
    for (const auto& [word, value] : values) words.push_back(word);
    const CLI::Validator check = one_of(words);
    return {[values, check](std::string& given) -> std::string {
                for (const auto& [word, value] : values) {
                    if (word != given) continue;
                    given = std::to_string(static_cast<int>(value));  // CLI11 reads enumerations as numbers
                    return "";
                }
                return check(given);
            },
            check.get_description()};
}

/// Takes whole numbers from 1.
CLI::Validator at_least_one();

/// Adds --white: SessionOptions::white_albedo.
void add_white_option(CLI::App& command, float& albedo);

/// The value of --up, X,Y,Z. Throws CLI::ValidationError for anything else, and for 0,0,0.
glm::dvec3 parse_up(const std::string& text);

/// The value of --extent, WIDTHxHEIGHT. Throws CLI::ValidationError for anything else, and beyond 8192 pixels.
Extent2D parse_extent(const std::string& text);

}  // namespace patina::tools
