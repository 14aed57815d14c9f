// Pinhole projection and its inverse, for shared/input/camera.h. Functions without bindings.
#ifndef PATINA_LIB_CAMERA_GLSL
#define PATINA_LIB_CAMERA_GLSL
#include "shared/input/camera.h"

// World point (metres) to camera coordinates (metres).
vec3 to_camera(Camera camera, vec3 world_m) { return (camera.camera_from_world * vec4(world_m, 1.0)).xyz; }

// Camera point (metres, z > 0) to pixel coordinates.
vec2 project(Camera camera, vec3 point_m) {
    return point_m.xy / point_m.z * camera.focal_center_px.xy + camera.focal_center_px.zw;
}

// Direction in camera coordinates through a pixel, scaled to z = 1: times depth it is the point.
vec3 unproject(Camera camera, vec2 pixel) {
    return vec3((pixel - camera.focal_center_px.zw) / camera.focal_center_px.xy, 1.0);
}

// Camera direction to world direction.
vec3 to_world_direction(Camera camera, vec3 direction) { return transpose(mat3(camera.camera_from_world)) * direction; }

// The camera's centre in the world (metres).
vec3 camera_center_m(Camera camera) {
    return -(transpose(mat3(camera.camera_from_world)) * camera.camera_from_world[3].xyz);
}

#endif
