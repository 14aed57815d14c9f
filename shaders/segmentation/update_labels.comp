#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// One workgroup per block on the visible surface: each voxel near the surface looks up its segment's label in the
// frame. Those near it, about a quarter of a block, are listed first: where a lane idles, software devices wait.
#include "lib/camera.glsl"
#include "lib/voxel_chunks.glsl"
#include "lib/voxel_labels.glsl"
#include "lib/voxel_map.glsl"
#include "shared/visible_blocks.h"

layout(constant_id = 1) const int kSegmentStride = 1;  // of the pixels in x and y, as to which segment they are of
layout(local_size_x = kUpdateLabelsGroup) in;
layout(std430, binding = 0) readonly buffer Due { uint due[]; };  // count, then block ids | kSettledBlock
layout(std430, binding = 1) readonly buffer BlockKeys { uint block_keys[]; };
layout(std140, binding = 2) uniform View { ViewParams view; };
layout(binding = 3, rgba32f) uniform readonly image2D position_m;
layout(binding = 4, rgba16f) uniform readonly image2D normal;
layout(binding = 5, r32ui) uniform readonly uimage2D segment;
layout(binding = 6, r32ui) uniform readonly uimageBuffer SegmentLabels;
layout(binding = 7, r32ui) uniform readonly uimageBuffer Parents;
layout(std430, binding = 8) readonly buffer Tsdf { uvec4 quads[]; }
tsdf[kMaxVoxelChunks];
layout(std430, binding = 13) buffer Words { uint words[]; }
labels[kMaxVoxelChunks];
layout(std430, binding = 18) buffer Counters { SegmentCounters counters; };
layout(std430, binding = 19) readonly buffer Visible { uint visible[]; };  // count, then block ids
layout(std430, binding = 20) buffer Stamps { uint stamps[]; };             // as LabelMapIds::stamps

const float kNearVox = 1.0;        // from the surface, of a voxel that may hold a point of it
const float kMayBeVox = 2.0;       // from what a pixel shows of it, of a voxel of which nothing better is known
const float kGrazingCosine = 0.1;  // of steeper views the pixels say little

shared uint voted;
shared uint flipped;
shared uint unsettled;  // voxels near the surface whose label is not known, not sure or was contradicted
shared uint listed;
shared uint list[kBlockVoxels];  // voxels near the surface, in any order: each is updated by itself

// The label that a pixel which was looked at gives a voxel at `at`, in camera coordinates; 0 where the voxel is hidden
// there, or the pixel has none.
uint label_at(ivec2 looked_at, vec3 at, vec3 toward, float near_vox) {
    const uint here = imageLoad(segment, looked_at).x;
    if (here == 0u) return kNoLabel;
    const ivec2 pixel = looked_at * kSegmentStride;
    const float depth_m = imageLoad(position_m, pixel).w;  // one channel is gathered faster than three
    const vec3 facing = imageLoad(normal, pixel).xyz;
    const bool grazing = dot(facing, toward) < kGrazingCosine * length(toward);
    const vec3 offset_m = to_world_direction(view.camera, at - unproject(view.camera, vec2(pixel)) * depth_m);
    const bool apart = abs(dot(facing, offset_m)) > near_vox * view.grid.voxel_m;
    return grazing || apart ? kNoLabel : imageLoad(SegmentLabels, int(here)).x;
}

// The label of the nearest pixel that was looked at. If that is not of the voxel's surface, as beside a silhouette,
// one of the other three around it may be.
uint seen_label(vec3 center_m, vec3 camera_m, float near_vox) {
    const vec3 at = to_camera(view.camera, center_m);
    if (at.z < view.near_m) return kNoLabel;
    const vec2 place = project(view.camera, at) / float(kSegmentStride);
    const ivec2 nearest = ivec2(floor(place + 0.5));
    const vec3 toward = camera_m - center_m;
    uint label = label_at(nearest, at, toward, near_vox);
    if (kSegmentStride == 1) return label;
    const ivec2 other = mix(ivec2(-1), ivec2(1), greaterThan(place, vec2(nearest)));
    if (label == kNoLabel) label = label_at(nearest + ivec2(other.x, 0), at, toward, near_vox);
    if (label == kNoLabel) label = label_at(nearest + ivec2(0, other.y), at, toward, near_vox);
    if (label == kNoLabel) label = label_at(nearest + other, at, toward, near_vox);
    return label;
}

uint updated(uint word, uint label, inout uint votes, inout uint flips) {
    if (label == kNoLabel) return word;
    const uint root = imageLoad(Parents, int(voxel_label(word))).x;
    const uint known = root == kNoLabel ? 0u : label_word(root, word >> 16);
    const uint next = voted_word(known, label);
    ++votes;
    flips += root != kNoLabel && voxel_label(next) != root ? 1u : 0u;
    return next;
}

// Lists the voxels of the block that are near the surface. An invocation looks at four along x at a time. Of a block
// that has settled it looks at every fourth four, others in every turn, which lie in all layers of x, y and z.
void list_near(uint block, bool settled) {
    const uint first_quad = index_in_chunk(view.grid.chunk_shift, block) * (kBlockVoxels / 4u);
    const uint lane = gl_LocalInvocationIndex;
    const uint chosen = 4u * lane + (stamps[block] / kSettledFrames + lane / 4u) % 4u;
    for (uint i = 0u; i < (settled ? 1u : kLabelQuads); ++i) {
        const uint quad = settled ? chosen : i * kUpdateLabelsGroup + lane;
        uvec4 voxels;
#define LOAD_TSDF(C) voxels = tsdf[C].quads[first_quad + quad]
        WITH_CHUNK(view.grid.chunk_shift, block, LOAD_TSDF)
        [[unroll]] for (uint j = 0u; j < 4u; ++j) {
            const bool near = voxel_weight(voxels[j]) > 0u && abs(voxel_sdf(voxels[j])) * kSdfRangeVox < kNearVox;
            if (near) list[atomicAdd(listed, 1u)] = 4u * quad + j;
        }
    }
}

void main() {
    const uint item = group_item(gl_WorkGroupID);
    if (item == 0u && gl_LocalInvocationIndex == 0u) counters.frame_seen = visible[0];
    if (item >= due[0]) return;
    const uint block = due[1u + item] & ~kSettledBlock;
    const bool settled = due[1u + item] >= kSettledBlock;
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) voted = flipped = listed = unsettled = 0u;
    barrier();
    list_near(block, settled);
    barrier();
    const ivec3 corner = block_of_key(view.grid, block_keys[block]) * int(kBlockEdge);
    const uint first = index_in_chunk(view.grid.chunk_shift, block) * kBlockVoxels;
    const vec3 camera_m = camera_center_m(view.camera);
    uint votes = 0u, flips = 0u, open = 0u;
    for (uint i = lane; i < listed; i += kUpdateLabelsGroup) {
        const uint voxel = list[i];
        const ivec3 within = ivec3(voxel & 7u, voxel >> 3 & 7u, voxel >> 6);
        const vec3 center_m = (vec3(corner + within) + 0.5) * view.grid.voxel_m;
        uint known;
#define LOAD_WORD(C) known = labels[C].words[first + voxel]
#define STORE_WORD(C) labels[C].words[first + voxel] = known
        WITH_CHUNK(view.grid.chunk_shift, block, LOAD_WORD)
        const uint label = seen_label(center_m, camera_m, known == 0u ? kMayBeVox : kNearVox);
        const uint before = known;
        known = updated(known, label, votes, flips);
        open += known >> 16 < max(kSettledConfidence, before >> 16) ? 1u : 0u;
        WITH_CHUNK(view.grid.chunk_shift, block, STORE_WORD)
    }
    if (votes > 0u) atomicAdd(voted, votes);
    if (flips > 0u) atomicAdd(flipped, flips);
    if (open > 0u) atomicAdd(unsettled, open);
    barrier();
    if (lane == 0u) atomicAdd(counters.frame_due, settled ? 1u : kLabelQuads);
    if (lane == 0u && (settled || listed > 0u) && unsettled == 0u) stamps[block] |= kSettledBlock;
    if (lane == 0u && voted > 0u) atomicAdd(counters.frame_voxels, voted);
    if (lane == 0u && flipped > 0u) atomicAdd(counters.frame_flips, flipped);
}
