#include "passes/surface/case_table.h"

#include <algorithm>
#include <optional>

#include "engine/core/error.h"
#include "shared/surface/extract_surface.h"

namespace patina::surface {

namespace {

constexpr uint32_t kFaces = 6;
constexpr uint32_t kEdgeCodes = 24;

bool is_inside(uint32_t which_case, uint32_t corner) { return (which_case >> corner & 1) != 0; }

uint8_t edge_between(uint32_t corner_a, uint32_t corner_b) {
    const uint32_t axis = (corner_a ^ corner_b) >> 1;  // 1, 2, 4 to 0, 1, 2
    return static_cast<uint8_t>(std::min(corner_a, corner_b) | axis << gpu::kCornerBits);
}

/// A face's corners, counter-clockwise seen from outside the cell.
std::array<uint32_t, 4> face_corners(uint32_t face) {
    const uint32_t axis = face >> 1, side = face & 1;
    const uint32_t u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3;
    const uint32_t base = side << axis;
    if (side == 1) return {base, base | u, base | u | v, base | v};
    return {base, base | v, base | u | v, base | u};
}

/// Whether an edge lies in a face.
bool touches(uint32_t edge, uint32_t face) {
    const uint32_t axis = face >> 1, side = face & 1;
    return edge >> gpu::kCornerBits != axis && (edge >> axis & 1) == side;
}

bool share_a_face(uint32_t edge_a, uint32_t edge_b) {
    for (uint32_t face = 0; face < kFaces; ++face) {
        if (touches(edge_a, face) && touches(edge_b, face)) return true;
    }
    return false;
}

using Loop = std::vector<uint8_t>;

std::vector<Loop> trace_loops(uint32_t which_case) {
    std::array<std::optional<uint8_t>, kEdgeCodes> next;
    for (uint32_t face = 0; face < kFaces; ++face) {
        for (const FaceSegment& segment : face_segments(which_case, face)) next[segment.from] = segment.to;
    }
    std::vector<Loop> loops;
    for (uint32_t start = 0; start < kEdgeCodes; ++start) {
        Loop loop;
        for (uint32_t edge = start; next[edge];) {
            loop.push_back(static_cast<uint8_t>(edge));
            const uint8_t to = *next[edge];
            next[edge].reset();
            edge = to;
        }
        if (!loop.empty()) loops.push_back(loop);
    }
    return loops;
}

/// Cuts a loop into triangles by cutting off one corner after the other, the first whose cut does not lie in a face.
std::vector<CaseTriangle> triangulate(Loop loop) {
    std::vector<CaseTriangle> triangles;
    while (loop.size() > 3) {
        const size_t n = loop.size();
        size_t ear = 0;
        while (ear < n && share_a_face(loop[ear], loop[(ear + 2) % n])) ++ear;
        PATINA_ASSERT(ear < n, "no cut of a loop of ", n, " edges avoids the cell's faces");
        triangles.push_back({loop[ear], loop[(ear + 1) % n], loop[(ear + 2) % n]});
        loop.erase(loop.begin() + static_cast<std::ptrdiff_t>((ear + 1) % n));
    }
    triangles.push_back({loop[0], loop[1], loop[2]});
    return triangles;
}

}  // namespace

std::vector<FaceSegment> face_segments(uint32_t which_case, uint32_t face) {
    const std::array<uint32_t, 4> corners = face_corners(face);
    std::vector<FaceSegment> segments;
    for (uint32_t i = 0; i < 4; ++i) {
        if (is_inside(which_case, corners[i]) || !is_inside(which_case, corners[(i + 1) % 4])) continue;
        // A run of inside corners begins after corner i; cut it off where it ends.
        uint32_t last = i + 1;
        while (is_inside(which_case, corners[(last + 1) % 4])) ++last;
        segments.push_back(
            {edge_between(corners[i], corners[(i + 1) % 4]), edge_between(corners[last % 4], corners[(last + 1) % 4])});
    }
    return segments;
}

std::vector<CaseTriangle> case_triangles(uint32_t which_case) {
    std::vector<CaseTriangle> triangles;
    for (const Loop& loop : trace_loops(which_case)) {
        const std::vector<CaseTriangle> part = triangulate(loop);
        triangles.insert(triangles.end(), part.begin(), part.end());
    }
    return triangles;
}

std::vector<uint32_t> packed_case_table() {
    std::vector<uint32_t> table(256 * gpu::kCaseStride);
    for (uint32_t which = 0; which < 256; ++which) {
        const std::vector<CaseTriangle> triangles = case_triangles(which);
        PATINA_ASSERT(triangles.size() <= gpu::kMaxCaseTriangles, "case ", which, " has ", triangles.size(),
                      " triangles");
        table[which * gpu::kCaseStride] = static_cast<uint32_t>(triangles.size());
        for (size_t i = 0; i < triangles.size(); ++i) {
            const auto& [a, b, c] = triangles[i];
            table[which * gpu::kCaseStride + 1 + i] =
                uint32_t{a} | uint32_t{b} << gpu::kCaseEdgeBits | uint32_t{c} << 2 * gpu::kCaseEdgeBits;
        }
    }
    return table;
}

}  // namespace patina::surface
