#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/brdf/ward.glsl"
#include "lib/math/random.glsl"
#include "lib/math/sampling.glsl"
#include "shared/test/test_sampling.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Queries { SamplingQuery queries[]; };
layout(std430, binding = 1) writeonly buffer Answers { SamplingAnswer answers[]; };
layout(push_constant) uniform Push { SamplingParams params; };

vec4 sampled_weight(SamplingQuery q, vec3 to_light, float density) {
    const vec3 normal = q.normal.xyz, to_viewer = q.to_viewer.xyz;
    if (density <= 0.0) return vec4(0.0);
    return vec4(ward(vec3(0.0), q.ks.rgb, q.normal.w, normal, to_light, to_viewer) * dot(normal, to_light) / density,
                0.0);
}

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    const SamplingQuery q = queries[i];
    const float alpha = q.normal.w;
    const vec3 normal = q.normal.xyz, to_viewer = q.to_viewer.xyz, to_light = q.to_light.xyz;
    const uvec2 stream = random_stream(q.seed_frame_pixel.xy, q.seed_frame_pixel.z, q.seed_frame_pixel.w);
    const mat3 basis = basis_around(normal);
    const vec3 sampled = sample_ward(alpha, normal, to_viewer, q.u.xy);
    const float density = ward_density(alpha, normal, sampled, to_viewer);
    SamplingAnswer a;
    a.words = uvec4(stream, 0u, 0u);
    a.random = random_numbers(stream, q.index_dimension.x, q.index_dimension.y);
    a.stratified = unit_interval(stratified_words(stream, q.index_dimension.x, q.index_dimension.y));
    a.tangent = vec4(basis[0], 0.0);
    a.bitangent = vec4(basis[1], 0.0);
    a.cosine = vec4(sample_cosine(q.u.xy), 0.0);
    a.cap = vec4(sample_cap(q.u.z, q.u.xy), 0.0);
    a.ward = vec4(sampled, density);
    a.brdf = vec4(ward(q.kd.rgb, q.ks.rgb, alpha, normal, to_light, to_viewer),
                  ward_density(alpha, normal, to_light, to_viewer));
    a.reversed = vec4(ward(q.kd.rgb, q.ks.rgb, alpha, normal, to_viewer, to_light), 0.0);
    a.weight = sampled_weight(q, sampled, density);
    answers[i] = a;
}
