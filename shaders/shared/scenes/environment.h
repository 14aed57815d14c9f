// A synthetic scene's environment on the device; scenes/render/environment_table.h fills it.
#ifndef PATINA_SHARED_ENVIRONMENT_H
#define PATINA_SHARED_ENVIRONMENT_H
#include "shared/interop.h"
INTEROP_BEGIN

struct EnvironmentAlias {
    float keep;  // probability with which the cell itself is drawn
    uint other;  // the cell that is drawn otherwise
};

INTEROP_END
#endif
