#include "tests/reference/segmentation/frame_segments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace patina::reference {

namespace {

constexpr std::array<glm::ivec2, 4> kNeighbours{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

glm::dvec3 ray_of(const Intrinsics& camera, glm::ivec2 pixel) {
    return {(pixel.x - camera.cx) / camera.fx, (pixel.y - camera.cy) / camera.fy, 1};
}

glm::ivec2 clamped(glm::ivec2 pixel, Extent2D extent) {
    return glm::clamp(pixel, glm::ivec2(0),
                      glm::ivec2(static_cast<int>(extent.width) - 1, static_cast<int>(extent.height) - 1));
}

int reach_px(const Intrinsics& camera, const SurfaceRules& rules, double z) {
    const double wanted = std::round(rules.reach_m * camera.fx / z);
    return static_cast<int>(std::clamp<double>(wanted, rules.min_reach_px, rules.max_reach_px));
}

int diagonal_px(int reach) { return static_cast<int>(std::lround(0.7 * reach)); }

double jump_limit_m(const Intrinsics& camera, const SurfaceRules& rules, double z, int apart) {
    return rules.jump_m + apart * z * std::tan(rules.steepest_degrees * std::numbers::pi / 180) / camera.fx;
}

}  // namespace

Image<uint32_t> components(const Image<float>& inner_depth_m, float floor_m, float slope) {
    const Extent2D extent = inner_depth_m.extent();
    Image<uint32_t> key(extent);
    std::vector<glm::ivec2> open;
    for (size_t first = 0; first < extent.area(); ++first) {
        if (inner_depth_m.pixels()[first] <= 0 || key.pixels()[first] != 0) continue;
        const auto name = static_cast<uint32_t>(first) + 1;
        key.pixels()[first] = name;
        open.push_back({first % extent.width, first / extent.width});
        while (!open.empty()) {
            const glm::ivec2 here = open.back();
            open.pop_back();
            const float z = inner_depth_m.at(here.x, here.y);
            for (const glm::ivec2 step : kNeighbours) {
                const glm::ivec2 there = here + step;
                if (!extent.contains(there.x, there.y) || key.at(there.x, there.y) != 0) continue;
                const float other = inner_depth_m.at(there.x, there.y);
                if (other <= 0 || std::abs(other - z) > floor_m + slope * std::max(z, other)) continue;
                key.at(there.x, there.y) = name;
                open.push_back(there);
            }
        }
    }
    return key;
}

Segments number_segments(const Image<uint32_t>& key, const Image<float>& depth_m, uint32_t min_pixels,
                         uint32_t capacity) {
    const Extent2D extent = key.extent();
    std::map<uint32_t, uint32_t> pixels, numbers;
    for (size_t i = 0; i < extent.area(); ++i) {
        if (key.pixels()[i] != 0 && depth_m.pixels()[i] > 0) ++pixels[key.pixels()[i]];
    }
    Segments out;
    out.number = Image<uint32_t>(extent);
    out.segments.emplace_back();
    for (const auto& [name, count] : pixels) {
        if (count < min_pixels) {
            ++out.too_small;
        } else if (out.segments.size() > capacity) {
            ++out.beyond_capacity;
        } else {
            numbers[name] = static_cast<uint32_t>(out.segments.size());
            out.segments.push_back({name});
        }
    }
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const auto found = numbers.find(key.at(x, y));
            if (found == numbers.end() || depth_m.at(x, y) <= 0) continue;
            out.number.at(x, y) = found->second;
            Segment& segment = out.segments[found->second];
            ++segment.pixels;
            segment.touches_border |= x == 0 || y == 0 || x == extent.width - 1 || y == extent.height - 1;
        }
    }
    return out;
}

Image<glm::dvec3> fit_normals(const Image<float>& depth_m, const Intrinsics& camera, const SurfaceRules& rules) {
    const Extent2D extent = depth_m.extent();
    Image<glm::dvec3> normal(extent, glm::dvec3(0));
    for (int y = 0; y < static_cast<int>(extent.height); ++y) {
        for (int x = 0; x < static_cast<int>(extent.width); ++x) {
            const double z = depth_m.at(x, y);
            if (z <= 0) continue;
            const int reach = reach_px(camera, rules, z), d = diagonal_px(reach);
            // Inverse depth; a pixel that does not count is taken to be at the centre.
            const auto at = [&](glm::ivec2 place, int& counted) {
                const double other = extent.contains(place.x, place.y) ? depth_m.at(place.x, place.y) : 0.0f;
                const bool counts = other > 0 && std::abs(other - z) <= jump_limit_m(camera, rules, z, reach);
                counted += counts;
                return 1 / (counts ? other : z);
            };
            double xx = 0, xy = 0, yy = 0, xr = 0, yr = 0;
            for (const glm::ivec2 step : {glm::ivec2(reach, 0), {0, reach}, {d, d}, {d, -d}}) {
                int sides = 0;
                const double rise = at(glm::ivec2(x, y) + step, sides) - at(glm::ivec2(x, y) - step, sides);
                const glm::dvec2 span = glm::dvec2(step) * double(sides);
                xx += span.x * span.x, xy += span.x * span.y, yy += span.y * span.y;
                xr += span.x * rise, yr += span.y * rise;
            }
            const double determinant = xx * yy - xy * xy;
            if (determinant < 0.5) continue;
            const glm::dvec2 slope((yy * xr - xy * yr) / determinant, (xx * yr - xy * xr) / determinant);
            normal.at(x, y) =
                -glm::normalize(glm::dvec3(slope.x * camera.fx, slope.y * camera.fy,
                                           1 / z - slope.x * (x - camera.cx) - slope.y * (y - camera.cy)));
        }
    }
    return normal;
}

Image<uint8_t> find_edges(const Image<float>& depth_m, const Image<glm::dvec3>& normal, const Intrinsics& camera,
                          const SurfaceRules& rules) {
    const Extent2D extent = depth_m.extent();
    Image<uint8_t> edge(extent);
    for (int y = 0; y < static_cast<int>(extent.height); ++y) {
        for (int x = 0; x < static_cast<int>(extent.width); ++x) {
            const double z = depth_m.at(x, y);
            if (z <= 0) continue;
            const glm::dvec3 here = normal.at(x, y);
            if (here == glm::dvec3(0)) {
                edge.at(x, y) = 1;
                continue;
            }
            const int reach = reach_px(camera, rules, z), d = diagonal_px(reach);
            const double sigma_m = rules.noise_floor_m + rules.noise_per_m * z * z;
            const double sigma =
                std::numbers::sqrt2 * sigma_m * camera.fx / z / std::sqrt(2.0 * reach * reach + 4.0 * d * d);
            const double limit = rules.crease_degrees * std::numbers::pi / 180 + rules.crease_sigmas * sigma;
            for (const glm::ivec2 step : {glm::ivec2(reach, 0), {0, reach}}) {
                glm::dvec3 points[2], normals[2];
                for (const int side : {0, 1}) {
                    const glm::ivec2 place = clamped(glm::ivec2(x, y) + (side == 0 ? -step : step), extent);
                    const double other = depth_m.at(place.x, place.y);
                    const bool joined = normal.at(place.x, place.y) != glm::dvec3(0) &&
                                        std::abs(other - z) <= jump_limit_m(camera, rules, z, reach);
                    points[side] = joined ? ray_of(camera, place) * other : ray_of(camera, {x, y}) * z;
                    normals[side] = joined ? normal.at(place.x, place.y) : here;
                }
                const bool concave = glm::dot(points[1] - points[0], normals[1] - normals[0]) < 0;
                const double angle = std::acos(std::clamp(glm::dot(normals[0], normals[1]), -1.0, 1.0));
                // How far each side's tangent plane passes by the other side's point, of which a bend does to both the
                // same.
                const double step_m =
                    glm::dot(points[1] - points[0], normals[0]) / 2 + glm::dot(points[1] - points[0], normals[1]) / 2;
                const bool stepped =
                    std::abs(step_m) > rules.step_m + rules.step_sigmas * sigma_m && angle < std::acos(0.95);
                if ((concave && angle > limit) || stepped) edge.at(x, y) = 1;
            }
        }
    }
    return edge;
}

}  // namespace patina::reference
