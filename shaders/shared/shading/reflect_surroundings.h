// Re-rendering: what glossy surfaces mirror of what is around them.
#ifndef PATINA_SHARED_REFLECT_SURROUNDINGS_H
#define PATINA_SHARED_REFLECT_SURROUNDINGS_H
#include "shared/fusion/voxel_map.h"
INTEROP_BEGIN

INTEROP_CONST uint kReflectGroupX = 32u;
INTEROP_CONST uint kReflectGroupY = 4u;

// What of a pixel's radiance is left to gloss and to the light from all around; four half floats each.
struct GlossyPixel {
    uvec2 ks_alpha;  // rgb: specular albedo, without what is a guess; a: Ward roughness
    uvec2 indirect;  // rgb: irradiance over pi
};

struct ReflectParams {
    VoxelGrid voxels;  // the voxel map's
    vec4 ball_m;       // the camera's centre in the world, radius: beyond it rays meet the surroundings
};

INTEROP_END
#endif
