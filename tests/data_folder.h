#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace patina::testing {

inline constexpr const char* kNoData =
    "the recording is neither in $PATINA_DATA nor in ../shared/data beside the source";

/// A folder of recorded data: $PATINA_DATA/NAME, else ../shared/data/NAME beside the source tree; empty where neither
/// exists.
inline std::optional<std::filesystem::path> data_folder(const std::string& name) {
    const char* variable = std::getenv("PATINA_DATA");
    const std::filesystem::path root = variable ? variable : PATINA_SOURCE_DIR "/../shared/data";
    if (!std::filesystem::exists(root / name)) return std::nullopt;
    return root / name;
}

}  // namespace patina::testing
