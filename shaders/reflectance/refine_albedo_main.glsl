// Body of the shaders that refine albedos: the diffuse albedo of a voxel from all its observations, given the specular
// part of its segment's material (paper, Section 3.7, Eq. 7). Lights and surface are the same for all of them, so Eq. 7
// is the mean of what is left of the observed colours without their highlights, over the irradiance. A robust mean:
// lights, normals and materials are estimates, and what they are off by shows most in highlights. The includer declares
// the records' directions and colours.
//
// One invocation per record; lights in the outer loop, so that what a light and a surface have in common is computed
// once, and observations unrolled in the inner one.
#include "lib/brdf/ward.glsl"
#include "lib/lighting/lamp_emission.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/math/mean.glsl"
#include "lib/math/pi.glsl"
#include "lib/records/gathered_light.glsl"
#include "lib/records/reflectance.glsl"

layout(local_size_x = kRecordGroup) in;
layout(std140, binding = 0) uniform Lights {
    LightHeader header;
    PointLight lights[kMaxPointLights];
};
layout(std430, binding = 1) readonly buffer Materials { SegmentMaterial materials[]; };
layout(std430, binding = 2) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 3) readonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 4) readonly buffer Refine { uint refine[]; };
layout(std430, binding = 5) buffer Status { RecordStatus status[]; };
layout(std430, binding = 6) buffer Albedo { uvec2 albedo[]; };
layout(push_constant) uniform Push { ReflectanceParams params; };
#include "lib/records/record_colors.glsl"
#include "lib/records/record_directions.glsl"

const float kNoise = 0.002;            // of an observed colour, linear: 8-bit sRGB's steps in dark tones
const float kRelativeNoise = 0.02;     // and that of bright ones, with the camera's own
const float kHighlightError = 0.5;     // what of a predicted highlight may be wrong
const float kClippedShare = 1e-3;      // the weight of a lower bound that is below the mean of what is not clipped
const float kLeastIrradiance = 0.004;  // over pi: a white surface would be as dark as 8 bits' first step
const float kLeastCosine = 0.05;       // to the viewer; records hold no flatter views, but normals change
const float kLeastAlpha = 0.01;
const float kReflectedSpreads = 1.5;
const float kMirroredSpreads = 8.0;  // of a mirror, which has no diffuse part
const float kMirroring = 0.25;       // of what is seen: from so much on it mirrors as its segment does
const float kNearViews = 0.9994;     // 2 degrees
const float kFarViews = 0.9962;      // 5 degrees
const float kBoundError = 0.1;       // of the albedo of a channel that is clipped in all views, at least
const float kMostAlbedo = 0.8;       // a usual bright one: such a channel may have as much
const float kUsualKd = 0.3;          // a usual albedo
const float kUnknownError = 0.3;     // of what arrives from unknown directions, relative
const uint kAnyClipped = 7u << 26;   // of a direction word
const uint kRobustSteps = 3u;        // after which one wild observation of ten weighs nothing

// Of the brightnesses: where they lie, and their mean distance from there.
struct Center {
    float brightness;
    float spread;
};

// What lights do to the surface, over pi.
struct Irradiance {
    vec3 sum;
    vec3 uncertain;  // of it, what may not reach the voxel, or does though it is not in the sum
    vec3 noise;      // the standard deviation of what was gathered
};

uint direction_word[kMaxObservations];
vec3 direction_of[kMaxObservations];  // to the viewer
float normal_cosine[kMaxObservations];
vec3 highlight[kMaxObservations];    // at first without ks and what does not depend on the light
vec3 diffuse[kMaxObservations];      // what is left of the colour
float brightness[kMaxObservations];  // of that
float trust[kMaxObservations];       // its inverse variance, relative to one without a highlight; 0: no observation
float robust[kMaxObservations];      // trust, less for what is far off the others

// What arrives from all around beside the lamps.
Irradiance indirect_light(GatheredLight light) {
    const vec3 sum = gathered_irradiance(light, header.ambient.rgb);
    const float rays = light.met + light.missed;
    const float doubt = rays > 0.0 ? kRayError * inversesqrt(rays) + kUnknownError * light.missed / rays : 0.0;
    return Irradiance(sum, vec3(0.0), sum * min(doubt, 1.0));
}

// Adds up all lights to what there is.
Irradiance add_lights(Irradiance irradiance, uint count, vec3 point_m, vec3 normal, WardShape shape, bool specular,
                      uvec2 reached, uvec2 uncertain) {
    for (uint i = 0u; i < count; ++i) {
        const vec3 offset_m = lights[i].position_m.xyz - point_m;
        const float distance2 = max(dot(offset_m, offset_m), 1e-6);
        const vec3 to_light = offset_m * inversesqrt(distance2);
        const float cosine = max(dot(normal, to_light), 0.0);
        const vec3 facing = intensity_from(lights[i], to_light) / distance2;
        const vec3 received = facing * (cosine / kPi);
        const bool lit = bit_is_set(reached, i);
        irradiance.sum += lit ? received : vec3(0.0);
        irradiance.uncertain += bit_is_set(uncertain, i) ? received : vec3(0.0);
        const vec3 gloss = lit ? facing * ward_light_part(cosine) : vec3(0.0);
        if (!specular) continue;
        [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
            const float tan2 = ward_half_tan2(cosine, normal_cosine[k], dot(to_light, direction_of[k]));
            highlight[k] += gloss * ward_falloff(shape, tan2);
        }
    }
    return irradiance;
}

void unpack_directions(uint record, vec3 normal) {
    [[unroll]] for (uint quad = 0u; quad < kRecordQuads; ++quad) {
        const uvec4 words = load_directions(params.records.chunk_shift, record, quad);
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            const uint k = 4u * quad + i;
            if (k >= kMaxObservations) continue;
            direction_word[k] = words[i];
            direction_of[k] = observation_direction(words[i]);
            normal_cosine[k] = max(dot(direction_of[k], normal), kLeastCosine);
            highlight[k] = vec3(0.0);
        }
    }
}

// Takes the highlights from the colours. Returns a first guess of where the brightness of the rest lies: the plain
// mean, with a scale that even wild observations are within.
Center remove_highlights(uint record, uint count, vec3 ks_over_n) {
    float sum = 0.0, sizes = 0.0;
    [[unroll]] for (uint quad = 0u; quad < kRecordQuads; ++quad) {
        const uvec4 words = load_colors(params.records.chunk_shift, record, quad);
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            const uint k = 4u * quad + i;
            if (k >= kMaxObservations) continue;
            highlight[k] *= ks_over_n * ward_viewer_part(normal_cosine[k]);
            diffuse[k] = unpack_shared_exponent(words[i]) - highlight[k];
            brightness[k] = mean_of(diffuse[k]);
            sum += k < count ? brightness[k] : 0.0;
            sizes += k < count ? abs(brightness[k]) : 0.0;
        }
    }
    const float inverse_count = 1.0 / float(count);
    return Center(sum * inverse_count, sizes * inverse_count);
}

void set_trust(uint count, float noise) {
    const float share = kHighlightError / noise;
    [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
        const float doubt = mean_of(highlight[k]) * share;
        trust[k] = k < count ? normal_cosine[k] / (1.0 + doubt * doubt) : 0.0;
    }
}

// How much an observation counts beside a mean (Geman and McClure's weight).
float robust_share(float off, float inverse_scale) {
    const float scaled = off * inverse_scale;
    const float share = 1.0 / (1.0 + scaled * scaled);
    return share * share;
}

// The centre of the brightnesses by iteratively reweighted least squares; the scale follows from the residuals.
Center find_center(Center center, float noise) {
    for (uint i = 0u; i < kRobustSteps; ++i) {
        const float inverse_scale = 1.0 / (noise + 1.5 * center.spread);
        float weights = 1e-20, shift = 0.0, spread = 0.0;
        [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
            const float off = brightness[k] - center.brightness;
            // What is clipped is at least as bright as it was recorded: where that is darker, it tells nothing.
            const bool low = (direction_word[k] & kAnyClipped) != 0u && off < -noise;
            const float weight = (low ? kClippedShare : 1.0) * trust[k] * robust_share(off, inverse_scale);
            weights += weight;
            shift += weight * off;
            spread += weight * abs(off);
        }
        const float inverse_weights = 1.0 / weights;
        center = Center(center.brightness + shift * inverse_weights, spread * inverse_weights);
    }
    return center;
}

// How far apart views are: 0: so near each other that a mirror shows the same in all of them; 1: far enough.
float views_apart(uint count) {
    float least = 1.0;
    [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) least =
        min(least, k < count ? dot(direction_of[k], direction_of[0]) : 1.0);
    return 1.0 - smoothstep(kFarViews, kNearViews, least);
}

// What is not reflected surroundings, of which the material does not tell: they change with the view, and only add. So
// where colours scatter by more than their noise, the diffuse part lies below their mean.
float unreflected_share(Center center, float noise, float mirror) {
    const float excess = mix(kReflectedSpreads, kMirroredSpreads, mirror) * max(center.spread - noise, 0.0);
    return clamp(1.0 - excess / max(center.brightness, 1e-6), 0.0, 1.0);
}

struct Estimate {
    vec3 diffuse;   // the mean
    vec3 variance;  // of it
    bvec3 bounded;  // clipped in all views: at least so bright
    float known;    // the share of what was seen that is not clipped
};

// By channel, as clipping is. A clipped channel that is no darker than the mean of the others counts in full: were it
// left out, white paper would have the colours of the few views in which a channel happens not to be clipped.
Estimate robust_mean(Center center, float noise) {
    const float inverse_scale = 1.0 / (noise + 1.5 * center.spread);
    vec3 weights = vec3(1e-20), mean = vec3(0.0), seen = vec3(0.0);
    [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
        robust[k] = trust[k] * robust_share(brightness[k] - center.brightness, inverse_scale);
        const vec3 whole = vec3(not(observation_clipped(direction_word[k])));
        const vec3 share = robust[k] * mix(vec3(kClippedShare), vec3(1.0), whole);
        weights += share;
        mean += share * diffuse[k];
        seen += robust[k] * whole;
    }
    const vec3 bound = mean / weights - noise;
    weights = vec3(1e-20);
    mean = vec3(0.0);
    vec3 squares = vec3(0.0);
    float whole = 0.0, spread = 0.0, trusted = 1e-20, unclipped = 0.0;
    [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
        trusted += trust[k];
        unclipped += (direction_word[k] & kAnyClipped) != 0u ? 0.0 : trust[k];
        const float off = brightness[k] - center.brightness, weight = robust[k];
        const uvec3 low = uvec3(observation_clipped(direction_word[k])) & uvec3(lessThan(diffuse[k], bound));
        const vec3 share = weight * mix(vec3(1.0), vec3(kClippedShare), bvec3(low));
        weights += share;
        squares += share * share;
        mean += share * diffuse[k];
        whole += weight;
        spread += weight * off * off;
    }
    const vec3 variance = noise * noise / weights + (spread / max(whole, 1e-20)) * squares / (weights * weights);
    return Estimate(mean / weights, variance, equal(seen, vec3(0.0)), unclipped / trusted);
}

// What is clipped in all views is as bright as low exposure showed it, where it did: in all channels, for its color.
Estimate with_low_exposure(Estimate estimate, uint bright) {
    const vec3 low = unpack_shared_exponent(bright);
    const bvec3 brighter = greaterThan(low, estimate.diffuse);
    if (any(bvec3(uvec3(brighter) & uvec3(estimate.bounded)))) {
        estimate.diffuse = low;
        estimate.bounded = bvec3(false);
    }
    return estimate;
}

// Kd where the voxel is lit, with its certainty.
uvec2 packed_albedo(Estimate estimate, Irradiance irradiance, float sureness) {
    const bvec3 lit = greaterThan(irradiance.sum, vec3(kLeastIrradiance));
    const vec3 inverse = 1.0 / max(irradiance.sum, kLeastIrradiance);
    const vec3 kd = mix(vec3(0.0), clamp(estimate.diffuse * inverse, 0.0, kMostRawKd), lit);
    const vec3 doubt = min(kd, 1.0) * min(irradiance.uncertain * inverse, 1.0);
    // Of an albedo that is usual, not of kd: else dark records were surer than bright ones, and means too dark.
    const vec3 noise = kUsualKd * min(irradiance.noise * inverse, 1.0);
    // What a clipped channel may be brighter by makes the third one doubtful, too, as they are one color.
    const vec3 bounded = vec3(estimate.bounded), brighter = 0.5 * max(kMostAlbedo - kd, 0.0) * bounded;
    const float all_brighter = dot(bounded, vec3(1.0)) >= 2.0 ? max(max(brighter.r, brighter.g), brighter.b) : 0.0;
    const vec3 bound = max(max(kBoundError * bounded, brighter), vec3(all_brighter));
    const vec3 variance = estimate.variance * inverse * inverse + doubt * doubt + noise * noise + bound * bound;
    const vec3 certainty = sureness / (1.0 + variance / (kKdDeviation * kKdDeviation));
    return uvec2(pack_shared_exponent(kd), pack_certainty(mix(vec3(0.0), certainty, lit)));
}

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= refine[0]) return;
    const uint record = refine[1u + item];
    if (!is_marched(status[record].marched, header.position_version)) return;
    const VoxelRecord known = records[record];
    const uint count = observation_count(known);
    const uint label = record_label(known);
    const bool has_entry = label != 0u && label < params.materials;
    const SegmentMaterial material = materials[has_entry ? label : 0u];
    const bool specular = has_entry && any(greaterThan(material.ks_alpha.rgb, vec3(0.0)));
    const float alpha = max(material.ks_alpha.w, kLeastAlpha);
    const vec3 normal = surface_normal(known);
    const vec3 point_m = surface_point_m(known, params.records, params.edge_shift);

    unpack_directions(record, normal);
    // Were it the uniform alone, lavapipe would compile the loop anew in every frame: 6 ms.
    const uint light_count = count > 0u ? header.count : 0u;
    const GatheredLight gathered = unpack_gathered(status[record].incident);
    const Irradiance indirect = indirect_light(gathered);
    const Irradiance irradiance = add_lights(indirect, light_count, point_m, normal, ward_shape(alpha), specular,
                                             visibility[record], status[record].uncertain);
    const vec3 ks = specular ? material.ks_alpha.rgb * (1.0 - material.unobserved) : vec3(0.0);
    const Center guess = remove_highlights(record, count, ks * ward_scale(alpha));
    const float noise = kNoise + kRelativeNoise * max(guess.brightness, 0.0);
    set_trust(count, noise);
    const Center center = find_center(guess, noise);
    Estimate estimate = with_low_exposure(robust_mean(center, noise), status[record].bright);
    const float mirror = has_entry ? material.mirror : 0.0;
    float share = gathered.met > 0.0 ? unreflected_share(center, noise, mirror) : 1.0;
    if (mirror > 0.0 && gathered.met > 0.0) share *= 1.0 - mirror * (1.0 - views_apart(count));
    // What looks the same from everywhere is no mirror, though its segment is one.
    const float mirrors = mix(1.0, min((1.0 - share) / kMirroring, 1.0), mirror);
    estimate.diffuse = share * (estimate.diffuse - mirrors * gathered_gloss(gathered, header.ambient.rgb, ks));
    estimate.variance *= mix(1.0, share * share, mirror);
    // In a mirror what is always clipped is a lamp or a window.
    albedo[record] = packed_albedo(estimate, irradiance, mix(1.0, estimate.known, mirror));
    status[record].refined = refined_word(header.version, has_entry ? material.version : 0u);
}
