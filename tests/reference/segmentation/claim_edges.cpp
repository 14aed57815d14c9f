#include "tests/reference/segmentation/claim_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace patina::reference {
namespace {

constexpr std::array<glm::ivec2, 4> kDirections{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

/// A component beside a pixel.
struct Neighbour {
    uint32_t key = 0;
    double distance_m = 0;  ///< of the pixel from its tangent plane
    bool on_plane = false;  ///< else it lies behind that, as over a convex fold
    std::optional<glm::ivec2> chroma;
};

class Claim {
  public:
    Claim(const ComponentPicture& picture, const ClaimRules& rules) : picture_(picture), rules_(rules) {
        for (const uint32_t key : picture.component.pixels()) ++pixels_[key];
    }

    uint32_t large_at(glm::ivec2 at) const {
        const uint32_t key = picture_.component.at(at.x, at.y);
        return key != 0 && pixels_.at(key) >= rules_.min_pixels ? key : 0;
    }

    /// The nearest component in a direction, if the pixel lies on its plane or folds away from it in one hue.
    std::optional<Neighbour> beside(glm::ivec2 pixel, glm::ivec2 direction) const {
        const double z = picture_.depth_m.at(pixel.x, pixel.y);
        const double sigma_m = rules_.noise_floor_m + rules_.noise_per_m * z * z;
        for (int step = 1; step <= rules_.reach_px; ++step) {
            const glm::ivec2 at = pixel + step * direction;
            if (!picture_.component.extent().contains(at.x, at.y)) return {};
            const uint32_t key = large_at(at);
            if (key == 0) continue;
            const glm::dvec3 apart_m = point_m(at) - point_m(pixel);
            const double behind_m = glm::dot(apart_m, picture_.normal.at(at.x, at.y));
            const bool on_plane = std::abs(behind_m) < rules_.claim_m + rules_.claim_sigmas * sigma_m;
            const double steepest = std::tan(rules_.steepest_degrees * std::numbers::pi / 180) / picture_.camera.fx;
            const bool jumps = std::abs(apart_m.z) > rules_.jump_m + step * steepest * z;
            if (!on_plane && (behind_m <= 0 || jumps || !same_hue(pixel, at))) return {};
            return Neighbour{key, std::abs(behind_m), on_plane, picture_.chroma.at(at.x, at.y)};
        }
        return {};
    }

    double cost_m(glm::ivec2 pixel, const Neighbour& neighbour) const {
        const auto& own = picture_.chroma.at(pixel.x, pixel.y);
        const double folded_m = neighbour.on_plane ? 0 : 1;  // any plane is preferred to a fold
        if (!own || !neighbour.chroma) return folded_m + neighbour.distance_m;
        const glm::ivec2 apart = glm::abs(*own - *neighbour.chroma);
        return folded_m + neighbour.distance_m + rules_.chroma_weight_m * std::max(apart.x, apart.y) / 4095.0;
    }

  private:
    /// Whether two colours differ by little across the direction from grey.
    bool same_hue(glm::ivec2 a, glm::ivec2 b) const {
        if (!picture_.chroma.at(a.x, a.y) || !picture_.chroma.at(b.x, b.y)) return false;
        const glm::dvec2 one = glm::dvec2(*picture_.chroma.at(a.x, a.y)) / 4095.0 - 1.0 / 3;
        const glm::dvec2 two = glm::dvec2(*picture_.chroma.at(b.x, b.y)) / 4095.0 - 1.0 / 3;
        if (glm::dot(one, two) < 0) return glm::distance(one, two) < rules_.same_hue;
        const double sine = std::sin(std::atan2(one.x * two.y - one.y * two.x, glm::dot(one, two)));
        return std::abs(sine) * std::min(glm::length(one), glm::length(two)) < rules_.same_hue;
    }

    glm::dvec3 point_m(glm::ivec2 at) const {
        const Intrinsics& camera = picture_.camera;
        return glm::dvec3((at.x - camera.cx) / camera.fx, (at.y - camera.cy) / camera.fy, 1) *
               double{picture_.depth_m.at(at.x, at.y)};
    }

    const ComponentPicture& picture_;
    const ClaimRules& rules_;
    std::map<uint32_t, uint32_t> pixels_;
};

void add_contact(Claims& claims, const Neighbour& a, const Neighbour& b) {
    if (a.key == b.key || !a.on_plane || !b.on_plane || !a.chroma || !b.chroma) return;
    const Neighbour &low = a.key < b.key ? a : b, &high = a.key < b.key ? b : a;
    ContactSum& contact = claims.contacts[{low.key, high.key}];
    ++contact.pixels;
    contact.low += *low.chroma;
    contact.high += *high.chroma;
}

}  // namespace

Claims claim_edges(const ComponentPicture& picture, const ClaimRules& rules) {
    const Claim claim(picture, rules);
    const Extent2D extent = picture.component.extent();
    Claims claims{Image<uint32_t>(extent), {}};
    for (int y = 0; y < static_cast<int>(extent.height); ++y) {
        for (int x = 0; x < static_cast<int>(extent.width); ++x) {
            const glm::ivec2 pixel(x, y);
            uint32_t& key = claims.component.at(x, y);
            key = claim.large_at(pixel);
            if (key != 0 || picture.depth_m.at(x, y) <= 0) continue;
            std::array<std::optional<Neighbour>, 4> beside;
            double least_m = 1e9;
            for (size_t i = 0; i < 4; ++i) {
                beside[i] = claim.beside(pixel, kDirections[i]);
                if (!beside[i] || claim.cost_m(pixel, *beside[i]) >= least_m) continue;
                least_m = claim.cost_m(pixel, *beside[i]);
                key = beside[i]->key;
            }
            if (beside[0] && beside[1]) add_contact(claims, *beside[0], *beside[1]);
            if (beside[2] && beside[3]) add_contact(claims, *beside[2], *beside[3]);
        }
    }
    return claims;
}

bool is_fold(const ContactSum& contact, const FoldRules& rules) {
    const double pixels = contact.pixels;
    const glm::dvec2 low = glm::dvec2(contact.low) / (4095 * pixels) - 1.0 / 3;
    const glm::dvec2 high = glm::dvec2(contact.high) / (4095 * pixels) - 1.0 / 3;
    const double saturation = std::min(glm::length(low), glm::length(high));
    const double between = std::abs(std::atan2(low.x * high.y - low.y * high.x, glm::dot(low, high)));
    return saturation > rules.strong_chroma && between <= glm::radians(rules.same_hue_degrees) &&
           std::abs(glm::length(low) - glm::length(high)) <= rules.same_saturation &&
           pixels * saturation * saturation >= rules.least_weight;
}

std::map<uint32_t, uint32_t> joined(const std::set<std::pair<uint32_t, uint32_t>>& pairs) {
    std::map<uint32_t, uint32_t> root;
    for (const auto& [a, b] : pairs) root.insert({{a, a}, {b, b}});
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [a, b] : pairs) {
            const uint32_t least = std::min(root[a], root[b]);
            changed = changed || root[a] != least || root[b] != least;
            root[a] = root[b] = least;
        }
    }
    return root;
}

}  // namespace patina::reference
