#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "patina/source.h"

namespace patina::sensor {

/// The names of all formats that can be opened, for a sentence: "a, b or c".
std::string format_names();

/// Throws Error where the path of a sequence is empty, or nothing is there.
void expect_sequence_path(const std::filesystem::path& path);

/// Opens a recorded sequence. `format` is one of format_names(); empty: recognised by the folder's content. The path of
/// a sequence.json stands for its folder. Throws Error when the path does not exist, is of no known format, or the
/// sequence as a whole is unusable.
std::unique_ptr<Source> open_sequence(const std::filesystem::path& path, const std::string& format = "");

}  // namespace patina::sensor
