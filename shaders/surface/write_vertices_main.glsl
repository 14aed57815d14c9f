// Body of the shaders that write a batch's vertices: position, normal and colour, each an array of its own within one
// buffer. The includer says how to load the map:
//   VOXEL(C, i)     uint, voxel i of the literal chunk C
//   NEIGHBOUR(i)    uint, entry i of the list of neighbours
#include "lib/map/surface_words.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"

layout(local_size_x = kSurfaceGroup) in;
layout(std430, binding = 1) readonly buffer Vertices { SurfaceElement vertices[]; };
layout(std430, binding = 2) readonly buffer Color { uint voxels[]; }
color[kMaxVoxelChunks];
layout(std430, binding = 3) writeonly buffer Attributes { float attributes[]; };
layout(push_constant) uniform Push { SurfaceParams params; };

// A voxel of a block or of one around it: `at` counts from the block's corner.
struct Place {
    uint block;
    uint voxel;
};

Place find_voxel(uint block, ivec3 at) {
    const ivec3 within = at & 7;
    return Place(neighbour_block(block, at >> 3), uint(within.z << 6 | within.y << 3 | within.x));
}

struct Distance {
    bool seen;
    float value;
};

Distance load_distance(uint block, ivec3 at) {
    const Place place = find_voxel(block, at);
    const bool exists = place.block < params.no_block;
    const uint safe = exists ? place.block : 0u;
    const uint index = index_in_chunk(params.grid.chunk_shift, safe) * kBlockVoxels + place.voxel;
    uint voxel;
#define LOAD_VOXEL(C) voxel = VOXEL(C, index)
    WITH_CHUNK(params.grid.chunk_shift, safe, LOAD_VOXEL)
    return Distance(exists && voxel_weight(voxel) > 0u, voxel_sdf(voxel));
}

// Central differences, one-sided where a voxel on one side was not seen.
vec3 gradient_at(uint block, ivec3 at, float center) {
    vec3 gradient;
    [[unroll]] for (int axis = 0; axis < 3; ++axis) {
        ivec3 along = ivec3(0);
        along[axis] = 1;
        const Distance low = load_distance(block, at - along);
        const Distance high = load_distance(block, at + along);
        const float difference = (high.seen ? high.value : center) - (low.seen ? low.value : center);
        gradient[axis] = low.seen && high.seen ? 0.5 * difference : difference;
    }
    return gradient;
}

// Linear colour; w is 1, or all is 0 where no colour was seen.
vec4 load_color(uint block, ivec3 at) {
    const Place place = find_voxel(block, at);
    const uint index = index_in_chunk(params.grid.chunk_shift, place.block) * kBlockVoxels + place.voxel;
    uint packed;
#define LOAD_COLOR(C) packed = color[C].voxels[index]
    WITH_CHUNK(params.grid.chunk_shift, place.block, LOAD_COLOR)
    return packed != 0u ? vec4(voxel_color(packed), 1.0) : vec4(0.0);
}

void store(uint array, uint item, vec3 value) {
    const uint at = 3u * (array * params.items + item);
    attributes[at] = value.x;
    attributes[at + 1u] = value.y;
    attributes[at + 2u] = value.z;
}

void main() {
    const uint item = group_item(gl_WorkGroupID) * kSurfaceGroup + gl_LocalInvocationIndex;
    if (item >= params.items) return;
    const uint block = vertices[item].block;
    const uint code = vertices[item].code;
    const ivec3 low = ivec3(code & 7u, code >> 3 & 7u, code >> 6 & 7u);
    const ivec3 along = ivec3(equal(uvec3(code >> 9), uvec3(0u, 1u, 2u)));
    const ivec3 high = low + along;

    const float low_distance = load_distance(block, low).value;
    const float high_distance = load_distance(block, high).value;
    const float share = clamp(low_distance / (low_distance - high_distance), kLeastShare, 1.0 - kLeastShare);
    const ivec3 corner = block_of_key(params.grid, NEIGHBOUR(block * kNeighbourStride + kOwnKey)) * int(kBlockEdge);
    store(0u, item, (vec3(corner + low) + 0.5 + share * vec3(along)) * params.grid.voxel_m);

    const vec3 gradient = mix(gradient_at(block, low, low_distance), gradient_at(block, high, high_distance), share);
    const float steepness = length(gradient);
    // Two surfaces a voxel apart can cancel each other's slope; the edge itself still leads from one side to the other.
    const vec3 across = vec3(along) * (high_distance > low_distance ? 1.0 : -1.0);
    store(1u, item, steepness > 0.0 ? gradient / steepness : across);

    const vec4 mixed = (1.0 - share) * load_color(block, low) + share * load_color(block, high);
    store(2u, item, mixed.w > 0.0 ? mixed.rgb / mixed.w : vec3(0.0));
}
