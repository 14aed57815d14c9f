// A synthetic scene's light from afar. Bindings 8 and 9 (SceneModel::bind_environment); a pass that includes this
// begins its own at 10.
#ifndef PATINA_SYNTHETIC_ENVIRONMENT_GLSL
#define PATINA_SYNTHETIC_ENVIRONMENT_GLSL
#include "lib/math/pi.glsl"
#include "lib/math/random.glsl"
#include "lib/math/sampling.glsl"
#include "scenes/surface.glsl"
#include "shared/scenes/environment.h"

layout(std430, binding = 8) readonly buffer Environment { vec4 environment[]; };
layout(std430, binding = 9) readonly buffer EnvironmentAliases { EnvironmentAlias environment_aliases[]; };

struct FarLight {
    vec3 direction;  // to it, unit length
    vec3 radiance;
    float density;  // with which draw_far_light() draws the direction, per steradian
};

// What shines from a direction of unit length.
FarLight far_light_from(vec3 direction) {
    const vec2 size = vec2(scene.environment_size);
    const float turns = angle_of(direction.x, direction.z) * (0.5 / kPi) + 0.5;
    const float descent = angle_of(length(direction.xz), -direction.y) / kPi;
    const uvec2 cell = min(uvec2(vec2(turns, descent) * size), scene.environment_size - 1u);
    const vec4 light = environment[cell.y * scene.environment_size.x + cell.x];
    return FarLight(direction, light.rgb, light.w);
}

// Draws a direction in proportion to its radiance, from four independent words.
FarLight draw_far_light(uvec4 words) {
    const vec4 u = unit_interval(words);
    uint drawn, fraction;
    umulExtended(words.x, scene.environment_size.x * scene.environment_size.y, drawn, fraction);
    const EnvironmentAlias alias = environment_aliases[drawn];
    const uint index = u.y < alias.keep ? drawn : alias.other;
    const vec2 cell = vec2(index % scene.environment_size.x, index / scene.environment_size.x);
    const vec2 size = vec2(scene.environment_size);
    const vec2 upper = circle_point(0.5 * cell.y / size.y), lower = circle_point(0.5 * (cell.y + 1.0) / size.y);
    // Uniform in height, and thereby in solid angle.
    const float height = mix(upper.x, lower.x, u.z);
    const vec2 away = circle_point(fract((cell.x + u.w) / size.x + 0.5));
    const float radius = sqrt(max(0.0, 1.0 - height * height));
    const vec4 light = environment[index];
    return FarLight(vec3(radius * away.y, -height, radius * away.x), light.rgb, light.w);
}

#endif
