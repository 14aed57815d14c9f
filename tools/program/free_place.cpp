#include "tools/program/free_place.h"

namespace patina::tools {

std::filesystem::path free_place_beside(const std::filesystem::path& place, const std::string& what,
                                        const std::string& extension) {
    const std::filesystem::path whole = std::filesystem::absolute(place).lexically_normal();
    const std::filesystem::path named = whole.has_filename() ? whole : whole.parent_path();
    for (int number = 1;; ++number) {
        const auto free =
            named.parent_path() / (named.stem().string() + "-" + what + "-" + std::to_string(number) + extension);
        if (!std::filesystem::exists(free)) return free;
    }
}

}  // namespace patina::tools
