// Body of the shaders that update the voxels' labels. A workgroup takes a few blocks in sight: each voxel near the
// surface looks up its segment's label in the frame. Those near it are listed first, of all these blocks: most blocks
// have none, and where a lane idles, software devices wait. The includer declares the map's distances (binding 8) and
// how to load them:
//   QUAD(C, i)      uvec4, four voxels along x of the literal chunk C
#include "lib/camera/camera.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_labels.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/visible_blocks.h"

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
layout(binding = 21, r32ui) uniform readonly uimageBuffer Partners;
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
shared uint looked_at;                    // as SegmentCounters::frame_due
shared uint items[kUpdateBlocks];         // of this group: as in the list
shared uint keys[kUpdateBlocks];          // of these blocks
shared uint block_listed[kUpdateBlocks];  // voxels near their surface,
shared uint unsettled[kUpdateBlocks];     // and those of them whose label is not known, not sure or was contradicted
shared uint restless[kUpdateBlocks];      // and those that have no label after this turn or were contradicted in it
shared uint listed;
shared uint list[kUpdateBlocks * kBlockVoxels];  // voxel | which block << 9, in any order: each is updated by itself

// Copies from the uniform buffer, whose loads software devices do not hoist out of loops.
Camera camera;
vec3 camera_m;
float voxel_m;

// The label that a pixel which was looked at gives a voxel at `at`, in camera coordinates; 0 where the voxel is hidden
// there, or the pixel has none.
uint label_at(ivec2 looked_at, vec3 at, vec3 toward, float near_vox) {
    const uint here = imageLoad(segment, looked_at).x;
    if (here == 0u) return kNoLabel;
    const ivec2 pixel = looked_at * kSegmentStride;
    const float depth_m = imageLoad(position_m, pixel).w;  // one channel is gathered faster than three
    const vec3 facing = imageLoad(normal, pixel).xyz;
    const bool grazing = dot(facing, toward) < kGrazingCosine * length(toward);
    const vec3 offset_m = to_world_direction(camera, at - unproject(camera, vec2(pixel)) * depth_m);
    const bool apart = abs(dot(facing, offset_m)) > near_vox * voxel_m;
    return grazing || apart ? kNoLabel : imageLoad(SegmentLabels, int(here)).x;
}

// The label of the nearest pixel that was looked at. If that is not of the voxel's surface, as beside a silhouette,
// one of the other three around it may be.
uint seen_label(vec3 center_m, float near_vox) {
    const vec3 at = to_camera(camera, center_m);
    if (at.z < view.near_m) return kNoLabel;
    const vec2 place = project(camera, at) / float(kSegmentStride);
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
    // Of a label and its partner the frame cannot tell which is meant: their colours can.
    if (imageLoad(Partners, int(root)).x == label) label = root;
    const uint known = root == kNoLabel ? 0u : label_word(root, word >> 16);
    const uint next = voted_word(known, label);
    ++votes;
    flips += root != kNoLabel && voxel_label(next) != root ? 1u : 0u;
    return next;
}

// Which of four voxels are near the surface, one bit each.
uint near_surface(uvec4 voxels) {
    uint near = 0u;
    [[unroll]] for (uint j = 0u; j < 4u; ++j) {
        const bool is_near = voxel_weight(voxels[j]) > 0u && abs(voxel_sdf(voxels[j])) * kSdfRangeVox < kNearVox;
        near |= uint(is_near) << j;
    }
    return near;
}

uint block_of(uint item) { return item & ~kSettledBlock; }
bool is_settled(uint item) { return (item & kSettledBlock) != 0u; }

// Lists the voxels of one of the blocks that are near the surface. An invocation looks at four along x at a time. Of a
// block that has settled it looks at every fourth four, others in every turn, which lie in all layers of x, y and z.
void list_near(uint slot) {
    const uint block = block_of(items[slot]);
    const bool settled = is_settled(items[slot]);
    const uint first_quad = index_in_chunk(view.grid.chunk_shift, block) * (kBlockVoxels / 4u);
    const uint lane = gl_LocalInvocationIndex;
    const uint chosen = settled ? 4u * lane + (stamps[block] / kSettledFrames + lane / 4u) % 4u : lane;
    uint near = 0u;  // four bits a quad
    for (uint i = 0u; i < (settled ? 1u : kLabelQuads); ++i) {
        uvec4 voxels;
#define LOAD_TSDF(C) voxels = QUAD(C, first_quad + i * kUpdateLabelsGroup + chosen)
        WITH_CHUNK(view.grid.chunk_shift, block, LOAD_TSDF)
        near |= near_surface(voxels) << 4u * i;
    }
    if (near == 0u) return;
    const uint count = uint(bitCount(near));
    atomicAdd(block_listed[slot], count);
    uint place = atomicAdd(listed, count);
    for (uint bits = near; bits != 0u; bits &= bits - 1u) {
        const uint bit = uint(findLSB(bits));
        list[place++] = 4u * (bit / 4u * kUpdateLabelsGroup + chosen) + (bit & 3u) | slot * kBlockVoxels;
    }
}

// Lets the frame vote on a listed voxel.
void update_voxel(uint entry, inout uint votes, inout uint flips) {
    const uint slot = entry / kBlockVoxels, voxel = entry % kBlockVoxels;
    const uint block = block_of(items[slot]);
    const uint index = index_in_chunk(view.grid.chunk_shift, block) * kBlockVoxels + voxel;
    const ivec3 within = ivec3(voxel & 7u, voxel >> 3 & 7u, voxel >> 6);
    const ivec3 corner = block_of_key(view.grid, keys[slot]) * int(kBlockEdge);
    const vec3 center_m = (vec3(corner + within) + 0.5) * voxel_m;
    uint known;
#define LOAD_WORD(C) known = labels[C].words[index]
#define STORE_WORD(C) labels[C].words[index] = known
    WITH_CHUNK(view.grid.chunk_shift, block, LOAD_WORD)
    const uint label = seen_label(center_m, known == 0u ? kMayBeVox : kNearVox);
    const uint before = known;
    known = updated(known, label, votes, flips);
    if (known >> 16 < max(kSettledConfidence, before >> 16)) atomicAdd(unsettled[slot], 1u);
    if (known == 0u || known >> 16 < before >> 16) atomicAdd(restless[slot], 1u);
    if (known != before) {
        WITH_CHUNK(view.grid.chunk_shift, block, STORE_WORD)
    }
}

// What becomes of the block, after all its listed voxels were voted on.
void settle(uint slot) {
    const uint item = items[slot];
    atomicAdd(looked_at, is_settled(item) ? 1u : kLabelQuads);
    if (restless[slot] > 0u) stamps[block_of(item)] |= kRestlessBlock;
    if ((is_settled(item) || block_listed[slot] > 0u) && unsettled[slot] == 0u) stamps[block_of(item)] |= kSettledBlock;
}

void main() {
    const uint first = group_item(gl_WorkGroupID) * kUpdateBlocks;
    const uint lane = gl_LocalInvocationIndex;
    if (first == 0u && lane == 0u) counters.frame_seen = visible[0];
    if (first >= due[0]) return;
    const uint count = min(due[0] - first, kUpdateBlocks);
    if (lane == 0u) voted = flipped = listed = looked_at = 0u;
    if (lane < count) {
        items[lane] = due[1u + first + lane];
        keys[lane] = block_keys[block_of(items[lane])];
        block_listed[lane] = unsettled[lane] = restless[lane] = 0u;
    }
    barrier();
    for (uint slot = 0u; slot < count; ++slot) list_near(slot);
    barrier();
    camera = view.camera;
    camera_m = camera_center_m(camera);
    voxel_m = view.grid.voxel_m;
    const uint end = listed;
    uint votes = 0u, flips = 0u;
    for (uint i = lane; i < end; i += kUpdateLabelsGroup) update_voxel(list[i], votes, flips);
    if (votes > 0u) atomicAdd(voted, votes);
    if (flips > 0u) atomicAdd(flipped, flips);
    barrier();
    if (lane < count) settle(lane);
    barrier();
    if (lane == 0u) {
        atomicAdd(counters.frame_due, looked_at);
        atomicAdd(counters.frame_voxels, voted);
        atomicAdd(counters.frame_flips, flipped);
    }
}
