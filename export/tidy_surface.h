#pragma once

#include <cstdint>
#include <vector>

#include "patina/scene.h"

namespace patina {

/// How a surface becomes one that is easy to edit and quick to load.
struct TidyOptions {
    /// Loose parts whose box has a shorter diagonal are left out: stray readings. 0: none are.
    double least_part_m = 0.05;
    /// Edges are collapsed while the surface stays within about this distance of what it was. Brightness counts as
    /// height, 2 cm from black to white, so that patterns stay. 0: none are.
    double error_m = 1e-3;
    /// Triangles of the whole surface, about, whatever the distance is; 0: as many as error_m leaves.
    uint64_t most_triangles = 0;
};

/// A piece of a surface with what it reflects, and what became of the piece that it was made from.
struct TidyPiece {
    Mesh mesh;
    MeshReflectance reflectance;
    uint64_t loose_triangles = 0;      ///< left out
    uint64_t collapsed_triangles = 0;  ///< gone with edges
};

/// A piece without its stray parts, and with as few triangles as options.error_m asks for. Vertices are some of those
/// there were; those at open borders and between segments stay, so that pieces and segments meet without gaps. Where
/// segments meet, each has its own vertices. A part that a piece's end cuts off may go on in the next piece, and stays.
TidyPiece tidied(const Mesh& mesh, const MeshReflectance& reflectance, const TidyOptions& options);

/// Leaves so large a part of the triangles, of each segment alike, whatever the distance is.
TidyPiece reduced(const Mesh& mesh, const MeshReflectance& reflectance, double part);

}  // namespace patina
