#include "passes/surface/case_table.h"

#include <algorithm>
#include <map>
#include <set>

#include <gmock/gmock.h>

#include "shared/surface/extract_surface.h"

namespace patina::surface::case_table_test {
namespace {

constexpr uint32_t kCases = 256;

struct Ends {
    uint32_t low;
    uint32_t high;
};
Ends ends_of(uint32_t edge) { return {edge & 7, (edge & 7) | 1u << (edge >> 3)}; }

bool crossed(uint32_t which_case, uint32_t edge) {
    const auto [low, high] = ends_of(edge);
    return (which_case >> low & 1) != (which_case >> high & 1);
}

/// The edge of the cell beyond face (axis, 1) that is this edge of the face.
uint8_t moved_down(uint32_t edge, uint32_t axis) { return static_cast<uint8_t>(edge & ~(1u << axis)); }

/// The corners of a case on face (axis, side), as bits of the four corners with bit `axis` clear.
uint32_t pattern_on_face(uint32_t which_case, uint32_t axis, uint32_t side) {
    uint32_t pattern = 0;
    for (uint32_t corner = 0; corner < 8; ++corner) {
        if ((corner >> axis & 1) == 0) pattern |= (which_case >> (corner | side << axis) & 1) << corner;
    }
    return pattern;
}

using Walk = std::pair<uint8_t, uint8_t>;

/// The sides of a case's triangles that no other of its triangles walks in the opposite direction.
std::multiset<Walk> border(uint32_t which_case) {
    std::multiset<Walk> walks;
    for (const CaseTriangle& triangle : case_triangles(which_case)) {
        for (size_t i = 0; i < 3; ++i) {
            const Walk walk{triangle[i], triangle[(i + 1) % 3]};
            const auto opposite = walks.find({walk.second, walk.first});
            if (opposite != walks.end()) {
                walks.erase(opposite);
            } else {
                walks.insert(walk);
            }
        }
    }
    return walks;
}

TEST(CaseTable, TrianglesUseTheCrossedEdgesAndEndInTheFaceSegments) {
    for (uint32_t which = 0; which < kCases; ++which) {
        std::set<uint8_t> used;
        for (const CaseTriangle& triangle : case_triangles(which)) used.insert(triangle.begin(), triangle.end());
        for (uint8_t edge = 0; edge < 24; ++edge) {
            const bool is_edge = (edge & 7 & 1 << (edge >> 3)) == 0;
            EXPECT_EQ(used.contains(edge), is_edge && crossed(which, edge)) << "case " << which << " edge " << +edge;
        }
        std::multiset<Walk> segments;
        for (uint32_t face = 0; face < 6; ++face) {
            for (const FaceSegment& segment : face_segments(which, face)) segments.insert({segment.from, segment.to});
        }
        EXPECT_EQ(border(which), segments) << "case " << which;
    }
}

TEST(CaseTable, CellsAtAFaceWalkItsSegmentsInOppositeDirections) {
    size_t pairs = 0;
    for (uint32_t axis = 0; axis < 3; ++axis) {
        for (uint32_t low = 0; low < kCases; ++low) {
            std::multiset<Walk> reversed;
            for (const FaceSegment& segment : face_segments(low, axis << 1 | 1)) {
                reversed.insert({moved_down(segment.to, axis), moved_down(segment.from, axis)});
            }
            for (uint32_t high = 0; high < kCases; ++high) {
                if (pattern_on_face(low, axis, 1) != pattern_on_face(high, axis, 0)) continue;
                std::multiset<Walk> walked;
                for (const FaceSegment& segment : face_segments(high, axis << 1)) {
                    walked.insert({segment.from, segment.to});
                }
                EXPECT_EQ(walked, reversed) << "axis " << axis << " cases " << low << ", " << high;
                ++pairs;
            }
        }
    }
    EXPECT_EQ(pairs, 3u * 16 * 16 * 16);  // 16 patterns on the face, 16 on each cell's other side
}

TEST(CaseTable, NoSideWithinACellLiesInAFace) {
    const auto in_face = [](uint32_t edge, uint32_t axis, uint32_t side) {
        return edge >> 3 != axis && (edge >> axis & 1) == side;
    };
    for (uint32_t which = 0; which < kCases; ++which) {
        std::multiset<Walk> inner;
        for (const CaseTriangle& triangle : case_triangles(which)) {
            for (size_t i = 0; i < 3; ++i) inner.insert({triangle[i], triangle[(i + 1) % 3]});
        }
        for (const Walk& walk : border(which)) inner.erase(inner.find(walk));
        for (const auto& [a, b] : inner) {
            for (uint32_t face = 0; face < 6; ++face) {
                EXPECT_FALSE(in_face(a, face >> 1, face & 1) && in_face(b, face >> 1, face & 1))
                    << "case " << which << " edges " << +a << ", " << +b;
            }
        }
    }
}

TEST(CaseTable, ASingleInsideCornerFacesAwayFromIt) {
    // Corner 0 inside: counter-clockwise seen from (1, 1, 1) is x, y, z.
    const std::vector<CaseTriangle> triangles = case_triangles(1);
    ASSERT_EQ(triangles.size(), 1u);
    CaseTriangle triangle = triangles.front();
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    EXPECT_EQ(triangle, (CaseTriangle{0, 1 << 3, 2 << 3}));
}

TEST(CaseTable, PackedTableHoldsEveryTriangle) {
    const std::vector<uint32_t> packed = packed_case_table();
    ASSERT_EQ(packed.size(), kCases * gpu::kCaseStride);
    size_t most = 0;
    for (uint32_t which = 0; which < kCases; ++which) {
        const std::vector<CaseTriangle> triangles = case_triangles(which);
        const uint32_t* entry = &packed[which * gpu::kCaseStride];
        ASSERT_EQ(entry[0], triangles.size());
        most = std::max(most, triangles.size());
        for (size_t i = 0; i < triangles.size(); ++i) {
            EXPECT_EQ(entry[1 + i] & 31, triangles[i][0]);
            EXPECT_EQ(entry[1 + i] >> 5 & 31, triangles[i][1]);
            EXPECT_EQ(entry[1 + i] >> 10, triangles[i][2]);
        }
    }
    EXPECT_EQ(most, gpu::kMaxCaseTriangles);
}

}  // namespace
}  // namespace patina::surface::case_table_test
