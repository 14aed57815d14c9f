#include "tools/viewer/export_folder.h"

#include <string>

namespace patina::tools {

std::filesystem::path free_folder_beside(const std::filesystem::path& place) {
    const std::filesystem::path whole = std::filesystem::absolute(place).lexically_normal();
    const std::filesystem::path named = whole.has_filename() ? whole : whole.parent_path();
    for (int number = 1;; ++number) {
        const auto folder = named.parent_path() / (named.stem().string() + "-export-" + std::to_string(number));
        if (!std::filesystem::exists(folder)) return folder;
    }
}

}  // namespace patina::tools
