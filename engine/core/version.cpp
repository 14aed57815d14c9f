#include "engine/core/version.h"

namespace patina {

const char* const kVersion = PATINA_VERSION;

}  // namespace patina
