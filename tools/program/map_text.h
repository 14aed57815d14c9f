#pragma once

#include <filesystem>
#include <string>

namespace patina::tools {

/// Whether a path is a map, or a folder of results with one, rather than a sequence; then the map's path.
std::filesystem::path map_at(const std::filesystem::path& path);

/// What a map holds, for a person to read: lines of text. All of it is read, so that damage is found. Throws Error
/// where it cannot be read, is no map, or is damaged.
std::string describe_map(const std::filesystem::path& file);

}  // namespace patina::tools
