#include "tools/program/free_place.h"

#include <system_error>

#include "engine/core/error.h"

namespace patina::tools {

std::filesystem::path free_place_beside(const std::filesystem::path& place, const std::string& what,
                                        const std::string& extension) {
    std::error_code failure;
    const std::filesystem::path whole = std::filesystem::absolute(place, failure).lexically_normal();
    if (failure) throw Error("'", place.string(), "' has no place: ", failure.message());
    const std::filesystem::path named = whole.has_filename() ? whole : whole.parent_path();
    for (int number = 1;; ++number) {
        const auto free =
            named.parent_path() / (named.stem().string() + "-" + what + "-" + std::to_string(number) + extension);
        const bool taken = std::filesystem::exists(free, failure);
        if (failure) throw Error("'", free.string(), "' cannot be looked for: ", failure.message());
        if (!taken) return free;
    }
}

}  // namespace patina::tools
