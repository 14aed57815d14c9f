// Brings depth into the colour camera's picture: the nearest reading whose pixel covers each colour pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera/camera.glsl"
#include "shared/lighting/find_lights.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(r32f, binding = 0) uniform readonly image2D depth_m;
layout(std140, binding = 1) uniform Params { FindLightsParams params; };
layout(std430, binding = 2) buffer Warped { uint warped[]; };  // per colour pixel, kNoDepth where there is none
layout(push_constant) uniform Push { WarpDepthParams warp; };

void main() {
    const uvec2 source = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(source, warp.depth_camera.extent))) return;
    const float z_m = imageLoad(depth_m, ivec2(source)).x;
    if (z_m <= 0.0) return;
    const vec3 direction = to_world_direction(warp.depth_camera, unproject(warp.depth_camera, vec2(source)));
    const vec3 point_m = to_camera(params.camera, camera_center_m(warp.depth_camera) + z_m * direction);
    if (point_m.z <= 0.0) return;
    const ivec2 center = ivec2(floor(project(params.camera, point_m) + 0.5));
    const uint depth = uint(point_m.z * warp.units_per_m + 0.5);
    const int reach = int(warp.reach_px);
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            const ivec2 at = center + ivec2(x, y);
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(params.camera.extent)))) continue;
            atomicMin(warped[at.y * int(params.camera.extent.x) + at.x], depth);
        }
    }
}
