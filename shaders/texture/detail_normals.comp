#version 460
#extension GL_GOOGLE_include_directive : require
// What the volume's surface faces at each texel's point, in the frame of the mesh's normal and tangent there: detail
// that the mesh has lost. One group per tile.
#include "shared/texture/texture.h"

layout(local_size_x = kTextureTile, local_size_y = kTextureTile) in;
layout(std430, binding = 1) readonly buffer Vertices { TextureVertex vertices[]; };
layout(std430, binding = 2) readonly buffer Triangles { uint triangles[]; };  // three vertices each
layout(std430, binding = 3) readonly buffer Tiles { TextureTile tiles[]; };
layout(std430, binding = 4) readonly buffer Lists { uint lists[]; };        // triangles, ascending in each tile
layout(std430, binding = 5) readonly buffer Tangents { vec4 tangents[]; };  // by vertex; w: side of the third axis
layout(std430, binding = 6) writeonly buffer Detail { uint detail[]; };     // packSnorm2x16 of x and y, or kNoSurface
layout(std430, binding = 7) readonly buffer Keys { uvec4 buckets[]; };
layout(std430, binding = 8) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 9) readonly buffer Tsdf { uint voxels[]; }
tsdf[kMaxVoxelChunks];
layout(push_constant) uniform Push { DetailNormalsParams params; };
#define KEYS(bucket) buckets[bucket]
#define BLOCK(slot) blocks[slot]
#include "lib/map/block_lookup.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "texture/find_triangle.glsl"

const float kLeastCosine = 0.5;  // what turns away from the mesh by more is another surface, or noise
const uint kFlat = 0u;           // packSnorm2x16(vec2(0.0))

// A distance between voxels' centres, in units of kSdfRangeVox voxels; y: 0 where one of the eight was not observed.
vec2 distance_at(vec3 at_vox) {
    const ivec3 low = ivec3(floor(at_vox - 0.5));
    const vec3 t = at_vox - 0.5 - vec3(low);
    vec2 sum = vec2(0.0, 1.0);
    for (int i = 0; i < 8; ++i) {
        const ivec3 step = ivec3(i & 1, i >> 1 & 1, i >> 2);
        const ivec3 place = low + step;
        const uint block = find_block(params.grid, place >> 3);
        if (block == kNoBlock) return vec2(0.0);
        const ivec3 within = place & 7;
        const uint index = index_in_chunk(params.grid.chunk_shift, block) * kBlockVoxels +
                           uint(within.z << 6 | within.y << 3 | within.x);
        uint voxel;
#define LOAD_VOXEL(C) voxel = tsdf[C].voxels[index]
        WITH_CHUNK(params.grid.chunk_shift, block, LOAD_VOXEL)
        if (voxel_weight(voxel) == 0u) return vec2(0.0);
        const vec3 shares = mix(1.0 - t, t, vec3(step));
        sum.x += shares.x * shares.y * shares.z * voxel_sdf(voxel);
    }
    return sum;
}

// Central differences over two voxels; 0 where not all is known.
vec3 gradient_at(vec3 at_vox) {
    vec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        const vec3 along = vec3(equal(ivec3(axis), ivec3(0, 1, 2)));
        const vec2 low = distance_at(at_vox - along), high = distance_at(at_vox + along);
        if (low.y == 0.0 || high.y == 0.0) return vec3(0.0);
        gradient[axis] = high.x - low.x;
    }
    return gradient;
}

uint detail_of(ShownPoint shown) {
    const TextureVertex a = vertices[shown.corners.x], b = vertices[shown.corners.y], c = vertices[shown.corners.z];
    const vec3 shares = shown.shares;
    const vec3 position_m = shares.x * a.position_m.xyz + shares.y * b.position_m.xyz + shares.z * c.position_m.xyz;
    const vec3 gradient = gradient_at(position_m / params.grid.voxel_m);
    const vec3 facing = shares.x * a.normal.xyz + shares.y * b.normal.xyz + shares.z * c.normal.xyz;
    const vec4 right = shares.x * tangents[shown.corners.x] + shares.y * tangents[shown.corners.y] +
                       shares.z * tangents[shown.corners.z];
    if (dot(gradient, gradient) == 0.0 || dot(facing, facing) < 1e-12 || dot(right.xyz, right.xyz) < 1e-12)
        return kFlat;
    const vec3 normal = normalize(facing), tangent = normalize(right.xyz);
    const mat3 world_from_tangent = mat3(tangent, sign(right.w) * cross(normal, tangent), normal);
    if (abs(determinant(world_from_tangent)) < 1e-3) return kFlat;
    const vec3 seen = normalize(inverse(world_from_tangent) * gradient);
    return seen.z < kLeastCosine ? kFlat : packSnorm2x16(seen.xy);
}

void main() {
    const uvec2 texel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(texel, params.extent))) return;
    const TextureTile tile = tiles[gl_WorkGroupID.y * params.tiles_x + gl_WorkGroupID.x];
    const ShownPoint shown = find_triangle(tile, vec2(texel) + 0.5);
    detail[texel.y * params.extent.x + texel.x] = shown.found ? detail_of(shown) : kNoSurface;
}
