// Body of the shaders that pack, for every voxel, whether it is inside (distance <= 0, as in ray casting) and whether
// it was seen. One invocation per word. The includer says how to load the distances:
//   QUAD(C, i)    uvec4, voxels 4 i to 4 i + 3 of the literal chunk C
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/surface/extract_surface.h"

layout(local_size_x = kSurfaceGroup) in;
layout(std430, binding = 0) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 1) writeonly buffer Inside { uint inside[]; };
layout(std430, binding = 2) writeonly buffer Seen { uint seen[]; };
layout(push_constant) uniform Push { SurfaceParams params; };

uint bits_of(bvec4 flags, uint shift) {
    const uvec4 bits = uvec4(flags) << uvec4(shift, shift + 1u, shift + 2u, shift + 3u);
    return bits.x | bits.y | bits.z | bits.w;
}

void main() {
    const uint item = group_item(gl_WorkGroupID) * kSurfaceGroup + gl_LocalInvocationIndex;
    const uint block = item / kBlockWords;
    if (block >= params.items) return;
    uint inside_bits = 0u;
    uint seen_bits = 0u;
    if (block < params.no_block && block_keys[block] != kEmptyKey) {
        const uint first = (index_in_chunk(params.grid.chunk_shift, block) * kBlockWords + item % kBlockWords) * 8u;
        uvec4 voxels[8];
#define LOAD_QUADS(C) [[unroll]] for (uint i = 0u; i < 8u; ++i) voxels[i] = QUAD(C, first + i)
        WITH_CHUNK(params.grid.chunk_shift, block, LOAD_QUADS)
        [[unroll]] for (uint i = 0u; i < 8u; ++i) {
            const bvec4 was_seen = greaterThan(voxels[i] >> 16, uvec4(0u));
            seen_bits |= bits_of(was_seen, 4u * i);
            inside_bits |= bits_of(lessThanEqual(ivec4(voxels[i] << 16), ivec4(0)), 4u * i);
        }
    }
    inside[item] = inside_bits & seen_bits;
    seen[item] = seen_bits;
}
