#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// One iteration's normal equations. Each reading is moved by the pose found so far into the model's view, and paired
// with the model's pixel there (projective association, Blais and Levine 1995); its distance from the tangent plane
// (Chen and Medioni 1992) and the difference of shades are linear in a small motion. Each group adds up its pixels
// always in the same order.
#include "lib/tracking/track_pixels.glsl"

layout(local_size_x = kTrackGroupX, local_size_y = kNormalEquationsGroupY) in;
layout(binding = 0, r32ui) uniform readonly uimage2D frame_pixels;
layout(binding = 1, rgba32ui) uniform readonly uimage2D model_pixels;
layout(std430, binding = 2) readonly buffer State { TrackState state; };
layout(std430, binding = 3) writeonly buffer Sums { float sums[]; };  // kTrackSums per group
layout(push_constant) uniform Push { NormalEquationsParams params; };

layout(constant_id = 0) const bool kShaded = true;  // shades are compared

const uint kInvocations = kTrackGroupX * kNormalEquationsGroupY;
const float kNearest_m = 0.05f;

shared float partial[kTrackSums][kInvocations + 1u];

// The sums, one by one: software devices keep an array in memory. The upper triangle, of motion along (t) and around
// (r) the axes, by rows: t times t, t times r, r times r; then the right side.
vec3 tx_t, tx_r, ty_r, tz_r, rx_r, t_right, r_right;
vec2 ty_t, ry_r;
float tz_t, rz_r;
float readings, pairs, squares, weights, depths, shades, shade_squares, shade_product, shade_own;
// What all pixels of the invocation's column share; software devices do not hoist it out of loops.
vec3 translation_m, column_ray, row_ray;  // a pixel's ray in the model's view: column_ray + row row_ray
vec2 inverse_model_focal;
float gain, center_m, inverse_lever, inverse_robust_sigmas, inverse_robust_shade, shade_weight;

// The rotation matrix of a unit quaternion.
mat3 matrix_of(vec4 q) {
    const vec3 twice = 2.0 * q.xyz;
    const vec3 own = q.xyz * twice;
    const vec3 cross_terms = q.xxy * twice.yzz, with_w = q.w * twice;
    return mat3(1.0 - own.y - own.z, cross_terms.x + with_w.z, cross_terms.y - with_w.y,  //
                cross_terms.x - with_w.z, 1.0 - own.x - own.z, cross_terms.z + with_w.x,  //
                cross_terms.y + with_w.y, cross_terms.z - with_w.x, 1.0 - own.x - own.y);
}

// Geman and McClure's: 1/4 at 1.
float robust_weight(float share) {
    const float inverse = 1.0 / (1.0 + share * share);
    return inverse * inverse;
}

// Adds weight (residual + (along, around) . motion)^2 to what is minimised.
void add_equation(vec3 along, vec3 around, float residual, float weight) {
    const vec3 t = weight * along, r = weight * around;
    tx_t += t.x * along;
    ty_t += t.y * along.yz;
    tz_t += t.z * along.z;
    tx_r += t.x * around;
    ty_r += t.y * around;
    tz_r += t.z * around;
    rx_r += r.x * around;
    ry_r += r.y * around.yz;
    rz_r += r.z * around.z;
    t_right += residual * t;
    r_right += residual * r;
}

// Without branches. Outside the image zero is read, which is no reading.
void add_pixel(ivec2 pixel) {
    const uint own = imageLoad(frame_pixels, pixel).x;
    const float z = frame_depth_m(own);
    const vec3 point = z * (column_ray + float(pixel.y) * row_ray) + translation_m;
    const float inverse_z = 1.0 / max(point.z, kNearest_m);
    const vec2 at = point.xy * inverse_z * params.model_focal_center_px.xy + params.model_focal_center_px.zw;
    const vec2 nearest = floor(at + 0.5);
    const bool in_view = z > 0.0 && point.z > kNearest_m && all(greaterThanEqual(nearest, vec2(0.0))) &&
                         all(lessThan(nearest, vec2(params.model_extent)));
    const ModelPixel model = unpack_model_pixel(imageLoad(model_pixels, ivec2(in_view ? nearest : vec2(0.0))));
    const vec2 model_ray = (nearest - params.model_focal_center_px.zw) * inverse_model_focal;
    const vec3 apart = point - vec3(model_ray, 1.0) * model.depth_m;
    const float distance_m = dot(model.normal, apart);
    const float gate_m = params.gate_m + params.gate_slope * z;
    const bool paired = in_view && model.depth_m > 0.0 && dot(apart, apart) <= gate_m * gate_m;

    const float inverse_sigma = 1.0 / (params.noise_floor_m + params.noise_per_m * z * z);
    const float sigmas = distance_m * inverse_sigma;
    const float trust = paired ? robust_weight(sigmas * inverse_robust_sigmas) : 0.0;
    const float weight = trust * inverse_sigma * inverse_sigma;
    const vec3 lever = (point - vec3(0.0, 0.0, center_m)) * inverse_lever;
    add_equation(model.normal, cross(lever, model.normal), distance_m, weight);
    readings += z > 0.0 ? 1.0 : 0.0;
    pairs += trust;
    squares += trust * sigmas * sigmas;
    weights += weight;
    depths += z;

    if (kShaded) {
        const float own_shade = frame_shade(own);
        const float model_shade = model.shade + dot(model.shade_per_px, at - nearest);
        const float difference = gain * own_shade - model_shade;
        const bool shaded = model.shade >= 0.0 && frame_has_shade(own);
        const float shade_trust = shaded ? trust * robust_weight(difference * inverse_robust_shade) : 0.0;
        const vec2 per_m = model.shade_per_px * params.model_focal_center_px.xy * inverse_z;
        const vec3 along = -vec3(per_m, -dot(per_m, point.xy) * inverse_z);
        add_equation(along, cross(lever, along), difference, shade_trust * shade_weight);
        shades += shade_trust;
        shade_squares += shade_trust * difference * difference;
        shade_product += shade_trust * own_shade * model_shade;
        shade_own += shade_trust * own_shade * own_shade;
    }
}

void put(uint i, float sum) { partial[i][gl_LocalInvocationIndex] = sum; }
void put(uint i, vec2 sum) {
    put(i, sum.x);
    put(i + 1u, sum.y);
}
void put(uint i, vec3 sum) {
    put(i, sum.xy);
    put(i + 2u, sum.z);
}

void begin_column(uint x) {
    const mat3 rotation = matrix_of(state.rotation);
    const vec4 camera = params.frame_focal_center_px;
    row_ray = rotation[1] / camera.y;
    column_ray = rotation * vec3((float(x) - camera.z) / camera.x, -camera.w / camera.y, 1.0);
    translation_m = state.translation_m.xyz;
    inverse_model_focal = 1.0 / params.model_focal_center_px.xy;
    gain = state.gain;
    center_m = state.center_m;
    inverse_lever = 1.0 / state.lever_m;
    inverse_robust_sigmas = 1.0 / params.robust_sigmas;
    inverse_robust_shade = 1.0 / params.robust_shade;
    shade_weight = 1.0 / (params.shade_sigma * params.shade_sigma);
}

void main() {
    begin_column(gl_GlobalInvocationID.x);
    tx_t = tx_r = ty_r = tz_r = rx_r = t_right = r_right = vec3(0.0);
    ty_t = ry_r = vec2(0.0);
    tz_t = rz_r = 0.0;
    readings = pairs = squares = weights = depths = shades = shade_squares = shade_product = shade_own = 0.0;
    const uvec2 first = uvec2(gl_GlobalInvocationID.x,
                              gl_WorkGroupID.y * kNormalEquationsGroupY * params.rows + gl_LocalInvocationID.y);
    // Written out one after the other: inside a loop software devices mask each sum's every change.
    for (uint row = 0u; row < params.rows; row += kNormalEquationsUnrolled) {
        [[unroll]] for (uint i = 0u; i < kNormalEquationsUnrolled; ++i)
            add_pixel(ivec2(first + uvec2(0u, (row + i) * kNormalEquationsGroupY)));
    }
    const uint lane = gl_LocalInvocationIndex;
    put(kTrackMatrix, tx_t);
    put(kTrackMatrix + 3u, tx_r);
    put(kTrackMatrix + 6u, ty_t);
    put(kTrackMatrix + 8u, ty_r);
    put(kTrackMatrix + 11u, tz_t);
    put(kTrackMatrix + 12u, tz_r);
    put(kTrackMatrix + 15u, rx_r);
    put(kTrackMatrix + 18u, ry_r);
    put(kTrackMatrix + 20u, rz_r);
    put(kTrackRight, t_right);
    put(kTrackRight + 3u, r_right);
    put(kTrackReadings, readings);
    put(kTrackPairs, pairs);
    put(kTrackSquares, squares);
    put(kTrackWeight, weights);
    put(kTrackDepth, depths);
    put(kTrackShades, shades);
    put(kTrackShadeSquares, shade_squares);
    put(kTrackShadeProduct, shade_product);
    put(kTrackShadeOwn, shade_own);
    barrier();
    if (lane >= kTrackSums) return;
    float total = 0.0;
    for (uint i = 0u; i < kInvocations; ++i) total += partial[lane][i];
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    sums[group * kTrackSums + lane] = total;
}
