#version 460
#extension GL_GOOGLE_include_directive : require
// Packs what restore_detail looks up of each pixel around into one load.
#include "lib/records/packed_detail.glsl"
#include "shared/shading/restore_detail.h"

layout(local_size_x = kRestoreDetailGroup, local_size_y = kRestoreDetailGroup) in;
layout(binding = 0, rgba16f) uniform readonly image2D color;
layout(binding = 1, rgba16f) uniform readonly image2D light;
layout(binding = 2, rgba16f) uniform readonly image2D kd;
layout(binding = 3, rgba16f) uniform readonly image2D picture_kd;
layout(binding = 4, rgba32ui) uniform writeonly uimage2D detail;

const float kLeastLight = 0.004;  // irradiance over pi: a white surface would be as dark as 8 bits' first step

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(kd)))) return;
    const vec4 known = imageLoad(kd, pixel), seen = imageLoad(color, pixel), received = imageLoad(light, pixel);
    const bool lit = seen.a > 0.0 && all(greaterThan(received.rgb, vec3(kLeastLight)));
    const vec3 apparent = min(seen.rgb / max(received.rgb, vec3(kLeastLight)), 1e4);
    imageStore(
        detail, pixel,
        pack_detail(Detail(known.rgb, imageLoad(picture_kd, pixel).rgb, apparent, received.a, lit, known.a > 0.0)));
}
