// Lists the shining pixels in the picture's order, with bearing, distance, radiance and solid angle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera/camera.glsl"
#include "shared/lighting/find_lights.h"

layout(local_size_x = kEmitterGroup) in;
layout(rgba16f, binding = 0) uniform readonly image2D color;
layout(std140, binding = 1) uniform Params { FindLightsParams params; };
layout(std430, binding = 2) readonly buffer Warped { uint warped[]; };
layout(std430, binding = 3) readonly buffer Places { uint places[]; };
layout(std430, binding = 4) writeonly buffer Emitters { Emitter emitters[]; };
layout(push_constant) uniform Push { WarpDepthParams warp; };
#include "lib/lighting/emitters.glsl"

shared uint ranks[kEmitterGroup];

Emitter emitter_at(ivec2 pixel, vec4 value, uint index) {
    const vec3 ray = unproject(params.camera, vec2(pixel));
    const float stretch = length(ray);  // 1 / cos of the angle to the optical axis
    const uint depth = warped[index];
    const float range_m = depth == kNoDepth ? 0.0 : float(depth) / warp.units_per_m * stretch;
    const ivec2 last = ivec2(params.camera.extent) - 1;
    const bool at_border = any(equal(pixel, ivec2(0))) || any(equal(pixel, last));
    // A pixel of one focal length squared, seen under the angle: cos^3 / (fx fy).
    const vec2 focal_px = params.camera.focal_center_px.xy;
    const float angle_sr = 1.0 / (stretch * stretch * stretch * focal_px.x * focal_px.y);
    const uint flags = (value.a == kColorClipped ? kEmitterClipped : 0u) | (at_border ? kEmitterAtBorder : 0u);
    return Emitter(vec4(to_world_direction(params.camera, ray / stretch), range_m),
                   vec4(value.rgb * params.radiance_scale, angle_sr), flags, 0u, 0u, 0u);
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    ivec2 pixel;
    vec4 value;
    const bool emits = shines(gl_GlobalInvocationID.x, pixel, value);
    ranks[lane] = uint(emits);
    barrier();
    for (uint reach = 1u; reach < kEmitterGroup; reach *= 2u) {
        const uint before = lane >= reach ? ranks[lane - reach] : 0u;
        barrier();
        ranks[lane] += before;
        barrier();
    }
    const uint place = places[gl_WorkGroupID.x] + ranks[lane] - 1u;
    if (emits && place < kMaxEmitters) emitters[place] = emitter_at(pixel, value, gl_GlobalInvocationID.x);
}
