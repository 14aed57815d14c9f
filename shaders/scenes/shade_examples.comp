#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation per voxel and view: what the camera reads, with its noise, its 8 bits and its clipping.
#include "lib/color/srgb.glsl"
#include "lib/math/gaussian.glsl"
#include "scenes/example_light.glsl"

layout(local_size_x = kExampleGroup) in;
layout(std430, binding = 6) readonly buffer Irradiance { vec4 irradiance[]; };
layout(std430, binding = 7) readonly buffer Exposures { float exposures[]; };
layout(std430, binding = 8) writeonly buffer Readings { ExampleReading readings[]; };  // view by view

uvec3 camera_code(uint scene, vec3 value, vec4 numbers) {
    const vec3 sigma = sqrt(scenes[scene].read * scenes[scene].read + scenes[scene].shot * value);
    return srgb_code(value + sigma * vec3(gaussians(numbers.xy), gaussians(numbers.zw).x));
}

bool is_seen(uint scene, uint voxel, uint view, vec3 to_viewer) {
    const ExampleVoxel at = voxels[voxel];
    const float cosine = min(dot(at.normal.xyz, to_viewer), dot(at.stored_normal.xyz, to_viewer));
    return view < scenes[scene].views && cosine >= params.min_cosine &&
           random_numbers(voxel_stream(voxel), view, kHidden).x >= scenes[scene].ground.w;
}

void main() {
    const uint voxel = gl_GlobalInvocationID.x, scene = voxel / kExampleVoxels, view = gl_WorkGroupID.y;
    if (scene >= params.scenes) return;
    const uint reading = view * params.scenes * kExampleVoxels + voxel;
    const vec3 to_viewer = normalize(views[scene * kExampleViews + view].xyz - voxels[voxel].point_m.xyz);
    if (!is_seen(scene, voxel, view, to_viewer)) {
        readings[reading] = ExampleReading(vec4(0.0), vec4(0.0));
        return;
    }
    const uvec2 stream = voxel_stream(voxel);
    const vec2 shift = random_numbers(stream, view, kReflectedShift).xy;
    const vec3 radiance = radiance_to(scene, voxel, voxels[voxel].material, irradiance[voxel].rgb, to_viewer, shift);
    const uvec3 code = camera_code(scene, exposures[scene] * radiance, random_numbers(stream, view, kNoise));
    const uvec3 clipped = uvec3(equal(code, uvec3(255u)));
    readings[reading] = ExampleReading(
        vec4(to_viewer, 1.0), vec4(linear_of_srgb(code), float(clipped.r | clipped.g << 1u | clipped.b << 2u)));
}
