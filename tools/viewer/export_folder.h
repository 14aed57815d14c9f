#pragma once

#include <filesystem>

namespace patina::tools {

/// The first of NAME-export-1, NAME-export-2, ... beside a file or folder called NAME that is not there yet.
std::filesystem::path free_folder_beside(const std::filesystem::path& place);

}  // namespace patina::tools
