#include "tools/version.h"

namespace patina::tools {

const char* const kVersion = PATINA_VERSION;

}  // namespace patina::tools
