#version 460
#extension GL_GOOGLE_include_directive : require
// Counts the cells that the frame before added to the surroundings, before another adds its own.
#include "shared/reflectance/far_field.h"
#include "shared/reflectance/surroundings.h"

layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Surroundings{SURROUNDINGS_MEMBERS};

void main() {
    surroundings_counts.total += surroundings_counts.fresh;
    surroundings_counts.fresh = 0u;
}
