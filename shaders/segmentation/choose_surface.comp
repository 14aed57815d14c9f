// Puts together what is known of the surface in each pixel: the model where it agrees with the frame, else the frame.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "shared/find_edges.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(binding = 0, rgba32f) uniform readonly image2D model_position_m;  // world; w: depth, 0 where nothing was hit
layout(binding = 1, rgba16f) uniform readonly image2D model_normal;      // world
layout(binding = 2, r32f) uniform readonly image2D depth_m;
layout(binding = 3, rgba16f) uniform readonly image2D normal;  // world
layout(binding = 4, rgba32f) uniform writeonly image2D surface;
layout(push_constant) uniform Push { ChooseSurfaceParams params; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.camera.extent)))) return;
    const float model_z = imageLoad(model_position_m, pixel).w;
    const vec3 model_n = imageLoad(model_normal, pixel).xyz;
    const float frame_z = imageLoad(depth_m, pixel).x;
    const vec3 frame_n = imageLoad(normal, pixel).xyz;

    const vec3 ray = to_world_direction(params.camera, unproject(params.camera, vec2(pixel)));
    const float distance_m = abs(dot(model_n, ray) * (frame_z - model_z));
    const float sigma_m = params.noise_floor_m + params.noise_per_m * frame_z * frame_z;
    const bool agrees = frame_z == 0.0 || distance_m <= params.agreement_floor_m + params.agreement_sigmas * sigma_m;
    const bool use_model = model_z > 0.0 && dot(model_n, model_n) > 0.0 && agrees;

    const float z = use_model ? model_z : frame_z;
    const vec3 world_n = use_model ? model_n : frame_n;
    imageStore(surface, pixel, z > 0.0 ? vec4(mat3(params.camera.camera_from_world) * world_n, z) : vec4(0.0));
}
