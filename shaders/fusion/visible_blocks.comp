#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the blocks whose bounding box meets the view frustum, enters them in a dense grid around it, and widens the
// depth range of every tile that a box covers.
#include "lib/camera/camera.glsl"
#include "lib/camera/view_grid.glsl"
#include "lib/map/voxel_map.glsl"

layout(local_size_x = kVisibleGroup) in;
layout(std430, binding = 0) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 1) readonly buffer Counters { MapCounters counters; };
layout(std140, binding = 2) uniform View { ViewParams view; };
layout(std430, binding = 3) buffer Visible { uint visible[]; };  // count, then block ids
layout(std430, binding = 4) buffer Arguments { uint arguments[]; };
layout(std430, binding = 5) buffer Tiles { TileRange tiles[]; };
layout(std430, binding = 6) buffer ViewGrid { uint view_grid[]; };

void append(uint block) {
    const uint item = atomicAdd(visible[0], 1u);
    visible[1u + item] = block;
    GROW_ARGUMENTS(arguments, item)
}

void widen_tiles(vec2 low_px, vec2 high_px, float near_m, float far_m) {
    const ivec2 first = ivec2(max(low_px, vec2(0.0))) / int(kTileEdge);
    const ivec2 last = min(ivec2(max(high_px, vec2(0.0))) / int(kTileEdge), ivec2(view.tiles) - 1);
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            const uint tile = uint(y) * view.tiles.x + uint(x);
            atomicMin(tiles[tile].near_bits, floatBitsToUint(near_m));
            atomicMin(tiles[tile].far_bits_inverted, ~floatBitsToUint(far_m));
        }
    }
}

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block >= counters.high_water) return;
    const uint key = block_keys[block];
    if (key == kEmptyKey) return;

    const float block_m = view.grid.voxel_m * float(kBlockEdge);
    // A voxel's value reaches half a voxel into the next block by interpolation.
    const float margin_m = 0.5 * view.grid.voxel_m;
    const ivec3 coordinates = block_of_key(view.grid, key);
    const vec3 corner = to_camera(view.camera, vec3(coordinates) * block_m - margin_m);
    const mat3 axes = mat3(view.camera.camera_from_world) * (block_m + 2.0 * margin_m);
    const vec3 center = corner + 0.5 * (axes[0] + axes[1] + axes[2]);
    const float radius = 0.8661 * (block_m + 2.0 * margin_m);
    if (center.z + radius < view.near_m || center.z - radius > view.far_m) return;

    vec2 low = vec2(1e9), high = vec2(-1e9);
    float near = 1e9, far = 0.0;
    for (uint i = 0u; i < 8u; ++i) {
        vec3 p = corner + axes * vec3(i & 1u, i >> 1 & 1u, i >> 2);
        near = min(near, p.z);
        far = max(far, p.z);
        // A corner behind the near plane projects to where its box certainly reaches beyond the image.
        p.z = max(p.z, view.near_m);
        const vec2 pixel = project(view.camera, p);
        low = min(low, pixel);
        high = max(high, pixel);
    }
    if (far < view.near_m || near > view.far_m) return;
    // The interpolation around a hit at the image's border, or its gradient, needs voxels just outside the frustum.
    const vec2 reach_px = kGridMarginVox * view.grid.voxel_m / max(near, view.near_m) * view.camera.focal_center_px.xy;
    const vec2 end_px = vec2(view.camera.extent) - 0.5;
    if (any(lessThan(high, -0.5 - reach_px)) || any(greaterThan(low, end_px + reach_px))) return;
    const uint cell = view_grid_cell(view.grid_low.xyz, view.grid_size.xyz, coordinates);
    if (cell != kOutsideGrid) view_grid[cell] = block;
    if (any(lessThan(high, vec2(-0.5))) || any(greaterThan(low, end_px))) return;
    append(block);
    widen_tiles(low, high, max(near, view.near_m), min(far, view.far_m));
}
