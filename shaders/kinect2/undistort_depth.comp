// Depth in metres and infrared light as a pinhole camera would see them, from the nearest pixel of the sensor. Readings
// outside of the range, and those between a near and a far surface, are dropped on the way.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/kinect2/undistort_depth.h"

layout(local_size_x = 128) in;  // divides the picture
layout(constant_id = 0) const bool kDropEdges = true;
// Depth in mm; amplitude, negative at an edge; infrared.
layout(binding = 0, rgba32f) uniform readonly image2D readings;
layout(binding = 1, r32ui) uniform readonly uimage2D sources;  // x | y << 16, or kNoSource
layout(binding = 2, r32f) uniform writeonly image2D depth_m;
layout(binding = 3, r32f) uniform writeonly image2D infrared;
layout(push_constant) uniform Push { UndistortDepthParams params; };

const ivec2 kLast = ivec2(kInfraredWidth, kInfraredHeight) - 1;

// The amplitudes differ around the pixel, and it is apart from both its nearest and its farthest neighbour.
bool between_surfaces(ivec2 pixel, float z, float light) {
    // Differences from the centre keep their digits where squares of amplitudes would not.
    float sum = 0.0, squares = 0.0, nearest = z, farthest = z;
    [[unroll]] for (int y = -1; y <= 1; ++y) {
        [[unroll]] for (int x = -1; x <= 1; ++x) {
            if (x == 0 && y == 0) continue;
            const vec2 near = imageLoad(readings, clamp(pixel + ivec2(x, y), ivec2(0), kLast)).xy;
            const float step = abs(near.y) - light;
            sum += step;
            squares += step * step;
            nearest = near.x > 0.0 ? min(nearest, near.x) : nearest;
            farthest = max(farthest, near.x);
        }
    }
    const float deviation = sqrt(max(9.0 * squares - sum * sum, 0.0)) / 9.0;
    const float mean = max(light + sum / 9.0, params.min_amplitude);
    const float near_step = z - nearest, far_step = farthest - z;
    return deviation >= params.max_deviation * mean && near_step > params.near_step_mm &&
           far_step > params.far_step_mm && max(near_step, far_step) > params.max_step_mm;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    const uint source = imageLoad(sources, pixel).x;
    const bool seen = source != kNoSource;
    const ivec2 at = seen ? ivec2(source & 0xffffu, source >> 16u) : ivec2(0);
    const vec3 reading = imageLoad(readings, at).xyz;
    const float z = reading.x;
    bool valid = seen && z >= params.min_mm && z <= params.max_mm;
    if (kDropEdges) {
        const bool border = any(equal(at, ivec2(0))) || any(equal(at, kLast));
        const bool dropped = reading.y < 0.0 || between_surfaces(at, z, abs(reading.y));
        valid = valid && (border || !dropped);
    }
    imageStore(depth_m, pixel, vec4(valid ? 0.001 * z : 0.0));
    imageStore(infrared, pixel, vec4(seen ? reading.z : 0.0));
}
