#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "export/close_holes.h"
#include "patina/scene.h"

namespace patina {

/// How a surface becomes one that is easy to edit and quick to load.
struct TidyOptions {
    /// Loose parts whose box has a shorter diagonal than this, or than so large a share of the whole's, are left out:
    /// stray readings, and backs of things that were hardly seen. 0: none are.
    double least_part_m = 0.05, least_part_share = 0.03;
    /// Patches of a segment with fewer vertices take the segment around them (merge_patches.h). 0: none do.
    uint32_t least_patch_vertices = 32;
    /// Holes whose border fits into a box of this diagonal are closed (close_holes.h). 0: none are.
    double most_hole_m = 0.05;
    /// Edges are collapsed while the surface stays within about this distance of what it was. 0: none are.
    double error_m = 1e-3;
    /// What brightness from black to white counts as height there, so that patterns stay; 0: a texture holds them.
    float white_m = 0.02f;
    /// Whether what is tidied may be a piece of a surface that others go on from: open borders then stay as they are.
    bool in_pieces = true;
    /// Triangles of the whole surface, about, whatever the distance is; 0: as many as error_m leaves. Empty: 100 000,
    /// or more where the surface would be farther than 1 cm from what it was; where error_m is 0, all.
    std::optional<uint64_t> most_triangles{};
};

/// A piece of a surface with what it reflects, and what became of the piece that it was made from.
struct TidyPiece {
    Mesh mesh;
    MeshReflectance reflectance;
    uint64_t loose_triangles = 0;      ///< left out
    uint64_t collapsed_triangles = 0;  ///< gone with edges
    uint64_t closed_holes = 0;
    std::vector<uint8_t> filled{};  ///< by vertex: 1 where a hole was closed and nothing was measured; empty: nowhere
};

/// A piece without its stray parts, small holes and specks of segments, and with as few triangles as options.error_m
/// asks for. Vertices are some of those there were. Segments still meet without gaps, each with its own vertices. A
/// part that a piece's end cuts off may go on in the next piece, and stays.
TidyPiece tidied(const Mesh& mesh, const MeshReflectance& reflectance, const TidyOptions& options);

/// Takes out the triangles of stray parts, such as those that collapsing cut off.
void leave_out_stray_parts(TidyPiece& piece, const TidyOptions& options);

/// Collapses edges until about `part` of the triangles are left, or the surface would be farther than `most_error_m`
/// from what it was; those that bend least go first. Of the options, white_m and in_pieces count.
/// Counts are those of this step.
TidyPiece reduced(const TidyPiece& piece, double part, const TidyOptions& options = {}, double most_error_m = 1e9);

}  // namespace patina
