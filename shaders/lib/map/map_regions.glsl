// Which bit says whether the map has any block in a region (shared/reflectance/surroundings.h). Functions without
// bindings.
#ifndef PATINA_LIB_MAP_REGIONS_GLSL
#define PATINA_LIB_MAP_REGIONS_GLSL
#include "shared/reflectance/far_field.h"
#include "shared/reflectance/surroundings.h"

ivec3 region_of_block(ivec3 block) { return block >> 3; }

uint bit_of_region(ivec3 region) {
    const uvec3 low = uvec3(region) & 127u;
    return low.x | low.y << 7 | low.z << 14;
}

#endif
