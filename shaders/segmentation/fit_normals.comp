// Fits a plane to the surroundings of each pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/segments/frame_surface.glsl"

layout(local_size_x = 128) in;  // of one row: software devices take a group of several rows longer
layout(binding = 0, r32f) uniform readonly image2D depth_m;
layout(binding = 1, r32ui) uniform writeonly uimage2D normal;
layout(push_constant) uniform Push { FrameSurfaceParams params; };

float load(ivec2 pixel) {
    const ivec2 inside = clamp(pixel, ivec2(0), ivec2(params.extent) - 1);
    return pixel == inside ? imageLoad(depth_m, inside).x : 0.0;
}

// Sums of the normal equations for the gradient of inverse depth, which is linear over a plane's picture.
struct Fit {
    vec3 products;  // xx, xy, yy
    vec2 slopes;
};

void add_pair(inout Fit fit, ivec2 pixel, float z, ivec2 offset, float limit_m) {
    const float before = load(pixel - offset);
    const float after = load(pixel + offset);
    const bool has_before = before > 0.0 && abs(before - z) <= limit_m;
    const bool has_after = after > 0.0 && abs(after - z) <= limit_m;
    const float rise = (has_after ? 1.0 / after : 1.0 / z) - (has_before ? 1.0 / before : 1.0 / z);
    const float sides = float(has_before) + float(has_after);
    const vec2 span = vec2(offset) * sides;
    fit.products += vec3(span.x * span.x, span.x * span.y, span.y * span.y);
    fit.slopes += sides > 0.0 ? span * rise : vec2(0.0);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    const float depth = load(pixel);
    const float z = max(depth, 1e-3);
    const int reach = reach_px(params, z);
    const int diagonal = diagonal_px(reach);
    const float limit_m = jump_limit_m(params, z, reach);
    Fit fit = Fit(vec3(0.0), vec2(0.0));
    add_pair(fit, pixel, z, ivec2(reach, 0), limit_m);
    add_pair(fit, pixel, z, ivec2(0, reach), limit_m);
    add_pair(fit, pixel, z, ivec2(diagonal, diagonal), limit_m);
    add_pair(fit, pixel, z, ivec2(diagonal, -diagonal), limit_m);

    // The plane n . p = -1 has inverse depth -n . ray: n is the inverse depth's gradient times the focal lengths.
    const float determinant = fit.products.x * fit.products.z - fit.products.y * fit.products.y;
    const vec2 slope = vec2(fit.products.z * fit.slopes.x - fit.products.y * fit.slopes.y,
                            fit.products.x * fit.slopes.y - fit.products.y * fit.slopes.x) /
                       max(determinant, 1.0);
    const vec2 from_center = vec2(pixel) - params.focal_center_px.zw;
    const vec3 fitted = -normalize(vec3(slope * params.focal_center_px.xy, 1.0 / z - dot(slope, from_center)));
    const bool known = depth > 0.0 && determinant >= 1.0;
    imageStore(normal, pixel, uvec4(known ? pack_normal(fitted) : 0u));
}
