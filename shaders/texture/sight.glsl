// How a picture sees a point of the surface. Needs depth_m, the model cast into the picture's view.
#ifndef PATINA_TEXTURE_SIGHT_GLSL
#define PATINA_TEXTURE_SIGHT_GLSL
#include "lib/camera/camera.glsl"

const float kLeastCosine = 0.1;
const float kBorder = 0.06;    // of the picture's width, over which weights fall to 0
const float kOffVox = 1.5;     // farther from the cast surface is another one
const float kSharpness = 2.0;  // of the preference for views that see most of a point

struct Sight {
    bool within;        // the picture, and turned towards it
    vec2 at;            // pixel of the picture
    float away_m;       // along the view
    float range_m;      // from the camera
    float cosine;       // of the angle to the normal
    float fade;         // 0 at the picture's border, 1 inside
    vec3 to_picture;    // world, unit length
    ivec2 low;          // of the four pixels of the cast images around
    vec2 between;       // those pixels
    float tolerance_m;  // of their depth; it may change by as much as its slope asks
};

Sight sight_of(Camera camera, vec3 world_m, vec3 normal, float voxel_m) {
    Sight sight;
    sight.within = false;
    const vec3 point_m = to_camera(camera, world_m);
    if (point_m.z < kNearestDepth) return sight;
    sight.at = project(camera, point_m);
    const vec2 inside = min(sight.at, vec2(camera.extent) - 1.0 - sight.at);
    const float border_px = min(inside.x, inside.y);
    sight.away_m = point_m.z;
    sight.range_m = length(point_m);
    sight.to_picture = -to_world_direction(camera, point_m) / sight.range_m;
    sight.cosine = dot(normal, sight.to_picture);
    sight.within = border_px > 1.0 && sight.cosine >= kLeastCosine;
    sight.fade = smoothstep(0.0, kBorder * float(camera.extent.x), border_px);
    const vec2 scale = vec2(imageSize(depth_m)) / vec2(camera.extent);
    const vec2 cast_at = (sight.at + 0.5) * scale - 0.5;
    const float pixel_m = point_m.z / (camera.focal_center_px.x * scale.x);
    const float cosine = max(sight.cosine, kLeastCosine);
    sight.tolerance_m = kOffVox * voxel_m + 2.0 * pixel_m * sqrt(1.0 - cosine * cosine) / cosine;
    sight.low = ivec2(floor(cast_at));
    sight.between = cast_at - vec2(sight.low);
    return sight;
}

// Whether a pixel of the cast images shows the point's surface.
bool shows_it(Sight sight, ivec2 pixel) {
    const float hit_m = imageLoad(depth_m, pixel).r;
    return hit_m > 0.0 && abs(hit_m - sight.away_m) <= sight.tolerance_m;
}

#endif
