// Body of the shaders that add what glossy surfaces mirror of what is around them. The includer declares the map's
// table, distances and colours and how to load them, as lib/lighting/incident_light.glsl says.
#include "lib/brdf/ward.glsl"
#include "lib/math/random.glsl"
#include "shared/lighting/lights.h"
#include "shared/reflectance/far_field.h"
#include "shared/reflectance/surroundings.h"
#include "shared/shading/reflect_surroundings.h"

layout(local_size_x = kReflectGroupX, local_size_y = kReflectGroupY) in;
layout(constant_id = 1) const uint kRays = 8u;  // of a pixel at most
layout(std140, binding = 0) uniform Lights {
    LightHeader header;
    PointLight lights[kMaxPointLights];
};
layout(binding = 1, rgba32f) uniform readonly image2D position_m;
layout(binding = 2, rgba16f) uniform readonly image2D normal;
layout(binding = 3, rgba16f) uniform readonly image2D rgb;
layout(std430, binding = 7) readonly buffer Glossy { GlossyPixel glossy[]; };
layout(std430, binding = 8) readonly buffer Surroundings{SURROUNDINGS_MEMBERS};
layout(binding = 9, rgba16f) uniform writeonly image2D reflecting_rgb;
layout(push_constant) uniform Push { ReflectParams params; };
#include "lib/lighting/incident_light.glsl"

const float kLeastGloss = 0.06;  // a specular albedo below which nobody sees what is mirrored,
const float kMostGloss = 0.5;    // and from which on every ray is worth its time
const float kLeastAlpha = 0.01;

vec4 unpack_halves(uvec2 packed) { return vec4(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y)); }

// The radiance that a gloss of 1 sends to the viewer. Rays that meet nothing known bring the light from all around.
vec3 mirrored(uvec2 pixel, vec3 point_m, vec3 facing, float alpha, vec3 indirect, uint rays) {
    grid = params.voxels;
    const vec3 to_viewer = normalize(params.ball_m.xyz - point_m);
    const uvec2 stream = random_stream(pixel, 0u, 0u);
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < rays; ++i) {
        const vec2 u = unit_interval(stratified_words(stream, i, 0u)).xy;
        const vec3 direction = sample_ward(alpha, facing, to_viewer, u);
        const float density = ward_density(alpha, facing, direction, to_viewer);
        if (density == 0.0) continue;
        const float weight = ward_lobe(alpha, facing, direction, to_viewer) * dot(facing, direction) / density;
        const Incident light = incident_light(point_m / grid.voxel_m, facing, direction, params.ball_m);
        sum += weight * (light.known ? light.radiance : indirect);
    }
    return sum / float(rays);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), extent = imageSize(rgb);
    if (any(greaterThanEqual(pixel, extent))) return;
    vec4 seen = imageLoad(rgb, pixel);
    const GlossyPixel here = glossy[pixel.y * extent.x + pixel.x];
    const vec4 gloss = unpack_halves(here.ks_alpha);
    const vec3 facing = imageLoad(normal, pixel).xyz;
    const float most = max(max(gloss.r, gloss.g), gloss.b);
    const bool reflects = seen.a > 0.0 && facing != vec3(0.0) && most > kLeastGloss;
    // The noise of a picture is that of the mean times ks.
    const uint rays = uint(clamp(ceil(float(kRays) * most / kMostGloss), 1.0, float(kRays)));
    vec3 arrives = unpack_halves(here.indirect).rgb;
    if (reflects) {
        arrives = mirrored(uvec2(pixel), imageLoad(position_m, pixel).xyz, normalize(facing), max(gloss.a, kLeastAlpha),
                           arrives, rays);
    }
    seen.rgb += seen.a > 0.0 ? gloss.rgb * arrives : vec3(0.0);
    imageStore(reflecting_rgb, pixel, seen);
}
