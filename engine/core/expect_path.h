#pragma once

#include <filesystem>

namespace patina {

/// Throws Error unless there is a folder at the path: "x does not exist", or "x is a file, not a folder".
void expect_folder(const std::filesystem::path& folder);

/// Throws Error where no file can be written because its folder does not exist, or because it is a folder itself.
void expect_place_for(const std::filesystem::path& file);

}  // namespace patina
