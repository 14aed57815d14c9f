#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace patina::sensor {

/// One line of a text file, split at white space. Numbers are read in the C locale, whatever the program's is.
class TextLine {
  public:
    TextLine(std::string where, std::vector<std::string> words);

    /// "file:line", for messages.
    const std::string& where() const { return where_; }
    size_t size() const { return words_.size(); }

    /// Throws Error unless the line has as many words as `columns` names, separated by spaces.
    void expect_columns(std::string_view columns) const;

    /// The word in a column, counted from 0; the column must exist.
    const std::string& word(size_t column) const;

    /// The word as a number; inf and nan pass, for the caller to judge. Throws Error when it is none.
    double number(size_t column) const;

    /// The word as a number. Throws Error when it is none or is inf or nan.
    double finite(size_t column) const;

    /// The word as a whole number from 0. Throws Error when it is none.
    uint32_t index(size_t column) const;

  private:
    std::string where_;
    std::vector<std::string> words_;
};

/// The lines of a text file that hold something; '#' starts a comment. Throws Error when the file cannot be read or is
/// longer than limits::kTextBytes or kTextLines.
std::vector<TextLine> read_lines(const std::filesystem::path& file);

/// The numbers of a text file, across lines; inf and nan pass. Throws Error when there are not exactly `count`.
std::vector<double> read_numbers(const std::filesystem::path& file, size_t count);

/// Writes a whole file, as NewFile does. Throws Error when that fails.
void write_bytes(const std::filesystem::path& file, std::string_view bytes);

/// The shortest decimal that reads back as the same number.
std::string shortest(double value);

/// The number with a fixed count of digits after the point.
std::string fixed(double value, int digits);

}  // namespace patina::sensor
