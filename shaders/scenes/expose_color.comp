#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/math/gaussian.glsl"
#include "lib/math/random.glsl"
#include "shared/scenes/expose_color.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(rgba32f, binding = 0) uniform readonly image2D radiance;
layout(rgba32f, binding = 1) uniform writeonly image2D linear_color;
layout(push_constant) uniform Push { ExposeColorParams params; };

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.extent))) return;
    const vec4 radiance_here = imageLoad(radiance, ivec2(pixel));
    const vec3 value = params.exposure * radiance_here.rgb;
    const vec3 sigma = sqrt(params.read * params.read + params.shot * value);
    const uvec2 stream = random_stream(params.seed, params.frame, pixel.x | pixel.y << 16u);
    const vec4 numbers = unit_interval(random_words(stream, 0u, kColorNoise));
    const vec3 noise = sigma * vec3(gaussians(numbers.xy), gaussians(numbers.zw).x);
    imageStore(linear_color, ivec2(pixel), vec4(max(value + noise, 0.0), radiance_here.a));
}
