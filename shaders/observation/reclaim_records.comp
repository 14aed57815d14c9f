#version 460
#extension GL_GOOGLE_include_directive : require
// Of the observations' blocks, those whose keys have their turn: gives back the records of voxels in which the voxel
// map has no surface any more, then the blocks that are left without any. A group looks at kReclaimGroup block ids; an
// invocation at one of those that are due, side by side in the list, so that those beside it have work, too.
#include "lib/map/stream_region.glsl"
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
layout(std430, binding = 15) writeonly buffer Gathered { RecordSurroundings gathered[]; };
layout(push_constant) uniform Push { ReclaimParams params; };

#define KEYS(bucket) voxel_keys[bucket]
#define BLOCK(slot) voxel_blocks[slot]
#include "lib/map/block_lookup.glsl"

shared uint due[kReclaimGroup];
shared uint due_count;

bool is_near(uint voxel) { return voxel_weight(voxel) > 0u && abs(voxel_sdf(voxel)) < params.surface_limit; }

// Whether an observation voxel of a block, `number` in the order of the record table, holds a voxel near the surface.
// A quad is a row of four voxels along x; what has surface is known by its first one near it.
bool holds_surface(uint voxel_block, uint number) {
    const uint within = 3u - params.edge_shift;  // log2 of the voxels along an observation voxel's edge
    const uint edge = 1u << within, mask = (1u << params.edge_shift) - 1u;
    const uvec3 corner = uvec3(number & mask, number >> params.edge_shift & mask, number >> 2u * params.edge_shift)
                         << within;
    const uint first = index_in_chunk(params.voxels.chunk_shift, voxel_block) * (kBlockVoxels / 4u) + (corner.x >> 2u);
    const uint begin = corner.x & 3u, end = min(begin + edge, 4u), quads_along_x = max(edge >> 2u, 1u);
    for (uint z = corner.z; z < corner.z + edge; ++z) {
        for (uint y = corner.y; y < corner.y + edge; ++y) {
            for (uint x = 0u; x < quads_along_x; ++x) {
                const uint at = first + x + 2u * (y + 8u * z);
                uvec4 voxels;
#define LOAD_TSDF(C) voxels = tsdf[C].quads[at]
                WITH_CHUNK(params.voxels.chunk_shift, voxel_block, LOAD_TSDF)
                for (uint i = begin; i < end; ++i)
                    if (is_near(voxels[i])) return true;
            }
        }
    }
    return false;
}

void give_back_record(uint record) {
    records[record] = VoxelRecord(kEmptyKey, 0u, 0u, 0u);
    status[record] = RecordStatus(0u, 0u, 0u, 0u, uvec2(0u), uvec2(0u), 0u, 0u);
    gathered[record] = RecordSurroundings(uvec2(0u), 0u, 0u);
    free_records[atomicAdd(counted.free_blocks, 1u)] = record;
    atomicAdd(counted.deleted_blocks, 1u);
}

void give_back_block(uint block) {
    block_keys[block] = kEmptyKey;
    free_blocks[atomicAdd(blocks.free_blocks, 1u)] = block;
    atomicAdd(blocks.deleted_blocks, 1u);
}

void look_at(uint block) {
    const uint voxel_block = find_block(params.voxels, block_of_key(params.voxels, block_keys[block]));
    const uint count = 1u << 3u * params.edge_shift;
    uint left = 0u;  // records that stay
    for (uint number = 0u; number < count; ++number) {
        const uint at = block * count + number, record = record_table[at];
        if (record < kNewRecord && voxel_block != kNoBlock && holds_surface(voxel_block, number)) {
            ++left;
        } else {
            if (record < kNewRecord) give_back_record(record);
            record_table[at] = kNoRecord;  // what was refused may ask again
        }
    }
    if (left == 0u) give_back_block(block);
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) due_count = 0u;
    barrier();
    const uint id = gl_GlobalInvocationID.x;
    const uint key = id < blocks.high_water ? block_keys[id] : kEmptyKey;
    if (key != kEmptyKey && hash_of_key(key) % kReclaimParts == params.part && stays(params.voxels, params.region, key))
        due[atomicAdd(due_count, 1u)] = id;
    barrier();
    if (lane < due_count) look_at(due[lane]);
}
