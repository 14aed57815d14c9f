#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "patina/camera.h"

namespace patina::reference {

/// Connected components, with four neighbours, of the pixels above 0, by flood fill in the order of pixels: 1 + the
/// index of the component's first pixel, 0 outside. Depths of connected pixels differ by at most floor_m + slope times
/// the larger one.
Image<uint32_t> components(const Image<float>& inner_depth_m, float floor_m = 0.01f, float slope = 0.015f);

/// One row of a frame's table of segments.
struct Segment {
    uint32_t key = 0;
    uint32_t pixels = 0;
    bool touches_border = false;

    bool operator==(const Segment&) const = default;
};

struct Segments {
    Image<uint32_t> number;         ///< 0: none
    std::vector<Segment> segments;  ///< from number 0, which is empty, on
    uint32_t too_small = 0;
    uint32_t beyond_capacity = 0;
};

/// Numbers the keys of a picture in their order and measures them; 0 is none, and so are pixels without depth.
Segments number_segments(const Image<uint32_t>& key, const Image<float>& depth_m, uint32_t min_pixels,
                         uint32_t capacity);

/// What the passes on a frame's surface are told (EdgeSettings).
struct SurfaceRules {
    double jump_m = 0.01, steepest_degrees = 80;
    double noise_floor_m = 0.001, noise_per_m = 0.00025;
    double reach_m = 0.015;
    int min_reach_px = 2, max_reach_px = 4;
    double crease_degrees = 20, crease_sigmas = 0.5;
    double step_m = 0.004, step_sigmas = 1;
};

/// Unit normals towards the camera, in its coordinates; 0 where unknown.
Image<glm::dvec3> fit_normals(const Image<float>& depth_m, const Intrinsics& camera, const SurfaceRules& rules = {});

/// Whether each pixel with depth is at an edge.
Image<uint8_t> find_edges(const Image<float>& depth_m, const Image<glm::dvec3>& normal, const Intrinsics& camera,
                          const SurfaceRules& rules = {});

}  // namespace patina::reference
