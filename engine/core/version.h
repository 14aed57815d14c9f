#pragma once

namespace patina {

/// Patina's version, "0.1.0".
extern const char* const kVersion;

}  // namespace patina
