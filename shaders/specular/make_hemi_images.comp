#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// One workgroup per drawn voxel: the colour of the nearest observation in each pixel of its HemiImage.
#include "lib/map/voxel_chunks.glsl"
#include "lib/math/hemisphere.glsl"
#include "lib/records/observations.glsl"

layout(local_size_x = kHemiGroup) in;
layout(std430, binding = 0) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 1) readonly buffer Drawn { uint drawn[]; };
layout(std430, binding = 2) readonly buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 7) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(std430, binding = 12) writeonly buffer Images { vec4 images[]; };
layout(push_constant) uniform Push { HemiParams params; };
#include "lib/records/record_colors.glsl"
#include "lib/records/record_directions.glsl"

shared vec2 places[kMaxObservations];  // pixels, from the middle of the first one
shared uint words[kMaxObservations];   // colours

void project(uint record, uint count) {
    const mat3 frame = tangent_frame(surface_normal(records[record]));
    for (uint i = gl_LocalInvocationIndex; i < count; i += kHemiGroup) {
        const vec3 direction = observation_direction(load_direction(params.chunk_shift, record, i));
        places[i] = (disk_point(direction * frame, params.map) + 1.0) * (0.5 * float(kHemiSide - 1u));
        words[i] = load_color(params.chunk_shift, record, i);
    }
}

void main() {
    const uint image = gl_WorkGroupID.x * kHemiSamples + gl_WorkGroupID.y;
    const uint record = drawn[image];
    const uint count = record == kNoRecord ? 0u : observation_count(records[record]);
    if (count > 0u) project(record, count);
    barrier();
    vec2 at[kHemiPixelsPerInvocation];
    float distances2[kHemiPixelsPerInvocation];
    uint nearest[kHemiPixelsPerInvocation];
    [[unroll]] for (uint i = 0u; i < kHemiPixelsPerInvocation; ++i) {
        const uint pixel = i * kHemiGroup + gl_LocalInvocationIndex;
        at[i] = vec2(pixel % kHemiSide, pixel / kHemiSide);
        distances2[i] = 1e9;
        nearest[i] = 0u;
    }
    for (uint k = 0u; k < count; ++k) {
        const vec2 place = places[k];
        [[unroll]] for (uint i = 0u; i < kHemiPixelsPerInvocation; ++i) {
            const vec2 off = at[i] - place;
            const float distance2 = dot(off, off);
            const bool nearer = distance2 < distances2[i];
            distances2[i] = nearer ? distance2 : distances2[i];
            nearest[i] = nearer ? k : nearest[i];
        }
    }
    [[unroll]] for (uint i = 0u; i < kHemiPixelsPerInvocation; ++i) {
        const uint pixel = i * kHemiGroup + gl_LocalInvocationIndex;
        if (pixel >= kHemiPixels) continue;
        const vec3 rgb = count > 0u ? unpack_shared_exponent(words[nearest[i]]) : vec3(0.0);
        images[image * kHemiPixels + pixel] = vec4(rgb, 0.0);
    }
}
