#include "export/atlas/level_seams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "export/atlas/find_seams.h"

namespace patina {
namespace {

constexpr int kRounds = 3;               // each leaves a part of the jump, as texels lie on both sides of a place
constexpr float kFilledTrust = 0.02f;    // of a texel that no picture shows
constexpr float kCoarserWeight = 0.25f;  // of the mean of a coarser level, in samples
constexpr float kLeastOnSeam = 0.1f;     // samples that reach a texel which lies on a seam
// Change of a root from which on sides of two segments are taken for two paints, and from which on for sure.
constexpr float kAlike = 0.05f, kApart = 0.1f;

glm::vec3 root_of(glm::vec3 albedo) { return glm::sqrt(glm::max(albedo, glm::vec3(0))); }

/// The four texels around a place, and their shares.
struct Corners {
    std::array<glm::uvec2, 4> at;
    std::array<float, 4> shares;
};

/// Of a place within an image by half a texel at least.
Corners corners_of(glm::vec2 place_px, Extent2D extent) {
    const glm::ivec2 last(static_cast<int>(extent.width) - 1, static_cast<int>(extent.height) - 1);
    const glm::vec2 at = glm::clamp(place_px - 0.5f, glm::vec2(0), glm::vec2(last));
    const glm::uvec2 low(at), high = glm::min(low + 1u, glm::uvec2(last));
    const glm::vec2 t = at - glm::vec2(low), s = 1.0f - t;
    return {{low, {high.x, low.y}, {low.x, high.y}, high}, {s.x * s.y, t.x * s.y, s.x * t.y, t.x * t.y}};
}

struct Seen {
    glm::vec3 root{0};
    float trust = 0;
};

Seen seen_at(const TexturePage& page, glm::vec2 place_px) {
    const Corners corners = corners_of(place_px, page.kd.extent());
    Seen seen;
    for (size_t i = 0; i < 4; ++i) {
        const glm::uvec2 at = corners.at[i];
        const bool shown = page.states.at(at.x, at.y) == TexelState::kSeen;
        seen.root += corners.shares[i] * root_of(page.kd.at(at.x, at.y));
        seen.trust += corners.shares[i] * (shown ? 1.0f : kFilledTrust);
    }
    return seen;
}

/// What a side of a seam has to change by, at a place of its page.
struct Change {
    uint32_t box = 0;
    glm::vec2 place_px{0};
    glm::vec3 root{0};
};

/// The share of a change that is made where two segments meet.
float share_between_segments(glm::vec3 change) {
    const glm::vec3 size = glm::abs(change);
    return 1 - glm::smoothstep(kAlike, kApart, std::max({size.r, size.g, size.b}));
}

void add_changes(const Seam& seam, const TextureLayout& layout, const std::vector<TexturePage>& pages,
                 std::vector<Change>& changes) {
    const SeamSide& first = seam.sides.front();
    const bool one_segment = std::ranges::all_of(seam.sides, [&](const SeamSide& side) {
        return layout.boxes[side.box].label == layout.boxes[first.box].label;
    });
    const auto samples = static_cast<uint32_t>(std::ceil(2 * glm::distance(first.from_px, first.to_px))) + 1;
    for (uint32_t k = 0; k < samples; ++k) {
        const float along = (static_cast<float>(k) + 0.5f) / static_cast<float>(samples);
        Seen mean;
        const size_t begin = changes.size();
        for (const SeamSide& side : seam.sides) {
            const glm::vec2 place_px = glm::mix(side.from_px, side.to_px, along);
            const Seen seen = seen_at(pages[side.page], place_px);
            mean.root += seen.trust * seen.root;
            mean.trust += seen.trust;
            changes.push_back({side.box, place_px, seen.root});
        }
        mean.root /= mean.trust;
        for (Change& change : std::span(changes).subspan(begin)) {
            change.root = mean.root - change.root;
            if (!one_segment) change.root *= share_between_segments(change.root);
        }
    }
}

/// An image of a box, or one of 2, 4, 8 ... times as large pixels.
struct Level {
    Extent2D extent;
    std::vector<glm::vec4> sums;  ///< rgb: of changes; a: of their weights

    explicit Level(Extent2D of) : extent(of), sums(of.area(), glm::vec4(0)) {}
    glm::vec4& at(glm::uvec2 pixel) { return sums[size_t{pixel.y} * extent.width + pixel.x]; }
};

Level halved(const Level& fine) {
    Level coarse({(fine.extent.width + 1) / 2, (fine.extent.height + 1) / 2});
    for (uint32_t y = 0; y < fine.extent.height; ++y)
        for (uint32_t x = 0; x < fine.extent.width; ++x)
            coarse.at({x / 2, y / 2}) += fine.sums[size_t{y} * fine.extent.width + x];
    return coarse;
}

/// The two pixels of a coarser level between whose centres that of a finer one lies, along one axis.
struct Between {
    uint32_t low, high;
    float share_of_high;
};

/// Of each pixel along an axis of the finer level.
std::vector<Between> between(uint32_t fine_px, uint32_t coarse_px) {
    std::vector<Between> all(fine_px);
    for (uint32_t i = 0; i < fine_px; ++i) {
        const auto last = static_cast<float>(coarse_px - 1);
        const float at = std::clamp((static_cast<float>(i) + 0.5f) * 0.5f - 0.5f, 0.0f, last);
        const auto low = static_cast<uint32_t>(at);
        all[i] = {low, std::min(low + 1, coarse_px - 1), at - static_cast<float>(low)};
    }
    return all;
}

/// The mean change around each pixel of the finest level: of as near samples as there are (pull-push, Gortler et al.
/// 1996, "The lumigraph").
std::vector<glm::vec3> spread(const Level& finest) {
    std::vector<Level> levels{finest};
    while (levels.back().extent.area() > 1) levels.push_back(halved(levels.back()));
    std::vector<glm::vec3> means{glm::vec3(levels.back().sums[0]) / levels.back().sums[0].a};
    for (size_t i = levels.size() - 1; i-- > 0;) {
        const Level& level = levels[i];
        const Extent2D coarse = levels[i + 1].extent;
        const std::vector<Between> columns = between(level.extent.width, coarse.width),
                                   rows = between(level.extent.height, coarse.height);
        std::vector<glm::vec3> finer(level.sums.size());
        auto sum = level.sums.begin();
        auto mean = finer.begin();
        for (const Between& row : rows) {
            const glm::vec3* const above = &means[size_t{row.low} * coarse.width];
            const glm::vec3* const below = &means[size_t{row.high} * coarse.width];
            const float t = row.share_of_high, s = 1 - t;
            for (const Between& column : columns) {
                const glm::vec3 &p = above[column.low], &q = above[column.high];
                const glm::vec3 &v = below[column.low], &w = below[column.high];
                const float u = column.share_of_high, r = 1 - u;
                // Number by number: vectors of a moment cost most of the time under sanitizers.
                const auto mean_of = [&, weight = sum->a + kCoarserWeight](float own, float a, float b, float c,
                                                                           float d) {
                    const float around = r * s * a + u * s * b + r * t * c + u * t * d;
                    return (own + kCoarserWeight * around) / weight;
                };
                mean->r = mean_of(sum->r, p.r, q.r, v.r, w.r);
                mean->g = mean_of(sum->g, p.g, q.g, v.g, w.g);
                mean->b = mean_of(sum->b, p.b, q.b, v.b, w.b);
                ++mean;
                ++sum;
            }
        }
        means = std::move(finer);
    }
    return means;
}

/// Lowers distances of a row by those of the row that was passed before it; none in the first.
void pass_row(std::span<float> row, std::span<const float> before) {
    constexpr float kDiagonal = std::numbers::sqrt2_v<float>;
    for (size_t x = 0; x < before.size(); ++x) {
        float nearest = std::min(row[x], before[x] + 1);
        if (x > 0) nearest = std::min(nearest, before[x - 1] + kDiagonal);
        if (x + 1 < before.size()) nearest = std::min(nearest, before[x + 1] + kDiagonal);
        row[x] = nearest;
    }
}

/// From each pixel to the nearest one on a seam, in pixels; steps are straight or diagonal.
std::vector<float> distances_px(const Level& finest) {
    const size_t width = finest.extent.width, height = finest.extent.height;
    std::vector<float> away(finest.sums.size());
    std::ranges::transform(finest.sums, away.begin(), [](const glm::vec4& sum) {
        return sum.a >= kLeastOnSeam ? 0 : std::numeric_limits<float>::max();
    });
    const std::span<float> all(away);
    for (size_t y = 0; y < height; ++y) {
        const std::span<float> row = all.subspan(y * width, width);
        if (y > 0) pass_row(row, all.subspan((y - 1) * width, width));
        for (size_t x = 1; x < width; ++x) row[x] = std::min(row[x], row[x - 1] + 1);
    }
    for (size_t y = height; y-- > 0;) {
        const std::span<float> row = all.subspan(y * width, width);
        if (y + 1 < height) pass_row(row, all.subspan((y + 1) * width, width));
        for (size_t x = width - 1; x-- > 0;) row[x] = std::min(row[x], row[x + 1] + 1);
    }
    return away;
}

void apply(std::span<const Change> changes, const TextureBox& box, float reach_px, TexturePage& page) {
    Level finest({box.high.x - box.low.x, box.high.y - box.low.y});
    for (const Change& change : changes) {
        const Corners corners = corners_of(change.place_px - glm::vec2(box.low), finest.extent);
        for (size_t i = 0; i < 4; ++i) finest.at(corners.at[i]) += corners.shares[i] * glm::vec4(change.root, 1);
    }
    const std::vector<glm::vec3> means = spread(finest);
    const std::vector<float> away_px = distances_px(finest);
    for (size_t i = 0; i < means.size(); ++i) {
        const glm::uvec2 at = box.low + glm::uvec2(i % finest.extent.width, i / finest.extent.width);
        if (away_px[i] >= reach_px || page.states.at(at.x, at.y) == TexelState::kEmpty) continue;
        glm::vec3& kd = page.kd.at(at.x, at.y);
        const glm::vec3 root = root_of(kd) + glm::smoothstep(reach_px, 0.0f, away_px[i]) * means[i];
        const glm::vec3 within = glm::clamp(root, 0.0f, 1.0f);
        kd = within * within;
    }
}

}  // namespace

void level_seams(const TextureLayout& layout, std::vector<TexturePage>& pages) {
    const std::vector<Seam> seams = find_seams(layout);
    const auto reach_px = static_cast<float>(kSeamReach_m / layout.texel_m);
    for (int round = 0; round < kRounds; ++round) {
        std::vector<Change> changes;
        for (const Seam& seam : seams) add_changes(seam, layout, pages, changes);
        std::ranges::stable_sort(changes, {}, &Change::box);
        for (auto first = changes.begin(); first != changes.end();) {
            const auto last = std::find_if(first, changes.end(), [&](const Change& c) { return c.box != first->box; });
            const TextureBox& box = layout.boxes[first->box];
            apply({first, last}, box, reach_px, pages[box.page]);
            first = last;
        }
    }
}

}  // namespace patina
