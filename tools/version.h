#pragma once

namespace patina::tools {

inline constexpr const char* kVersion = PATINA_VERSION;

}  // namespace patina::tools
