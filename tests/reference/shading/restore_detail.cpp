#include "tests/reference/shading/restore_detail.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace patina::reference {

namespace {

double mean(glm::dvec3 v) { return (v.x + v.y + v.z) / 3; }

struct NearPixel {
    double share;
    glm::dvec3 kd, picture_kd, apparent;
    double shadow;
};

struct Pixel {
    uint32_t x, y;
};

bool is_lit(const DetailView& view, Pixel p) {
    const glm::dvec4 light = view.light.at(p.x, p.y);
    return std::min({light.x, light.y, light.z}) > 0.004 && view.color.at(p.x, p.y).a > 0;
}

glm::dvec3 apparent(const DetailView& view, Pixel p) {
    return glm::dvec3(view.color.at(p.x, p.y)) / glm::dvec3(view.light.at(p.x, p.y));
}

/// The pixels of every second place of a 5 x 5 pattern, two voxels wide, that show the same surface where it is lit and
/// known.
std::vector<NearPixel> near_pixels(const DetailView& view, Pixel p) {
    const glm::dvec4 hit = view.position_m.at(p.x, p.y);
    const double step_px = std::max(view.voxel_m * view.focal_px / hit.w / 2, 1.0);
    std::vector<NearPixel> found;
    for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
            if ((dx + dy) % 2 != 0) continue;
            const int x = static_cast<int>(p.x) + static_cast<int>(std::lround(dx * step_px));
            const int y = static_cast<int>(p.y) + static_cast<int>(std::lround(dy * step_px));
            if (!view.kd.extent().contains(x, y)) continue;
            const Pixel q{static_cast<uint32_t>(x), static_cast<uint32_t>(y)};
            const glm::dvec4 there = view.position_m.at(q.x, q.y);
            const glm::dvec3 away = glm::dvec3(there) - glm::dvec3(hit);
            const double off_plane = std::abs(glm::dot(away, glm::dvec3(view.normal.at(p.x, p.y))));
            if (there.w <= 0 || glm::length(away) >= 2 * view.voxel_m || off_plane >= view.voxel_m / 2) continue;
            if (!is_lit(view, q) || view.kd.at(q.x, q.y).a == 0 || view.light.at(q.x, q.y).a < 0) continue;
            found.push_back({std::exp(-2 * glm::dot(away, away) / (view.voxel_m * view.voxel_m)),
                             glm::dvec3(view.kd.at(q.x, q.y)), glm::dvec3(view.picture_kd.at(q.x, q.y)),
                             apparent(view, q), view.light.at(q.x, q.y).a});
        }
    }
    return found;
}

struct Albedos {
    glm::dvec3 kd, of_picture;
};

Albedos restored(const DetailView& view, Pixel p) {
    const glm::dvec3 known(view.kd.at(p.x, p.y)), of_picture(view.picture_kd.at(p.x, p.y));
    glm::dvec3 mean_kd(0), mean_picture_kd(0), mean_apparent(0);
    double shares = 0, brightness = 0, variance = 0, least = view.light.at(p.x, p.y).a, most = least;
    const std::vector<NearPixel> around = near_pixels(view, p);
    for (const NearPixel& n : around) {
        shares += n.share;
        mean_kd += n.share * n.kd;
        mean_picture_kd += n.share * n.picture_kd;
        mean_apparent += n.share * n.apparent;
        least = std::min(least, n.shadow);
        most = std::max(most, n.shadow);
    }
    if (shares == 0) return {known, of_picture};
    brightness = mean(mean_apparent) / shares;
    for (const NearPixel& n : around) variance += n.share * std::pow(mean(n.apparent) - brightness, 2) / shares;
    const double contrast2 = variance / (brightness * brightness);
    const double doubt = 0.1 + 0.5 * mean(glm::dvec3(view.ks_alpha.at(p.x, p.y))) / std::max(mean(known), 0.01);
    const double border = std::clamp((most - least - 0.05) / 0.2, 0.0, 1.0);
    const double even = 1 - border * border * (3 - 2 * border);
    const double counts = even * contrast2 / (contrast2 + doubt * doubt);
    const glm::dvec3 detail = apparent(view, p) / glm::max(mean_apparent, 1e-6);
    return {glm::mix(known, glm::min(glm::min(detail * mean_kd, 4.0 * known), 1.0), counts),
            glm::mix(of_picture, glm::min(detail * mean_picture_kd, 4.0 * of_picture), counts)};
}

}  // namespace

Detailed restore_detail(const DetailView& view) {
    Detailed result{view.kd, view.rgb};
    for (uint32_t y = 0; y < view.kd.extent().height; ++y) {
        for (uint32_t x = 0; x < view.kd.extent().width; ++x) {
            const Pixel p{x, y};
            if (view.position_m.at(x, y).w <= 0 || !is_lit(view, p)) continue;
            const glm::dvec3 before(view.picture_kd.at(x, y));
            const bool known = view.kd.at(x, y).a > 0;
            const bool marched = view.light.at(x, y).a >= 0;
            Albedos now{glm::dvec3(view.kd.at(x, y)), before};
            if (!known)
                now.kd = now.of_picture = glm::min(apparent(view, p), 1.0);
            else if (marched)
                now = restored(view, p);
            const glm::dvec3 added = (now.of_picture - before) * glm::dvec3(view.light.at(x, y));
            const glm::dvec3 rgb =
                glm::dvec3(marched ? view.rgb.at(x, y) : view.color.at(x, y)) + (marched ? added : glm::dvec3(0));
            result.kd.at(x, y) = glm::dvec4(now.kd, 1);
            result.rgb.at(x, y) = glm::dvec4(rgb, 1);
        }
    }
    return result;
}

}  // namespace patina::reference
