#include "tests/reference/texture/view.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {

namespace {

glm::dvec4 pixel_at(const Image<glm::dvec4>& image, int x, int y) {
    if (!image.extent().contains(x, y)) return glm::dvec4(0);
    return image.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
}

constexpr double kEyesApart_rad = 0.02;  // pictures from within it count most

/// Within 2 pixels of where a surface ends or bends sharply.
bool at_edge(const Image<glm::dvec4>& positions_m, int x, int y, double own_m, double voxel_m) {
    for (const glm::ivec2 step : {glm::ivec2(2, 0), glm::ivec2(0, 2), glm::ivec2(2, 2), glm::ivec2(2, -2)}) {
        const double one_m = pixel_at(positions_m, x + step.x, y + step.y).w;
        const double other_m = pixel_at(positions_m, x - step.x, y - step.y).w;
        if (one_m <= 0 || other_m <= 0) return true;
        if (std::abs(1 / one_m + 1 / other_m - 2 / own_m) * own_m * own_m > 3 * voxel_m) return true;
    }
    return false;
}

double sum_of(const glm::dvec3& v) { return v.r + v.g + v.b; }

}  // namespace

DiffusePicture diffuse_picture(const BakePicture& picture) {
    const Extent2D extent = picture.color.extent(), cast = picture.position_m.extent();
    DiffusePicture result{Image<glm::dvec4>(extent), Image<glm::dvec4>(extent)};
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const glm::dvec4 seen = picture.color.at(x, y);
            const double cx = (x + 0.5) * cast.width / extent.width - 0.5;
            const double cy = (y + 0.5) * cast.height / extent.height - 0.5;
            const double own_m = pixel_at(picture.position_m, static_cast<int>(std::floor(cx + 0.5)),
                                          static_cast<int>(std::floor(cy + 0.5)))
                                     .w;
            if (seen.a == 0 || own_m <= 0) continue;
            glm::dvec3 light(0), highlight(0), modelled(0);
            double shares = 0;
            for (int dy = 0; dy < 2; ++dy) {
                for (int dx = 0; dx < 2; ++dx) {
                    const int px = static_cast<int>(std::floor(cx)) + dx, py = static_cast<int>(std::floor(cy)) + dy;
                    const double share = (1 - std::abs(cx - px)) * (1 - std::abs(cy - py));
                    const double there_m = pixel_at(picture.position_m, px, py).w;
                    if (share <= 0 || there_m <= 0 || std::abs(there_m - own_m) > 3 * picture.voxel_m) continue;
                    const glm::dvec3 shine(pixel_at(picture.light, px, py));
                    const glm::dvec4 kd = pixel_at(picture.kd, px, py);
                    light += share * shine;
                    modelled += share * glm::dvec3(pixel_at(picture.rgb, px, py));
                    if (kd.a > 0)
                        highlight +=
                            share * glm::max(glm::dvec3(pixel_at(picture.rgb, px, py)) - glm::dvec3(kd) * shine, 0.0);
                    shares += share;
                }
            }
            if (shares == 0) continue;
            light /= shares;
            highlight /= shares;
            glm::dvec3 color = glm::dvec3(seen) / picture.gain;
            for (int c = 0; c < 3; ++c)
                if (seen.a == 0.5 && seen[c] >= 0.99) color[c] = std::max(color[c], modelled[c] / shares);
            const glm::dvec3 diffuse = color - highlight;
            const glm::dvec3 own = diffuse / glm::max(light, 0.02);
            const bool lit = std::min({light.r, light.g, light.b}) >= 0.02;
            const bool sane = std::max({own.r, own.g, own.b}) <= 1.5;
            const bool clear = sum_of(diffuse) >= 0.5 * sum_of(color);
            const bool edge = at_edge(picture.position_m, static_cast<int>(std::floor(cx + 0.5)),
                                      static_cast<int>(std::floor(cy + 0.5)), own_m, picture.voxel_m);
            const bool tells = seen.a == 1 && lit && sane && clear;
            result.diffuse.at(x, y) = edge    ? glm::dvec4(diffuse, 0.25)
                                      : tells ? glm::dvec4(glm::max(diffuse, 0.0), 1)
                                              : glm::dvec4(diffuse, 0.5);
            result.light.at(x, y) = glm::dvec4(light, 0);
        }
    }
    return result;
}

SaidToEye blend_diffuse(const BakePicture& picture, const DiffusePicture& taken, const glm::dvec3& position_m,
                        const glm::dvec3& normal, const glm::dvec3& eye_m) {
    const glm::dvec3 camera_m(picture.world_from_camera[3]);
    const glm::dvec3 p(rigid_inverse(picture.world_from_camera) * glm::dvec4(position_m, 1));
    const Intrinsics& camera = picture.camera;
    if (p.z < 1e-3) return {};
    const glm::dvec2 at(p.x / p.z * camera.fx + camera.cx, p.y / p.z * camera.fy + camera.cy);
    const double border = std::min({at.x, at.y, camera.extent.width - 1.0 - at.x, camera.extent.height - 1.0 - at.y});
    const double range_m = glm::distance(camera_m, position_m), away_m = glm::distance(eye_m, position_m);
    const double cosine = glm::dot(normal, camera_m - position_m) / range_m;
    if (border <= 1 || cosine < 0.1) return {};
    const Extent2D cast = picture.position_m.extent();
    const double scale_x = static_cast<double>(cast.width) / camera.extent.width;
    const double scale_y = static_cast<double>(cast.height) / camera.extent.height;
    const double tolerance_m =
        1.5 * picture.voxel_m + 2 * p.z / (camera.fx * scale_x) * std::sqrt(1 - cosine * cosine) / cosine;
    const int cx = static_cast<int>(std::floor((at.x + 0.5) * scale_x - 0.5));
    const int cy = static_cast<int>(std::floor((at.y + 0.5) * scale_y - 0.5));
    for (int i = 0; i < 4; ++i) {
        const double there_m = pixel_at(picture.position_m, cx + i % 2, cy + i / 2).w;
        if (there_m <= 0 || std::abs(there_m - p.z) > tolerance_m) return {};
    }
    const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
    glm::dvec3 leaves(0), albedo(0);
    double worth = 1;
    for (int i = 0; i < 4; ++i) {
        const int px = x + i % 2, py = y + i / 2;
        const glm::dvec4 pixel = pixel_at(taken.diffuse, px, py);
        const glm::dvec3 diffuse(pixel), light(pixel_at(taken.light, px, py));
        const double share = (1 - std::abs(at.x - px)) * (1 - std::abs(at.y - py));
        worth = std::min(worth, pixel.a);
        leaves += share * diffuse;
        for (int c = 0; c < 3; ++c) albedo[c] += share * diffuse[c] / std::max(light[c], 0.02);
    }
    if (worth == 0) return {};
    const glm::dvec3 to_eye = (eye_m - position_m) / away_m, to_camera = (camera_m - position_m) / range_m;
    const double sight =
        std::min(cosine / (range_m * range_m), std::max(glm::dot(normal, to_eye), 0.1) / (away_m * away_m));
    const double apart = glm::distance(to_eye, to_camera) / kEyesApart_rad;
    if (worth == 0.25 && apart > 2) return {};
    const double into = std::clamp(border / (0.06 * camera.extent.width), 0.0, 1.0);
    const double weight = std::pow(sight, 2) * into * into * (3 - 2 * into) / std::pow(1 + apart * apart, 2);
    return {worth == 1 ? glm::dvec4(weight * albedo, weight) : glm::dvec4(0), glm::dvec4(weight * leaves, weight)};
}

std::vector<glm::dvec4> means_of(const std::vector<ViewPixel>& view, Extent2D extent, bool told) {
    const auto sum_at = [&](size_t i) { return told ? view[i].said.told : view[i].said.shown; };
    std::vector<glm::dvec4> means(view.size(), glm::dvec4(0));
    const int width = static_cast<int>(extent.width), height = static_cast<int>(extent.height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const size_t own = static_cast<size_t>(y * width + x);
            if (!view[own].surface) continue;
            glm::dvec4 mean(0);
            if (sum_at(own).a > 0) {
                mean = sum_at(own) / sum_at(own).a;
            } else {
                for (int ny = std::max(y - 3, 0); ny <= std::min(y + 3, height - 1); ++ny) {
                    for (int nx = std::max(x - 3, 0); nx <= std::min(x + 3, width - 1); ++nx) {
                        const size_t there = static_cast<size_t>(ny * width + nx);
                        const glm::dvec4 sum = sum_at(there);
                        const glm::dvec3 away_m = view[there].position_m - view[own].position_m;
                        const double distance_m = glm::length(away_m);
                        if (sum.a <= 0 || distance_m > 0.03) continue;
                        if (std::abs(glm::dot(away_m, view[own].normal)) > 0.5 * distance_m) continue;
                        mean += std::exp(-0.5 * ((nx - x) * (nx - x) + (ny - y) * (ny - y))) * sum / sum.a;
                    }
                }
                if (mean.a > 0) mean /= mean.a;
            }
            means[own] = mean;
        }
    }
    return means;
}

}  // namespace patina::reference
