#version 300 es
// Shades the surface of the HTML viewer with the Ward BRDF under the scene's lamps, without shadows.
precision highp float;
precision highp int;

// WARD

const int kShaded = 0, kDiffuse = 1, kSpecular = 2, kRoughness = 3, kSegments = 4, kNumber = 5;

uniform sampler2D page;
// A row for each material: {kd over base, alpha, is observed, has reflectance}, {ks, -}, {colour of the segment, -}.
uniform highp sampler2D materials;
uniform bool has_page;
uniform int mode, light_count;
uniform vec3 light_m[64], light_intensity[64], light_axis[64];  // axis: of a flat lamp, else 0
uniform vec3 ambient, eye_m;
uniform float exposure;

in vec3 world_m, normal, color;
in vec2 place;
flat in int material;
out vec4 pixel;

vec3 encoded(vec3 linear) {
    linear = clamp(linear, 0.0, 1.0);
    return mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, greaterThan(linear, vec3(0.0031308)));
}

vec3 shaded(vec3 kd, vec3 ks, float alpha) {
    vec3 to_viewer = normalize(eye_m - world_m);
    vec3 n = normalize(normal);
    // An interpolated normal may turn away from a viewer who sees the triangle: it is brought to where it is seen.
    n = normalize(n + max(0.02 - dot(n, to_viewer), 0.0) * to_viewer);
    vec3 radiance = ambient * kd;
    for (int i = 0; i < light_count; ++i) {
        vec3 offset_m = light_m[i] - world_m;
        float emission = light_axis[i] == vec3(0.0) ? 1.0 : max(-dot(light_axis[i], normalize(offset_m)), 0.0);
        radiance += ward_point_light(kd, ks, alpha, n, offset_m, emission * light_intensity[i], to_viewer);
    }
    return radiance;
}

// What was not observed, in place of a value.
vec3 hatched() {
    bool on = mod(gl_FragCoord.x + gl_FragCoord.y, 12.0) < 5.0;
    return on ? vec3(0.55) : vec3(0.45);
}

void main() {
    vec4 facts = texelFetch(materials, ivec2(0, material), 0);
    vec3 base = has_page ? texture(page, place).rgb : color;
    vec3 kd = facts.x * base, ks = texelFetch(materials, ivec2(1, material), 0).rgb;
    bool observed = facts.z > 0.5, reflects = facts.w > 0.5;
    vec3 shown = encoded(kd);
    if (mode == kShaded && reflects) shown = encoded(exposure * shaded(kd, ks, facts.y));
    if (mode == kShaded && !reflects) shown = encoded(exposure * base);
    if (mode == kSpecular) shown = observed ? encoded(ks) : hatched();
    if (mode == kRoughness) shown = observed ? vec3(sqrt(facts.y)) : hatched();
    if (mode == kSegments) shown = texelFetch(materials, ivec2(2, material), 0).rgb * (0.6 + 0.4 * normalize(normal).y);
    if (mode == kNumber) shown = vec3(material & 255, material >> 8, 255) / 255.0;
    pixel = vec4(shown, 1.0);
}
