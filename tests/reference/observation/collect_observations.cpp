#include "tests/reference/observation/collect_observations.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/reference/observation/observation_set.h"

namespace patina::reference {

namespace {

glm::dvec3 transformed(const RigidTransform& matrix, glm::dvec3 point) {
    return glm::dvec3(matrix * glm::dvec4(point, 1));
}

/// The pixel that shows a world point; nothing behind the camera.
std::optional<glm::dvec2> pixel_of(const Intrinsics& camera, const RigidTransform& world_from_camera,
                                   glm::dvec3 world_m) {
    const glm::dvec3 p = transformed(rigid_inverse(world_from_camera), world_m);
    if (p.z <= 1e-3) return {};
    return glm::dvec2(p.x / p.z * camera.fx + camera.cx, p.y / p.z * camera.fy + camera.cy);
}

glm::ivec2 nearest_to(glm::dvec2 pixel) { return glm::ivec2(glm::floor(pixel + 0.5)); }

template <class Pixel>
Pixel load(const Image<Pixel>& image, glm::ivec2 pixel) {
    if (!image.extent().contains(pixel.x, pixel.y)) return Pixel{};
    return image.at(static_cast<uint32_t>(pixel.x), static_cast<uint32_t>(pixel.y));
}

double tolerance_m(const ObservationRules& rules, double depth) {
    return rules.depth_tolerance_m + rules.depth_tolerance_per_m2 * depth * depth;
}

bool faces(glm::dvec3 normal, glm::dvec3 toward, const ObservationRules& rules) {
    return glm::length(toward) <= rules.max_distance_m &&
           glm::dot(normal, glm::normalize(toward)) >= std::cos(glm::radians(rules.max_angle_degrees));
}

struct Plane {
    glm::dvec3 normal;
    double offset_vox;
};

constexpr double kSameFaceCosine = 0.5;

struct SeenPoint {
    glm::dvec3 place_m, normal;
};

/// The pixel that shows the guess and four around it, as far as they show the model near the guess.
std::vector<SeenPoint> points_around(glm::dvec3 guess_m, const ObservedFrame& frame, const ObservationRules& rules) {
    const auto pixel = pixel_of(frame.depth_camera, frame.world_from_depth, guess_m);
    if (!pixel) return {};
    const double z = transformed(rigid_inverse(frame.world_from_depth), guess_m).z;
    const double pixel_m = z / frame.depth_camera.fx;
    const int spread = std::max(static_cast<int>(rules.voxel_m / 3 / pixel_m + 0.5), 1);
    std::vector<SeenPoint> points;
    for (const glm::ivec2 side : {glm::ivec2(0), {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}) {
        const glm::ivec2 at = nearest_to(*pixel) + spread * side;
        const glm::dvec4 point(load(frame.position_m, at));
        const glm::dvec3 normal(load(frame.normal, at));
        if (point.w <= 0 || glm::length(normal) < 0.7) continue;
        if (glm::distance(glm::dvec3(point), guess_m) > 1.25 * rules.voxel_m + pixel_m) continue;
        points.push_back({glm::dvec3(point), normal});
    }
    return points;
}

/// The face that a voxel is of: the normal most like the known one, if any is; else that of the first point.
glm::dvec3 face_of(const std::vector<SeenPoint>& points, const ObservedVoxel& voxel) {
    glm::dvec3 face = points.front().normal;
    double best = voxel.surface_samples > 0 ? kSameFaceCosine : 2;
    for (const SeenPoint& point : points) {
        const double agreement = glm::dot(point.normal, voxel.normal);
        if (agreement <= best) continue;
        best = agreement;
        face = point.normal;
    }
    return face;
}

std::optional<Plane> plane_around(glm::dvec3 guess_m, glm::dvec3 center_m, const ObservedVoxel& voxel,
                                  const ObservedFrame& frame, const ObservationRules& rules) {
    const std::vector<SeenPoint> points = points_around(guess_m, frame, rules);
    if (points.empty()) return {};
    const glm::dvec3 face = face_of(points, voxel);
    glm::dvec3 normals(0), places(0);
    double count = 0;
    for (const SeenPoint& point : points) {
        if (glm::dot(point.normal, face) <= kSameFaceCosine) continue;
        normals += point.normal;
        places += point.place_m;
        ++count;
    }
    if (count == 0) return {};
    const glm::dvec3 normal = glm::normalize(normals);
    const double offset_vox = glm::dot(normal, places / count - center_m) / rules.voxel_m;
    if (std::abs(offset_vox) > 1) return {};
    return Plane{normal, offset_vox};
}

void update_surface(ObservedVoxel& voxel, const Plane& seen) {
    constexpr int kMost = 16;
    const bool other_face = glm::dot(voxel.normal, seen.normal) < kSameFaceCosine;
    if (voxel.surface_samples == 0 || (voxel.surface_samples == 1 && other_face)) {
        voxel.normal = seen.normal;
        voxel.offset_vox = seen.offset_vox;
        voxel.surface_samples = 1;
        return;
    }
    if (other_face) {
        --voxel.surface_samples;
        return;
    }
    const bool agrees =
        glm::dot(voxel.normal, seen.normal) > 0.9986 && std::abs(voxel.offset_vox - seen.offset_vox) < 0.1;
    if (voxel.surface_samples == kMost && agrees) return;
    voxel.surface_samples = std::min(voxel.surface_samples + 1, kMost);
    voxel.normal = glm::normalize(glm::mix(voxel.normal, seen.normal, 1.0 / voxel.surface_samples));
    voxel.offset_vox = glm::mix(voxel.offset_vox, seen.offset_vox, 1.0 / voxel.surface_samples);
}

/// The pixel of the depth image that shows the point.
std::optional<glm::ivec2> reading_of(glm::dvec3 point_m, const ObservedFrame& frame, const ObservationRules& rules) {
    const auto pixel = pixel_of(frame.depth_camera, frame.world_from_depth, point_m);
    if (!pixel) return {};
    const glm::ivec2 center = nearest_to(*pixel);
    const double reading = load(frame.depth_m, center);
    const Slope slope = load(frame.slope, center);
    if (reading <= 0 || slope.plane_factor == 0) return {};
    const double z = transformed(rigid_inverse(frame.world_from_depth), point_m).z;
    const double off = reading + glm::dot(slope.depth_per_px, *pixel - glm::dvec2(center)) - z;
    return std::abs(off) * slope.plane_factor <= tolerance_m(rules, z) ? std::optional(center) : std::nullopt;
}

/// The model shows the voxel's face at the pixel, or no normal.
bool shows_face(glm::ivec2 pixel, const ObservedVoxel& voxel, const ObservedFrame& frame) {
    const glm::dvec3 shown(load(frame.normal, pixel));
    return shown == glm::dvec3(0) || glm::dot(shown, voxel.normal) > kSameFaceCosine;
}

bool is_even_around(glm::ivec2 center, const ObservedFrame& frame, const ObservationRules& rules) {
    const double reading = load(frame.depth_m, center);
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const glm::ivec2 offset = rules.edge_margin_px * glm::ivec2(dx, dy);
            const double there = load(frame.depth_m, center + offset);
            const double expected = reading + glm::dot(load(frame.slope, center).depth_per_px, glm::dvec2(offset));
            if (there <= 0 || std::abs(there - expected) > rules.jump.floor_m + rules.jump.relative * reading) {
                return false;
            }
        }
    }
    return true;
}

/// No reading lies before the line of sight from the colour camera, at 16 places evenly spaced in disparity up to 0.3
/// m.
bool line_of_sight_is_free(glm::dvec3 point_m, const ObservedFrame& frame, const ObservationRules& rules) {
    const glm::dvec3 from(frame.world_from_color[3]);
    if (glm::distance(from, glm::dvec3(frame.world_from_depth[3])) < 1e-4) return true;
    const RigidTransform depth_from_world = rigid_inverse(frame.world_from_depth);
    const double z = transformed(depth_from_world, point_m).z, z_from = transformed(depth_from_world, from).z;
    for (int step = 1; step <= 16; ++step) {
        const double z_here = 1 / (1 / z + (1 / 0.3 - 1 / z) * step / 16);
        const double share = (z - z_here) / (z - z_from);
        if (share <= 0 || share >= 1) continue;
        const auto pixel = pixel_of(frame.depth_camera, frame.world_from_depth, glm::mix(point_m, from, share));
        const double reading = pixel ? load(frame.depth_m, nearest_to(*pixel)) : 0;
        if (reading > 0 && reading < z_here - rules.jump.floor_m - rules.jump.relative * z_here) return false;
    }
    return true;
}

/// How far the point moved over the picture while the shutter was open stays within the limit.
bool is_sharp(glm::dvec3 point_m, const ObservedFrame& frame, const ObservationRules& rules) {
    if (frame.shutter_share == 0) return true;
    const auto now = pixel_of(frame.color_camera, frame.world_from_color, point_m);
    const auto before = pixel_of(frame.color_camera, frame.world_from_color_before, point_m);
    return now && before && glm::distance(*now, *before) * frame.shutter_share <= rules.max_blur_px;
}

std::optional<SeenColor> seen_color(glm::dvec3 point_m, const ObservedFrame& frame) {
    const auto pixel = pixel_of(frame.color_camera, frame.world_from_color, point_m);
    if (!pixel) return {};
    SeenColor seen;
    seen.direction = glm::normalize(glm::dvec3(frame.world_from_color[3]) - point_m);
    const glm::dvec2 low = glm::floor(*pixel);
    for (int dy = 0; dy <= 1; ++dy) {
        for (int dx = 0; dx <= 1; ++dx) {
            const glm::dvec4 color(load(frame.color, glm::ivec2(low) + glm::ivec2(dx, dy)));
            if (color.a <= 0) return {};
            const glm::dvec2 share = 1.0 - glm::abs(low + glm::dvec2(dx, dy) - *pixel);
            seen.color += glm::dvec3(color) * share.x * share.y;
            for (int c = 0; c < 3; ++c) {
                if (color.a < 1 && color[c] >= 1) seen.clipped[static_cast<size_t>(c)] = true;
            }
        }
    }
    return seen;
}

void add(std::vector<SeenColor>& seen, const SeenColor& added, double merge_angle_degrees) {
    constexpr size_t kMost = 30;
    const double chord = 2 * std::sin(glm::radians(merge_angle_degrees) / 2);
    const auto apart = [&](const SeenColor& s) { return glm::distance(s.direction, added.direction); };
    const auto nearest =
        std::min_element(seen.begin(), seen.end(), [&](const auto& a, const auto& b) { return apart(a) < apart(b); });
    if (nearest != seen.end() && apart(*nearest) <= chord) {
        if (nearest->samples == 8) return;
        nearest->color = glm::mix(nearest->color, added.color, 1.0 / ++nearest->samples);
        for (size_t c = 0; c < 3; ++c) nearest->clipped[c] = nearest->clipped[c] || added.clipped[c];
        return;
    }
    std::vector<Direction> directions;
    for (const SeenColor& s : seen) directions.push_back({on_grid(s.direction), 0});
    insert(directions, {on_grid(added.direction), 1}, kMost, 0);
    seen.resize(directions.size());
    for (size_t i = 0; i < seen.size(); ++i) {
        if (directions[i].id == 1) seen[i] = added;
    }
}

void vote(ObservedVoxel& voxel, uint32_t label) {
    if (label == 0) return;
    if (label == voxel.label) {
        voxel.confidence = std::min(voxel.confidence + 1, 255);
    } else if (--voxel.confidence <= 0) {
        voxel.label = label;
        voxel.confidence = 1;
    }
}

}  // namespace

std::set<std::array<int, 3>> seen_voxels(const ObservedFrame& frame, const ObservationRules& rules) {
    std::set<std::array<int, 3>> voxels;
    for (uint32_t y = rules.phase.y; y < frame.depth_camera.extent.height; y += rules.stride_px) {
        for (uint32_t x = rules.phase.x; x < frame.depth_camera.extent.width; x += rules.stride_px) {
            const glm::dvec4 point(frame.position_m.at(x, y));
            const Slope& slope = frame.slope.at(x, y);
            if (point.w <= 0 || slope.plane_factor == 0) continue;
            const double off = (double{frame.depth_m.at(x, y)} - point.w) * slope.plane_factor;
            const glm::dvec3 toward = glm::dvec3(frame.world_from_color[3]) - glm::dvec3(point);
            if (std::abs(off) > tolerance_m(rules, point.w)) continue;
            if (!faces(glm::dvec3(frame.normal.at(x, y)), toward, rules)) continue;
            const glm::ivec3 at(glm::floor(glm::dvec3(point) / rules.voxel_m));
            voxels.insert({at.x, at.y, at.z});
        }
    }
    return voxels;
}

void observe(ObservedVoxel& voxel, glm::ivec3 coordinates, const ObservedFrame& frame, const ObservationRules& rules) {
    const glm::dvec3 center_m = (glm::dvec3(coordinates) + 0.5) * rules.voxel_m;
    const auto point = [&] { return center_m + voxel.normal * voxel.offset_vox * rules.voxel_m; };
    if (const auto plane = plane_around(point(), center_m, voxel, frame, rules)) update_surface(voxel, *plane);
    if (voxel.surface_samples == 0) return;
    const glm::dvec3 toward = glm::dvec3(frame.world_from_color[3]) - point();
    const auto pixel = reading_of(point(), frame, rules);
    if (!pixel || !faces(voxel.normal, toward, rules)) return;
    vote(voxel, load(frame.labels, *pixel));
    if (!shows_face(*pixel, voxel, frame)) return;
    if (!is_even_around(*pixel, frame, rules) || !line_of_sight_is_free(point(), frame, rules)) return;
    if (voxel.seen.size() >= rules.smeared_observations && !is_sharp(point(), frame, rules)) return;
    if (const auto seen = seen_color(point(), frame)) add(voxel.seen, *seen, rules.merge_angle_degrees);
}

}  // namespace patina::reference
