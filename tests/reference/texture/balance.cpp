#include "tests/reference/texture/balance.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {
namespace {

constexpr int kBlock = 8, kTaps = 4;
constexpr double kReach_m = 0.08, kOneSurface_m = 0.06, kFill_m = 0.03;

struct Block {
    glm::dvec3 position_m{0}, seen{0}, squares{0}, known{0};
    double count = 0;
    std::optional<glm::dvec3> factor;
};

struct Blocks {
    int width, height;
    std::vector<Block> all;

    Block* at(int x, int y) {
        return x < 0 || y < 0 || x >= width || y >= height ? nullptr : &all[static_cast<size_t>(y * width + x)];
    }
};

void average(const SeenPage& page, int x0, int y0, Block& block) {
    std::optional<glm::dvec3> origin;
    for (int y = y0; y < std::min(y0 + kBlock, static_cast<int>(page.extent.height)); ++y) {
        for (int x = x0; x < std::min(x0 + kBlock, static_cast<int>(page.extent.width)); ++x) {
            const size_t i = static_cast<size_t>(y) * page.extent.width + static_cast<size_t>(x);
            if (!page.position_m[i] || !page.seen[i]) continue;
            if (!origin) origin = page.position_m[i];
            if (glm::distance(*origin, *page.position_m[i]) > kOneSurface_m) continue;
            block.position_m += *page.position_m[i];
            block.seen += *page.seen[i];
            block.squares += *page.seen[i] * *page.seen[i];
            block.known += page.known[i];
            ++block.count;
        }
    }
    if (block.count == 0) return;
    block.position_m /= block.count;
    block.seen /= block.count;
    block.squares /= block.count;
    block.known /= block.count;
}

void balance(Blocks& blocks, int x, int y, int stride) {
    Block& own = *blocks.at(x, y);
    if (own.count == 0) return;
    glm::dvec3 seen(0), squares(0), known(0);
    double shares = 0, shares2 = 0;
    for (int dy = -kTaps; dy <= kTaps; ++dy) {
        for (int dx = -kTaps; dx <= kTaps; ++dx) {
            const Block* there = blocks.at(x + dx * stride, y + dy * stride);
            if (!there || there->count == 0) continue;
            const double away = glm::distance(there->position_m, own.position_m) / kReach_m;
            if (away > 1) continue;
            const double share = there->count * std::exp(-2 * away * away);
            seen += share * there->seen;
            squares += share * there->squares;
            known += share * there->known;
            shares += share;
            shares2 += share * share;
        }
    }
    own.factor = glm::dvec3(1);
    for (int c = 0; c < 3; ++c) {
        const double mean = seen[c] / shares, ratio = (known[c] / shares + 0.01) / (mean + 0.01);
        // The variance of a mean over as many records as taps, of which each shows one point.
        const double variance = std::max(squares[c] / shares - mean * mean, 0.0) * shares2 / (shares * shares);
        const double chance = std::sqrt(variance) / (mean + 0.01), off = std::abs(std::log(ratio));
        if (off <= chance) continue;
        const double left = std::pow(ratio, 1 - chance * chance / (off * off));
        (*own.factor)[c] = std::clamp(left, 0.25, 4.0);
    }
}

/// Between the four blocks around a texel.
struct Around {
    std::optional<glm::dvec3> factor, albedo;  ///< empty where none is of its surface
};

Around around_of(Blocks& blocks, double column, double row, const glm::dvec3& position_m) {
    const double u = column / kBlock - 0.5, v = row / kBlock - 0.5;
    const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
    glm::dvec3 sum(0), albedo(0);
    double shares = 0, near_shares = 0;
    for (int i = 0; i < 4; ++i) {
        const int dx = i % 2, dy = i / 2;
        const Block& block =
            *blocks.at(std::clamp(x + dx, 0, blocks.width - 1), std::clamp(y + dy, 0, blocks.height - 1));
        const double away = glm::distance(block.position_m, position_m);
        if (!block.factor || away > kReach_m) continue;
        const double share = (dx == 1 ? u - x : 1 - u + x) * (dy == 1 ? v - y : 1 - v + y) + 1e-4;
        sum += share * *block.factor;
        shares += share;
        if (away > kFill_m) continue;
        albedo += share * *block.factor * block.seen;
        near_shares += share;
    }
    Around around;
    if (shares > 0) around.factor = sum / shares;
    if (near_shares > 0) around.albedo = albedo / near_shares;
    return around;
}

}  // namespace

std::vector<glm::dvec3> balance_page(const SeenPage& page) {
    const int width = static_cast<int>(page.extent.width), height = static_cast<int>(page.extent.height);
    Blocks blocks{(width + kBlock - 1) / kBlock, (height + kBlock - 1) / kBlock, {}};
    blocks.all.resize(static_cast<size_t>(blocks.width * blocks.height));
    const int stride = std::max(static_cast<int>(std::lround(kReach_m / kTaps / (kBlock * page.texel_m))), 1);
    for (int y = 0; y < blocks.height; ++y)
        for (int x = 0; x < blocks.width; ++x) average(page, x * kBlock, y * kBlock, *blocks.at(x, y));
    for (int y = 0; y < blocks.height; ++y)
        for (int x = 0; x < blocks.width; ++x) balance(blocks, x, y, stride);
    std::vector<glm::dvec3> balanced(page.known.size(), glm::dvec3(0));
    for (size_t i = 0; i < balanced.size(); ++i) {
        if (!page.position_m[i]) continue;
        const double column = static_cast<double>(i % page.extent.width) + 0.5;
        const double row = static_cast<double>(i / page.extent.width) + 0.5;
        const Around around = around_of(blocks, column, row, *page.position_m[i]);
        if (page.seen[i]) {
            balanced[i] = around.factor ? *around.factor * *page.seen[i] : page.known[i];
        } else {
            balanced[i] = around.albedo.value_or(page.known[i]);
        }
    }
    return balanced;
}

}  // namespace patina::reference
