#version 460
#extension GL_GOOGLE_include_directive : require
// Of the observations' blocks, those whose keys have their turn: gives back the records of voxels in which the voxel
// map has no surface any more, then the blocks that are left without any. A group looks at kReclaimGroup block ids.
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/observation/observations.h"
#include "shared/observation/reclaim.h"
#include "shared/reflectance/reflectance.h"

layout(local_size_x = kReclaimGroup) in;
layout(std430, binding = 0) readonly buffer VoxelKeys { uvec4 voxel_keys[]; };
layout(std430, binding = 1) readonly buffer VoxelBlocks { uint voxel_blocks[]; };
layout(std430, binding = 2) readonly buffer Tsdf { uvec4 quads[]; }
tsdf[kMaxVoxelChunks];
layout(std430, binding = 7) buffer BlockCounters { MapCounters blocks; };
layout(std430, binding = 8) buffer RecordCounters { MapCounters counted; };
layout(std430, binding = 9) buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 10) buffer RecordTable { uint record_table[]; };
layout(std430, binding = 11) writeonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 12) writeonly buffer FreeBlocks { uint free_blocks[]; };
layout(std430, binding = 13) writeonly buffer FreeRecords { uint free_records[]; };
layout(std430, binding = 14) writeonly buffer Status { RecordStatus status[]; };
layout(push_constant) uniform Push { ReclaimParams params; };

#define KEYS(bucket) voxel_keys[bucket]
#define BLOCK(slot) voxel_blocks[slot]
#include "lib/map/block_lookup.glsl"

shared uint due[kReclaimGroup];
shared uint due_count;
shared uint near[2];  // a bit per observation voxel of a block: it holds surface
shared uint left;     // records of a block that stay

bool is_near(uint voxel) { return voxel_weight(voxel) > 0u && abs(voxel_sdf(voxel)) < params.surface_limit; }

// Which observation voxels hold the four voxels of a quad that are near the surface. A quad is a row along x.
void mark_near(uint voxel_block, uint quad) {
    const uint at = index_in_chunk(params.voxels.chunk_shift, voxel_block) * (kBlockVoxels / 4u) + quad;
    uvec4 voxels;
#define LOAD_TSDF(C) voxels = tsdf[C].quads[at]
    WITH_CHUNK(params.voxels.chunk_shift, voxel_block, LOAD_TSDF)
    const uint within = 3u - params.edge_shift;  // log2 of the voxels along an observation voxel's edge
    const uint y = quad >> 1u & 7u, z = quad >> 4u;
    const uint row = (y >> within) << params.edge_shift | (z >> within) << 2u * params.edge_shift;
    for (uint i = 0u; i < 4u; ++i) {
        if (!is_near(voxels[i])) continue;
        const uint number = ((quad & 1u) * 4u + i) >> within | row;
        atomicOr(near[number >> 5], 1u << (number & 31u));
    }
}

void give_back_record(uint record) {
    records[record] = VoxelRecord(kEmptyKey, 0u, 0u, 0u);
    status[record] = RecordStatus(0u, 0u, 0u, 0u, uvec2(0u));
    free_records[atomicAdd(counted.free_blocks, 1u)] = record;
    atomicAdd(counted.deleted_blocks, 1u);
}

void give_back_block(uint block) {
    block_keys[block] = kEmptyKey;
    free_blocks[atomicAdd(blocks.free_blocks, 1u)] = block;
    atomicAdd(blocks.deleted_blocks, 1u);
}

void look_at(uint block) {
    const uint lane = gl_LocalInvocationIndex;
    if (lane < 2u) near[lane] = 0u;
    if (lane == 0u) left = 0u;
    barrier();
    const uint voxel_block = find_block(params.voxels, block_of_key(params.voxels, block_keys[block]));
    if (voxel_block != kNoBlock)
        for (uint quad = lane; quad < kBlockVoxels / 4u; quad += kReclaimGroup) mark_near(voxel_block, quad);
    barrier();
    const uint count = 1u << 3u * params.edge_shift;
    if (lane < count) {
        const uint record = record_table[block * count + lane];
        const bool holds_surface = (near[lane >> 5] >> (lane & 31u) & 1u) != 0u;
        if (record < kNewRecord && holds_surface) {
            atomicAdd(left, 1u);
        } else {
            if (record < kNewRecord) give_back_record(record);
            record_table[block * count + lane] = kNoRecord;  // what was refused may ask again
        }
    }
    barrier();
    if (lane == 0u && left == 0u) give_back_block(block);
    barrier();
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) due_count = 0u;
    barrier();
    const uint id = gl_GlobalInvocationID.x;
    const uint key = id < blocks.high_water ? block_keys[id] : kEmptyKey;
    if (key != kEmptyKey && hash_of_key(key) % kReclaimParts == params.part) due[atomicAdd(due_count, 1u)] = id;
    barrier();
    const uint count = due_count;
    for (uint i = 0u; i < count; ++i) look_at(due[i]);
}
