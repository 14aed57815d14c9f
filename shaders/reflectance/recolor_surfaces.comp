#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Gives the voxels of each record what its surface sends under the present lights, in place of what frames showed.
#include "shared/reflectance/reflectance.h"

layout(local_size_x = kRecordGroup) in;
layout(std140, binding = 0) uniform Lights {
    LightHeader header;
    PointLight lights[kMaxPointLights];
};
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) readonly buffer March { uint listed[]; };
layout(std430, binding = 3) readonly buffer Albedo { uvec2 albedo[]; };
layout(std430, binding = 4) readonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 5) readonly buffer Status { RecordStatus status[]; };
layout(std430, binding = 6) readonly buffer Gathered { RecordSurroundings gathered[]; };
layout(std430, binding = 7) readonly buffer Segments { SegmentAlbedo segments[]; };
layout(std430, binding = 8) readonly buffer Materials { SegmentMaterial materials[]; };
layout(std430, binding = 9) readonly buffer Keys { uvec4 buckets[]; };
layout(std430, binding = 10) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 11) writeonly buffer Color { uint voxels[]; }
color[kMaxVoxelChunks];
layout(push_constant) uniform Push { ReflectanceParams params; };
layout(constant_id = 1) const uint kGathers = 0u;  // 1: what records gathered counts, too
#define KEYS(bucket) buckets[bucket]
#define BLOCK(slot) blocks[slot]
#include "lib/map/block_lookup.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/records/blend_records.glsl"
#include "lib/records/gathered_light.glsl"
#include "lib/records/lamp_light.glsl"

const uint kToNearest = 0x20080200u;  // half a step of each channel, which pack_color adds before it cuts off

// What the surface sends into the room, alike to all sides; a is 0 where its albedo is not known.
vec4 sent_by(uint record) {
    const VoxelRecord known = records[record];
    const vec3 normal = surface_normal(known);
    const vec3 point_m = surface_point_m(known, params.records, params.edge_shift);
    RecordSums sums = no_records();
    const uvec4 content = pack_record(known, albedo[record], true, 0u);
    const SurfacePoint own = SurfacePoint(normal * surface_offset_vox(known), normal, normal);
    add_record(sums, own, record, content, gathered[record].around, own.at_vox, 1.0);
    const uint label = record_label(known);
    const bool has_entry = label != 0u && label < params.materials;
    const SegmentMaterial material = materials[has_entry ? label : 0u];
    const vec4 segment = has_entry ? segment_kd(segments[label]) : vec4(0.0);
    const Reflectance found = with_segment(mean_of(sums), segment, normal);
    const GatheredLight light = unpack_gathered(status[record].incident);
    const vec3 around = kGathers != 0u ? gathered_irradiance(light, header.ambient.rgb) : header.ambient.rgb;
    vec3 received = around;
    for (uint i = 0u; i < header.count; ++i)
        received += bit_is_set(visibility[record], i) ? lamp_light(i, point_m, normal) : vec3(0.0);
    const vec3 ks = has_entry ? material.ks_alpha.rgb * (1.0 - material.unobserved) : vec3(0.0);
    return found.known ? vec4(found.kd * received + ks * around, 1.0) : vec4(0.0);
}

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= listed[0]) return;
    const uint record = listed[1u + item];
    const vec4 sent = sent_by(record);
    const ivec3 block_at = block_of_key(params.records, records[record].block_key);
    const uint block = find_block(params.voxels, block_at);
    if (block == kNoBlock) return;
    const uint packed = sent.a > 0.0 ? pack_color(sent.rgb, kToNearest) : 0u;
    const uint edge = kBlockEdge >> params.edge_shift;  // of a record, voxels
    const ivec3 first = (voxel_of_record(block_at, voxel_in_block(records[record]), params.edge_shift) -
                         (block_at << int(params.edge_shift))) *
                        int(edge);
    const uint base = index_in_chunk(params.voxels.chunk_shift, block) * kBlockVoxels;
    for (uint i = 0u; i < edge * edge * edge; ++i) {
        const uvec3 at = uvec3(first) + uvec3(i % edge, i / edge % edge, i / (edge * edge));
        const uint index = base + (at.z << 6 | at.y << 3 | at.x);
#define STORE_COLOR(C) color[C].voxels[index] = packed
        WITH_CHUNK(params.voxels.chunk_shift, block, STORE_COLOR)
    }
}
