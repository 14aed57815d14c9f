#pragma once

#include <filesystem>
#include <string>

namespace patina::tools {

/// A path beside `place` that is not there yet, such as room-export-1 or room-recording-1.patina: the name of the
/// place without its extension, `what`, the first free number, and `extension`. Throws Error where the system does not
/// say.
std::filesystem::path free_place_beside(const std::filesystem::path& place, const std::string& what,
                                        const std::string& extension = "");

}  // namespace patina::tools
