// Where voxels along a row of the volume appear in a camera. Functions without bindings.
#ifndef PATINA_LIB_PIXEL_ROW_GLSL
#define PATINA_LIB_PIXEL_ROW_GLSL
#include "lib/camera/camera.glsl"

// Homogeneous pixel coordinates of neighbouring voxels along x: they are linear in the voxel's index.
struct PixelRow {
    vec3 first;
    vec3 step;
};

// The row that begins at a point of the world.
PixelRow pixel_row(Camera camera, vec3 world_m, float voxel_m) {
    const vec4 k = camera.focal_center_px;
    const mat3 pixel_from_camera = mat3(k.x, 0.0, 0.0, 0.0, k.y, 0.0, k.z, k.w, 1.0);
    return PixelRow(pixel_from_camera * to_camera(camera, world_m),
                    pixel_from_camera * (camera.camera_from_world[0].xyz * voxel_m));
}

// The pixel of voxel i, far outside every image where it is not before the camera. Images read zero outside.
vec2 pixel_of(PixelRow row, int i) {
    const vec3 at = row.first + float(i) * row.step;
    return at.z > kNearestDepth ? at.xy * (1.0 / at.z) : vec2(-1e6);
}

#endif
