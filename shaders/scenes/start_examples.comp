#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation per voxel: its record without observations, as the map would have it, and its irradiance from afar.
#include "lib/records/observations.glsl"
#include "scenes/example_light.glsl"

layout(local_size_x = kExampleGroup) in;
layout(std430, binding = 6) writeonly buffer Irradiance { vec4 irradiance[]; };
layout(std430, binding = 7) writeonly buffer Records { VoxelRecord records[]; };

void main() {
    const uint voxel = gl_GlobalInvocationID.x, scene = voxel / kExampleVoxels;
    if (scene >= params.scenes) return;
    const vec2 shift = random_numbers(voxel_stream(voxel), 0u, kIrradianceShift).xy;
    irradiance[voxel] = vec4(irradiance_at(scene, voxels[voxel].normal.xyz, shift), 0.0);
    // Any keys serve, as long as they differ: the table that leads from keys to records is not used.
    records[voxel] =
        VoxelRecord(voxel, pack_normal(voxels[voxel].stored_normal.xyz), pack_state(0u, 0u, 1u, 0.0), scene + 1u);
}
