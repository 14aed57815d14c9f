#include "export/atlas/pack_boxes.h"

#include <algorithm>

#include "engine/core/error.h"

#define STB_RECT_PACK_IMPLEMENTATION
#define STBRP_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_rect_pack.h>
#pragma GCC diagnostic pop

namespace patina {
namespace {

constexpr uint32_t kLeastPage = 64;
constexpr uint32_t kRows = 4;  // pages are so many texels high, or a multiple of it

/// Packs what fits of `left` into a page of `side` and removes it from there.
Extent2D fill_page(std::vector<stbrp_rect>& left, uint32_t side, uint32_t page, PackedBoxes& packed) {
    std::vector<stbrp_node> nodes(side);
    stbrp_context context;
    const int edge = static_cast<int>(side);
    stbrp_init_target(&context, edge, edge, nodes.data(), edge);
    stbrp_pack_rects(&context, left.data(), static_cast<int>(left.size()));
    uint32_t height = 0;
    for (const stbrp_rect& box : left) {
        if (!box.was_packed) continue;
        const glm::uvec2 at(box.x, box.y);
        packed.places[static_cast<size_t>(box.id)] = {page, at};
        height = std::max(height, at.y + static_cast<uint32_t>(box.h));
    }
    std::erase_if(left, [](const stbrp_rect& box) { return box.was_packed != 0; });
    return {side, (height + kRows - 1) / kRows * kRows};
}

}  // namespace

PackedBoxes pack_boxes(std::span<const glm::uvec2> boxes, uint32_t page) {
    PackedBoxes packed;
    packed.places.resize(boxes.size());
    std::vector<stbrp_rect> left;
    uint64_t area = 0;
    uint32_t widest = 0;
    for (size_t i = 0; i < boxes.size(); ++i) {
        left.push_back({static_cast<int>(i), static_cast<int>(boxes[i].x), static_cast<int>(boxes[i].y), 0, 0, 0});
        area += uint64_t{boxes[i].x} * boxes[i].y;
        widest = std::max({widest, boxes[i].x, boxes[i].y});
    }
    if (widest > page) throw Error("a chart of ", widest, " texels does not fit into a page of ", page);
    uint32_t side = kLeastPage;
    while (side < page && (side < widest || uint64_t{side} * side < area)) side *= 2;
    for (; !left.empty() && side < page; side *= 2) {
        std::vector<stbrp_rect> attempt = left;
        PackedBoxes whole = packed;
        whole.pages.push_back(fill_page(attempt, std::min(side, page), 0, whole));
        if (attempt.empty()) return whole;
    }
    while (!left.empty())
        packed.pages.push_back(fill_page(left, page, static_cast<uint32_t>(packed.pages.size()), packed));
    return packed;
}

}  // namespace patina
