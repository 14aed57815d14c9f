// Turns depth into world positions, and their central differences into normals.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera/camera.glsl"
#include "shared/input/unproject_depth.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(binding = 0, r32f) uniform readonly image2D depth_m;
layout(binding = 1, rgba32f) uniform writeonly image2D position_m;
layout(binding = 2, rgba16f) uniform writeonly image2D normal;
layout(push_constant) uniform Push { UnprojectDepthParams params; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 last = ivec2(params.camera.extent) - 1;
    if (any(greaterThan(pixel, last))) return;

    const ivec2 low = max(pixel - 1, ivec2(0));
    const ivec2 high = min(pixel + 1, last);
    const float z = imageLoad(depth_m, pixel).x;
    const float left = imageLoad(depth_m, ivec2(low.x, pixel.y)).x;
    const float right = imageLoad(depth_m, ivec2(high.x, pixel.y)).x;
    const float up = imageLoad(depth_m, ivec2(pixel.x, low.y)).x;
    const float down = imageLoad(depth_m, ivec2(pixel.x, high.y)).x;

    const bool valid = z > 0.0;
    const vec3 ray = unproject(params.camera, vec2(pixel));
    const vec3 world = to_world_direction(params.camera, ray * z) + camera_center_m(params.camera);
    imageStore(position_m, pixel, valid ? vec4(world, 1.0) : vec4(0.0));

    const vec4 neighbors = vec4(left, right, up, down);
    const bool inside = all(equal(high - low, ivec2(2)));
    const float max_jump_m = params.jump_floor_m + params.jump_relative * z;
    const bool on_one_surface = valid && inside && all(greaterThan(neighbors, vec4(0.0))) &&
                                all(lessThanEqual(abs(neighbors - z), vec4(max_jump_m)));
    // The cross product (down - up) x (right - left) of the unprojected neighbours, divided by the length of each
    // pair's step along the picture plane. Its dot product with the ray is -1: it always faces the camera.
    const vec2 slope = params.camera.focal_center_px.xy * (neighbors.yw - neighbors.xz) / (neighbors.yw + neighbors.xz);
    const vec3 facing = normalize(vec3(slope, -1.0 - dot(slope, ray.xy)));
    imageStore(normal, pixel, on_one_surface ? vec4(to_world_direction(params.camera, facing), 0.0) : vec4(0.0));
}
