// Directions over a surface as points of a disk. Functions without bindings.
#ifndef PATINA_LIB_HEMISPHERE_GLSL
#define PATINA_LIB_HEMISPHERE_GLSL
#include "shared/specular/hemi_images.h"

// A frame around a unit normal, which is its z axis. Its x axis is the world's x axis, or its z axis where that is too
// near to the normal, projected onto the tangent plane: the same for all voxels of a plane.
mat3 tangent_frame(vec3 normal) {
    const vec3 axis = abs(normal.x) < 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 0.0, 1.0);
    const vec3 tangent = normalize(axis - dot(axis, normal) * normal);
    return mat3(tangent, cross(normal, tangent), normal);
}

// A unit direction in such a frame as a point of the unit disk; what is below the horizon counts as lying on it.
vec2 disk_point(vec3 direction, uint map) {
    if (direction.z <= 0.0) return direction.xy / max(length(direction.xy), 1e-6);
    return map == kOrthogonalMap ? direction.xy : direction.xy / (1.0 + direction.z);
}

#endif
