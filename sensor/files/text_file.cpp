#include "sensor/files/text_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "sensor/output/new_file.h"

namespace patina::sensor {
namespace {

constexpr std::string_view kSpaces = " \t\r\v\f";

std::vector<std::string> split(std::string_view line) {
    std::vector<std::string> words;
    for (size_t begin = line.find_first_not_of(kSpaces); begin != std::string_view::npos;) {
        const size_t end = std::min(line.find_first_of(kSpaces, begin), line.size());
        words.emplace_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(kSpaces, end);
    }
    return words;
}

/// Parses all of `word`; false when anything is left over or the value does not fit.
template <class Number>
bool parse(std::string_view word, Number& value) {
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    return failure == std::errc{} && end == word.data() + word.size();
}

template <class... Format>
std::string printed(double value, Format... format) {
    std::string buffer(400, '\0');  // the longest fixed-point double has 309 digits before the point
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format...);
    PATINA_ASSERT(result.ec == std::errc{}, "value ", value);
    buffer.resize(static_cast<size_t>(result.ptr - buffer.data()));
    return buffer;
}

}  // namespace

TextLine::TextLine(std::string where, std::vector<std::string> words)
    : where_(std::move(where)), words_(std::move(words)) {}

void TextLine::expect_columns(std::string_view columns) const {
    const size_t expected = split(columns).size();
    if (size() != expected) throw Error(where_, " has ", size(), " columns, must have ", expected, ": ", columns);
}

const std::string& TextLine::word(size_t column) const {
    PATINA_ASSERT(column < size(), where_, ", column ", column, " of ", size());
    return words_[column];
}

double TextLine::number(size_t column) const {
    std::string_view digits = word(column);
    if (digits.starts_with('+')) digits.remove_prefix(1);  // from_chars takes no plus sign
    double value = 0;
    if (!parse(digits, value)) throw Error(where_, ": '", word(column), "' in column ", column + 1, " is not a number");
    return value;
}

double TextLine::finite(size_t column) const {
    const double value = number(column);
    if (!std::isfinite(value)) throw Error(where_, ": column ", column + 1, " is ", value, ", must be finite");
    return value;
}

uint32_t TextLine::index(size_t column) const {
    uint32_t value = 0;
    if (!parse(std::string_view(word(column)), value)) {
        throw Error(where_, ": '", word(column), "' in column ", column + 1, " is not a whole number from 0");
    }
    return value;
}

std::vector<TextLine> read_lines(const std::filesystem::path& file) {
    const std::vector<uint8_t> bytes = read_file(file, limits::kTextBytes);
    std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::vector<TextLine> lines;
    for (size_t number = 1; !rest.empty(); ++number) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
        if (number > limits::kTextLines)
            throw Error(file.string(), " has more than ", limits::kTextLines, " lines, line ", number, " is not read");
        std::vector<std::string> words = split(line.substr(0, line.find('#')));
        if (!words.empty()) lines.emplace_back(text(file.string(), ":", number), std::move(words));
    }
    return lines;
}

std::vector<double> read_numbers(const std::filesystem::path& file, size_t count) {
    std::vector<double> numbers;
    for (const TextLine& line : read_lines(file)) {
        for (size_t column = 0; column < line.size(); ++column) numbers.push_back(line.number(column));
    }
    if (numbers.size() != count) throw Error(file.string(), " has ", numbers.size(), " numbers, must have ", count);
    return numbers;
}

void write_bytes(const std::filesystem::path& file, std::string_view bytes) {
    NewFile created(file);
    created.write(bytes);
    created.close();
}

std::string shortest(double value) { return printed(value); }

std::string fixed(double value, int digits) { return printed(value, std::chars_format::fixed, digits); }

}  // namespace patina::sensor
