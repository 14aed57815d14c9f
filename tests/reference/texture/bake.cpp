#include "tests/reference/texture/bake.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {
namespace {

constexpr double kGutter_px = 3.001;

/// Shares of a triangle's vertices at the point nearest to `p`, by trying all candidates.
std::array<double, 3> nearest_shares(const std::array<glm::dvec2, 3>& corners, glm::dvec2 p) {
    const glm::dmat2 edges(corners[1] - corners[0], corners[2] - corners[0]);
    if (std::abs(glm::determinant(edges)) > 1e-9) {
        const glm::dvec2 st = glm::inverse(edges) * (p - corners[0]);
        if (st.x >= 0 && st.y >= 0 && st.x + st.y <= 1) return {1 - st.x - st.y, st.x, st.y};
    }
    std::array<double, 3> best{};
    double nearest = 1e300;
    for (size_t i = 0; i < 3; ++i) {
        const size_t next = (i + 1) % 3;
        const glm::dvec2 edge = corners[next] - corners[i];
        const double along =
            std::clamp(glm::dot(p - corners[i], edge) / std::max(glm::dot(edge, edge), 1e-12), 0.0, 1.0);
        const double away = glm::distance(corners[i] + along * edge, p);
        if (away >= nearest) continue;
        nearest = away;
        best = {};
        best[i] = 1 - along;
        best[next] = along;
    }
    return best;
}

template <class Vector>
Vector mixed(const std::array<Vector, 3>& of, const std::array<double, 3>& shares) {
    return of[0] * shares[0] + of[1] * shares[1] + of[2] * shares[2];
}

glm::dvec4 pixel_or_zero(const Image<glm::dvec4>& image, glm::ivec2 at) {
    if (at.x < 0 || at.y < 0 || !image.extent().contains(at.x, at.y)) return glm::dvec4(0);
    return image.at(static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.y));
}

}  // namespace

std::optional<PlacedTexel> place_texel(const std::vector<PlacedTriangle>& triangles, uint32_t column, uint32_t row) {
    const glm::dvec2 center(column + 0.5, row + 0.5);
    std::optional<PlacedTexel> best;
    double nearest = kGutter_px;
    for (const PlacedTriangle& triangle : triangles) {
        const std::array<double, 3> shares = nearest_shares(triangle.places_px, center);
        const double away = glm::distance(mixed(triangle.places_px, shares), center);
        const double distance = away < 1e-9 ? 0 : away;
        if (distance >= nearest) continue;
        nearest = distance;
        best = PlacedTexel{mixed(triangle.positions_m, shares), mixed(triangle.normals, shares),
                           mixed(triangle.kd, shares), distance};
        if (distance == 0) break;
    }
    return best;
}

glm::dvec4 blend_picture(const BakePicture& picture, const glm::dvec3& position_m, const glm::dvec3& normal) {
    const glm::dvec4 none(0);
    const glm::dvec3 eye_m(picture.world_from_camera[3]);
    const glm::dvec3 p(rigid_inverse(picture.world_from_camera) * glm::dvec4(position_m, 1));
    if (p.z < 1e-3) return none;
    const Intrinsics& camera = picture.camera;
    const glm::dvec2 at(p.x / p.z * camera.fx + camera.cx, p.y / p.z * camera.fy + camera.cy);
    const double border = std::min({at.x, at.y, camera.extent.width - 1.0 - at.x, camera.extent.height - 1.0 - at.y});
    if (border <= 1) return none;
    const double range_m = glm::distance(eye_m, position_m);
    const double cosine = glm::dot(glm::normalize(normal), eye_m - position_m) / range_m;
    if (cosine < 0.1) return none;

    const glm::dvec2 scale(static_cast<double>(picture.position_m.extent().width) / camera.extent.width,
                           static_cast<double>(picture.position_m.extent().height) / camera.extent.height);
    const glm::dvec2 cast_at = (at + 0.5) * scale - 0.5;
    const double tolerance_m =
        1.5 * picture.voxel_m + 2 * p.z / (camera.fx * scale.x) * std::tan(std::acos(std::min(cosine, 1.0)));
    const glm::dvec2 low = glm::floor(cast_at), t = cast_at - low;
    glm::dvec3 light(0), highlight(0);
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 2; ++x) {
            const glm::ivec2 pixel(static_cast<int>(low.x) + x, static_cast<int>(low.y) + y);
            const glm::dvec4 hit = pixel_or_zero(picture.position_m, pixel);
            if (hit.w <= 0 || std::abs(hit.w - p.z) > tolerance_m) return none;
            const double share = (x == 1 ? t.x : 1 - t.x) * (y == 1 ? t.y : 1 - t.y);
            if (!picture.reflects) {
                light += share;
                continue;
            }
            const glm::dvec3 shine(pixel_or_zero(picture.light, pixel));
            const glm::dvec4 kd = pixel_or_zero(picture.kd, pixel);
            light += share * shine;
            if (kd.a > 0)
                highlight +=
                    share * glm::max(glm::dvec3(pixel_or_zero(picture.rgb, pixel)) - glm::dvec3(kd) * shine, 0.0);
        }
    }
    const glm::dvec2 first = glm::floor(at), s = at - first;
    glm::dvec3 color(0);
    for (int i = 0; i < 4; ++i) {
        const glm::ivec2 step(i % 2, i / 2);
        const glm::dvec4 pixel = pixel_or_zero(picture.color, glm::ivec2(first) + step);
        if (pixel.a != 1) return none;
        color += (step.x == 1 ? s.x : 1 - s.x) * (step.y == 1 ? s.y : 1 - s.y) * glm::dvec3(pixel);
    }
    if (std::min({light.r, light.g, light.b}) < 0.02) return none;
    const glm::dvec3 diffuse = glm::max(color / picture.gain - highlight, 0.0);
    const glm::dvec3 albedo = diffuse / light;
    if (std::max({albedo.r, albedo.g, albedo.b}) > 1.5) return none;
    const double of_diffuse = diffuse.r + diffuse.g + diffuse.b, of_shine = highlight.r + highlight.g + highlight.b;
    const double clear = of_diffuse / std::max(of_diffuse + of_shine, 1e-6);
    const double into = std::clamp(border / (0.06 * camera.extent.width), 0.0, 1.0);
    const double fade = into * into * (3 - 2 * into);
    const double centred = std::max(std::exp(-32 * glm::dot(at - glm::round(at), at - glm::round(at))), 0.05);
    const double weight = std::pow(cosine / (range_m * range_m), 2) * fade * std::max(clear * clear, 1e-3) * centred;
    return glm::dvec4(weight * albedo, weight);
}

}  // namespace patina::reference
