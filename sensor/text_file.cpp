#include "sensor/text_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "engine/core/error.h"

namespace patina::sensor {
namespace {

std::vector<std::string> split(const std::string& line) {
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
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
    const size_t expected = split(std::string(columns)).size();
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
    const std::vector<uint8_t> bytes = read_bytes(file);
    std::istringstream stream(std::string(bytes.begin(), bytes.end()));
    std::vector<TextLine> lines;
    size_t number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
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

std::vector<uint8_t> read_bytes(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) throw Error(file.string(), " is missing");
    if (!std::filesystem::is_regular_file(file)) throw Error(file.string(), " is not a file");
    std::ifstream stream(file, std::ios::binary);
    std::vector<uint8_t> bytes(std::filesystem::file_size(file));
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!stream) throw Error(file.string(), " cannot be read");
    return bytes;
}

void write_bytes(const std::filesystem::path& file, std::string_view bytes) {
    std::ofstream stream(file, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throw Error(file.string(), " cannot be written");
}

std::string shortest(double value) { return printed(value); }

std::string fixed(double value, int digits) { return printed(value, std::chars_format::fixed, digits); }

}  // namespace patina::sensor
