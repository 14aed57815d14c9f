#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation per set of rays: what they meet that one view of a pair shows mirrored.
#include "lib/brdf/ward.glsl"
#include "lib/math/random.glsl"
#include "lib/records/record_hash.glsl"
#include "lib/records/reflectance.glsl"
#include "shared/reflectance/far_field.h"
#include "shared/specular/mirror_fit.h"

layout(local_size_x = kMirrorGroup) in;
layout(std430, binding = 0) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 1) readonly buffer Pairs { MirrorPair pairs[]; };  // kSegmentSamples per segment
layout(std430, binding = 2) readonly buffer Surroundings{SURROUNDINGS_MEMBERS};
layout(std430, binding = 3) writeonly buffer Mirrored { vec4 mirrored[]; };  // kMirrorSets per pair
layout(push_constant) uniform Push { MirrorParams params; };
#include "lib/lighting/march_surroundings.glsl"

const uint kRaysOfSet = 2u;

// The mean colour that the rays of a set meet on the way to the viewer; a is 0 where they meet nothing.
// What is brighter than pixels can be counts as that bright: views of it are clipped, and left out.
vec4 mean_met(vec3 point_m, vec3 normal, vec3 to_viewer, uvec2 stream, uint set) {
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < kRaysOfSet; ++i) {
        const vec3 direction = sample_ward(kMirrorAlpha, normal, to_viewer, random_numbers(stream, set, i).xy);
        if (dot(direction, normal) > 0.0) sum += min(march_surroundings(point_m, normal, direction, 0.0).color, 1.0);
    }
    return sum.a > 0.0 ? sum / sum.a : vec4(0.0);
}

void main() {
    const uint item = gl_GlobalInvocationID.x, set = item % kMirrorSets;
    const MirrorPair pair = pairs[item / kMirrorSets];
    if (pair.record == kNoRecord) return;
    const VoxelRecord known = records[pair.record];
    const vec3 point_m = surface_point_m(known, params.records, params.edge_shift);
    const uvec2 stream = uvec2(hash_of_voxel(known.block_key, voxel_in_block(known)), params.stamp);
    const vec3 to_viewer = observation_direction(set % 2u == 0u ? pair.first : pair.second);
    mirrored[item] = mean_met(point_m, surface_normal(known), to_viewer, stream, set);
}
