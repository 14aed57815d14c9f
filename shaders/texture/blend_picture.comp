#version 460
#extension GL_GOOGLE_include_directive : require
// Adds what one picture says of each texel that it truly sees: its colour, less the highlight, over the light there.
// The weight falls with the angle and the square of the distance, and towards the picture's border. One invocation per
// texel.
#include "lib/camera/camera.glsl"
#include "lib/math/octahedral.glsl"
#include "shared/input/convert_color.h"
#include "shared/texture/texture.h"
#include "texture/albedo_states.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool kReflects = true;  // the model says how much light there is; else colours are taken
layout(constant_id = 1) const bool kForEye = false;   // somebody in particular looks at the texels
layout(std430, binding = 0) readonly buffer Texels { SurfaceTexel texels[]; };
layout(std430, binding = 1) buffer Sums { vec4 sums[]; };  // rgb: weighted sum of albedo; a: of weights
layout(binding = 2, rgba16f) uniform readonly image2D color;
layout(binding = 3, r32f) uniform readonly image2D depth_m;  // cast; 0: nothing was hit
layout(binding = 4, rgba16f) uniform readonly image2D kd;
layout(binding = 5, rgba16f) uniform readonly image2D rgb;
layout(binding = 6, rgba16f) uniform readonly image2D light;
layout(std430, binding = 7) buffer Shown { vec4 shown[]; };  // the same of all that pictures show, for an eye
layout(push_constant) uniform Push { BlendPictureParams params; };

const float kLeastCosine = 0.2;
const float kBorder = 0.06;     // of the picture's width, over which weights fall to 0
const float kOffVox = 1.5;      // farther from the cast surface is another one
const float kMostAlbedo = 1.5;  // what is above is a highlight that the model does not know
const float kNear_rad = 0.02;   // about 3 degrees: between views that err alike
const float kAside = 4.0;       // over kNear_rad: from beyond, what is seen beside edges may be another surface
const float kSharpness = 3.0;   // of the preference for views that see most of a texel

struct Corner {
    vec4 light;  // a: 1 where the surface is the texel's
    vec3 highlight;
};

// What the model says at a pixel of the cast images, where that is the texel's surface.
Corner corner_at(ivec2 pixel, float own_m, float tolerance_m) {
    const float hit_m = imageLoad(depth_m, pixel).r;
    if (hit_m <= 0.0 || abs(hit_m - own_m) > tolerance_m) return Corner(vec4(0.0), vec3(0.0));
    if (!kReflects) return Corner(vec4(1.0), vec3(0.0));
    const vec3 shine = imageLoad(light, pixel).rgb;
    const vec4 albedo = imageLoad(kd, pixel);
    const vec3 highlight = albedo.a > 0.0 ? max(imageLoad(rgb, pixel).rgb - albedo.rgb * shine, 0.0) : vec3(0.0);
    return Corner(vec4(shine, 1.0), highlight);
}

// The picture's colour between four pixels; a: whether all of them are worth something.
vec4 color_at(vec2 at) {
    const ivec2 low = ivec2(floor(at));
    const vec2 t = at - vec2(low);
    const vec4 c00 = imageLoad(color, low), c10 = imageLoad(color, low + ivec2(1, 0));
    const vec4 c01 = imageLoad(color, low + ivec2(0, 1)), c11 = imageLoad(color, low + ivec2(1, 1));
    const float worst = min(min(c00.a, c10.a), min(c01.a, c11.a));
    return vec4(mix(mix(c00.rgb, c10.rgb, t.x), mix(c01.rgb, c11.rgb, t.x), t.y), worst);
}

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.texels) return;
    const SurfaceTexel texel = texels[index];
    if (texel.normal == kNoSurface) return;
    const vec3 world_m = uintBitsToFloat(uvec3(texel.x, texel.y, texel.z));
    const vec3 point_m = to_camera(params.camera, world_m);
    if (point_m.z < kNearestDepth) return;
    const vec2 at = project(params.camera, point_m);
    const vec2 inside = min(at, vec2(params.camera.extent) - 1.0 - at);
    const float border_px = min(inside.x, inside.y);
    if (border_px <= 1.0) return;
    const vec3 normal = from_octahedral(unpackSnorm2x16(texel.normal));
    const float range_m = length(point_m);
    const float cosine = -dot(normal, to_world_direction(params.camera, point_m)) / range_m;
    if (cosine < kLeastCosine) return;

    // All four pixels of the cast images around must show this surface. Depth may change by as much as its slope asks.
    const vec2 scale = vec2(imageSize(depth_m)) / vec2(params.camera.extent);
    const vec2 cast_at = (at + 0.5) * scale - 0.5;
    const float pixel_m = point_m.z / (params.camera.focal_center_px.x * scale.x);
    const float tolerance_m = kOffVox * params.gain_voxel_m.w + 2.0 * pixel_m * sqrt(1.0 - cosine * cosine) / cosine;
    const ivec2 low = ivec2(floor(cast_at));
    const vec2 t = cast_at - vec2(low);
    vec4 shine = vec4(0.0);
    vec3 highlight = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        const ivec2 step = ivec2(i & 1, i >> 1);
        const Corner corner = corner_at(low + step, point_m.z, tolerance_m);
        if (corner.light.a == 0.0) return;
        const vec2 share = mix(1.0 - t, t, vec2(step));
        shine += share.x * share.y * corner.light;
        highlight += share.x * share.y * corner.highlight;
    }
    const vec4 seen = color_at(at);
    const bool tells = seen.a == kColorValid;
    if (seen.a == kColorInvalid || !(tells || kForEye) || any(lessThan(shine.rgb, vec3(kLeastShownLight)))) return;
    const vec3 own = seen.rgb / params.gain_voxel_m.rgb - highlight;
    const vec3 diffuse = kForEye ? own : max(own, 0.0);
    const vec3 albedo = diffuse / shine.rgb;
    if (tells && any(greaterThan(albedo, vec3(kMostAlbedo)))) return;

    const float clear = kForEye ? 1.0 : dot(diffuse, vec3(1.0)) / max(dot(diffuse + highlight, vec3(1.0)), 1e-6);
    const float fade = smoothstep(0.0, kBorder * float(params.camera.extent.x), border_px);
    float sight = cosine / (range_m * range_m), agrees = 1.0;
    if (kForEye) {
        // Who looks sees no more than that. Pictures from there err least: what is wrong with poses, with the surface
        // and with the light shifts them alike.
        const vec3 to_eye_m = vec3(params.eye_x_m, params.eye_y_m, params.eye_z_m) - world_m;
        const float away_m = length(to_eye_m);
        const vec3 to_eye = to_eye_m / away_m;
        sight = min(sight, max(dot(normal, to_eye), kLeastCosine) / (away_m * away_m));
        const vec3 to_picture = -to_world_direction(params.camera, point_m) / range_m;
        const float between = length(to_eye - to_picture) / kNear_rad;
        agrees = 1.0 / pow(1.0 + between * between, 2.0);
        if (seen.a == kColorAtEdge && between > kAside) return;
    }
    const float weight = pow(sight, kSharpness) * agrees * fade * max(clear * clear, 1e-3);
    const vec4 says = vec4(weight * albedo, weight);
    if (tells) sums[index] += says;
    if (kForEye) shown[index] += says;
}
