#pragma once

#include <filesystem>
#include <vector>

namespace patina::sensor {

/// An absolute path without links, "." and ".." in it, and without a slash at its end; its last parts need not exist.
/// Throws Error for an empty path, a relative one where the folder that the program was started in is gone, a loop of
/// links, and a link that leads nowhere.
std::filesystem::path resolved(const std::filesystem::path& path);

/// Whether one of two paths that exist lies in the other or is it. Files are compared, not names.
bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder);

/// Throws Error when an output is, holds or lies inside one of the inputs. Files are compared, not names, so that links
/// do not matter; a link directly inside an input folder stands for what it leads to. Inputs that do not exist are left
/// aside.
void expect_apart(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs);

}  // namespace patina::sensor
