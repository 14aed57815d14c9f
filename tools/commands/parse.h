#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <system_error>

#include "engine/core/image.h"

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

/// The value of --extent, WIDTHxHEIGHT. Throws CLI::ValidationError for anything else, and beyond 8192 pixels.
Extent2D parse_extent(const std::string& text);

}  // namespace patina::tools
