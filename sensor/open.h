#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "patina/source.h"

namespace patina::sensor {

/// Opens a recorded sequence. `format` is "patina-sequence", "7-scenes" or "tum"; empty means that the folder's content
/// tells. The path of a sequence.json stands for its folder. Throws Error when the path does not exist, is of no known
/// format, or the sequence as a whole is unusable.
std::unique_ptr<Source> open_sequence(const std::filesystem::path& path, const std::string& format = "");

}  // namespace patina::sensor
