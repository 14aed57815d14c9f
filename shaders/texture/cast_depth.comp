#version 460
// Of a view of the model its depth alone, which is a quarter of what positions take. One invocation per pixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;  // w: depth, 0: nothing was hit
layout(binding = 1, r32f) uniform writeonly image2D depth_m;

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(depth_m)))) return;
    imageStore(depth_m, pixel, vec4(imageLoad(position_m, pixel).w));
}
