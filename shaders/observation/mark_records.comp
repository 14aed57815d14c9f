#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the records of the voxels that pixels see, each once, and the voxels that are seen for the first time.
#include "lib/records/record_list.glsl"
#include "shared/observation/observations.h"

layout(local_size_x = kObservationGroupX, local_size_y = kObservationGroupY) in;
layout(std140, binding = 0) uniform Observation { ObservationParams frame; };
layout(std430, binding = 1) readonly buffer PixelVoxels { uint pixel_voxels[]; };
layout(std430, binding = 2) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 3) coherent buffer RecordTable { uint record_table[]; };
layout(std430, binding = 4) coherent buffer Seen { uint seen[]; };
layout(std430, binding = 5) buffer Counters { MapCounters counters; };
layout(std430, binding = 6) writeonly buffer NewVoxels { uint new_voxels[]; };
layout(std430, binding = 7) buffer Visible { uint visible[]; };
layout(std430, binding = 8) buffer VisibleArguments { uint visible_arguments[]; };

void mark(uint entry) {
    uint record = record_table[entry];
    if (record == kNoRecord) {
        record = atomicCompSwap(record_table[entry], kNoRecord, kNewRecord);
        if (record == kNoRecord) new_voxels[atomicAdd(counters.new_keys, 1u)] = entry;
    }
    if (record >= kNewRecord || seen[record] >= frame.stamp) return;
    if (atomicMax(seen[record], frame.stamp) < frame.stamp) APPEND_RECORD(visible, visible_arguments, record)
}

void main() {
    const uvec2 item = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(item, frame.visited))) return;
    const uint found = pixel_voxels[item.y * frame.visited.x + item.x];
    if (found == 0xffffffffu) return;
    const uint block = blocks[found >> 6];
    if (block != kNoBlock) mark(block << 3u * frame.edge_shift | (found & 0x3fu));
}
