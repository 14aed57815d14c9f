#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Restores what of the diffuse albedo is finer than a voxel of the observations: the fused colour over the light,
// scaled so that its mean over the voxels around the point is that of kd. Where no light was marched yet, what is seen
// is the fused colour.
#include "lib/math/mean.glsl"
#include "lib/records/packed_detail.glsl"
#include "shared/shading/restore_detail.h"

layout(local_size_x = kRestoreDetailGroup, local_size_y = kRestoreDetailGroup) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(binding = 2, rgba32ui) uniform readonly uimage2D detail;
layout(binding = 3, rgba16f) uniform readonly image2D light;
layout(binding = 4, rgba16f) uniform readonly image2D rgb;
layout(binding = 5, rgba16f) uniform readonly image2D ks_alpha;
layout(binding = 6, rgba16f) uniform writeonly image2D detailed_kd;
layout(binding = 7, rgba16f) uniform writeonly image2D detailed_rgb;
layout(push_constant) uniform Push { RestoreDetailParams params; };

const int kTaps = 2;              // on each side of the pixel, along each axis
const float kReachVox = 1.0;      // of the taps: as far as kd is interpolated
const float kOffPlaneVox = 0.5;   // farther from the tangent plane is another surface
const float kEvenLight = 0.05;    // shadows that vary by less leave all detail,
const float kUnevenLight = 0.25;  // those that vary by more leave none: it may be their border
const float kMostBrighter = 4.0;  // than the voxels' kd: what is still brighter is a highlight
const float kShading = 0.1;       // relative contrast that normals and light are off by within a voxel,
const float kHighlight = 0.5;     // and that of what highlights leave in a mean of views, over ks / kd

struct Albedos {
    vec3 kd, picture_kd;
};

// The albedos with their detail.
Albedos restored(ivec2 pixel, vec4 hit, Detail own) {
    const float reach_m = kReachVox * params.voxel_m;
    const float step_px = max(reach_m * params.focal_px / hit.w / float(kTaps), 1.0);
    const vec3 facing = imageLoad(normal, pixel).xyz;
    vec3 sum_kd = vec3(0.0), sum_picture_kd = vec3(0.0), sum_apparent = vec3(0.0);
    float least = own.shadow, most = own.shadow, shares = 0.0, sum = 0.0, squares = 0.0;
    for (int y = -kTaps; y <= kTaps; ++y) {
        // Every second one, as on a draughts-board: they tell as much.
        for (int x = -kTaps + (y & 1); x <= kTaps; x += 2) {
            const ivec2 at = pixel + ivec2(round(vec2(x, y) * step_px));
            const vec4 there = imageLoad(position_m, at);  // zero outside the image
            const vec3 away_m = there.xyz - hit.xyz;
            const bool near = there.w > 0.0 && dot(away_m, away_m) < 4.0 * reach_m * reach_m &&
                              abs(dot(away_m, facing)) < kOffPlaneVox * params.voxel_m;
            if (!near) continue;
            const Detail tap = unpack_detail(imageLoad(detail, at));
            if (!tap.lit || !tap.known || tap.shadow < 0.0) continue;
            const float share = exp(-2.0 * dot(away_m, away_m) / (reach_m * reach_m));
            sum_kd += share * tap.kd;
            sum_picture_kd += share * tap.picture_kd;
            sum_apparent += share * tap.apparent;
            const float brightness = mean_of(tap.apparent);
            shares += share;
            sum += share * brightness;
            squares += share * brightness * brightness;
            least = min(least, tap.shadow);
            most = max(most, tap.shadow);
        }
    }
    const vec3 detail = own.apparent / max(sum_apparent, vec3(1e-6));
    const float even = 1.0 - smoothstep(kEvenLight, kUnevenLight, most - least);
    // What the contrast owes to paint, if it is as strong as what it may owe to shading and highlights.
    const float contrast2 = max(squares * shares / max(sum * sum, 1e-12) - 1.0, 0.0);
    const float doubt = kShading + kHighlight * mean_of(imageLoad(ks_alpha, pixel).rgb) / max(mean_of(own.kd), 0.01);
    const float counts = even * contrast2 / (contrast2 + doubt * doubt);
    const vec3 kd = min(min(detail * sum_kd, kMostBrighter * own.kd), vec3(1.0));
    return Albedos(mix(own.kd, kd, counts),
                   mix(own.picture_kd, min(detail * sum_picture_kd, kMostBrighter * own.picture_kd), counts));
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(detail)))) return;
    const vec4 hit = imageLoad(position_m, pixel), shaded = imageLoad(rgb, pixel);
    const Detail own = unpack_detail(imageLoad(detail, pixel));
    const bool lit = hit.w > 0.0 && own.lit, marched = own.shadow >= 0.0;
    Albedos detailed = Albedos(own.kd, own.picture_kd);
    if (lit && !own.known) detailed = Albedos(min(own.apparent, vec3(1.0)), min(own.apparent, vec3(1.0)));
    if (lit && own.known && marched) detailed = restored(pixel, hit, own);
    const vec3 received = imageLoad(light, pixel).rgb;
    const vec3 relit = shaded.rgb + (detailed.picture_kd - own.picture_kd) * received;
    const float known = own.known || lit ? 1.0 : 0.0;
    imageStore(detailed_kd, pixel, vec4(detailed.kd, known));
    imageStore(detailed_rgb, pixel, vec4(lit && !marched ? own.apparent * received : relit, known));
}
