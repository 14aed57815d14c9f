#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace patina::surface {

// A cell's corner i lies at (i & 1, i >> 1 & 1, i >> 2). Its edge e leads from corner e & 7 along axis e >> 3; 12 of
// these 24 codes are edges. A case is the set of corners that are inside, as bits. A face's code is axis << 1 | side.

/// Where the surface meets a face of a cell: a directed line from one of the face's edges to another, with the inside
/// on its right as seen from outside the cell.
struct FaceSegment {
    uint8_t from;
    uint8_t to;

    bool operator==(const FaceSegment&) const = default;
};

/// The lines on one face, two at most. Where two inside corners lie diagonally opposite, each is cut off on its own;
/// the choice depends on the face's four corners alone, so the two cells at a face agree and the surface has no cracks.
std::vector<FaceSegment> face_segments(uint32_t which_case, uint32_t face);

using CaseTriangle = std::array<uint8_t, 3>;  ///< edges; counter-clockwise seen from outside the surface

/// The triangles of a case: the face segments joined to loops, every loop cut into triangles. No cut lies in a face,
/// where the neighbouring cell's could coincide with it.
std::vector<CaseTriangle> case_triangles(uint32_t which_case);

/// All cases as shaders/surface reads them, gpu::kCaseStride words each.
std::vector<uint32_t> packed_case_table();

}  // namespace patina::surface
