// The hash by which a full pool of records chooses. Functions without bindings.
#ifndef PATINA_LIB_RECORD_HASH_GLSL
#define PATINA_LIB_RECORD_HASH_GLSL
#include "lib/map/voxel_map.glsl"

// Of a voxel by its block's key and its number within it.
uint hash_of_voxel(uint block_key, uint voxel) { return hash_of_key(hash_of_key(block_key) + voxel); }

#endif
