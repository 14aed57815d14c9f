#pragma once

#include <cstdint>
#include <vector>

#include "patina/scene.h"

namespace patina {

struct PatchMerging {
    uint32_t least_vertices = 32;  ///< a patch with fewer is small
    bool in_pieces = true;         ///< what the mesh's box cuts off may go on in the next piece, and is not small
};

/// Labels by vertex without specks. A patch is connected surface of one label. A small one takes the label that most of
/// its border's edges lead to, of large patches and of those that were merged before; not 0, which is no segment. One
/// that has no such neighbour keeps its label. Of labels that equally many edges lead to, the lowest is taken.
std::vector<uint32_t> merged_patches(const Mesh& mesh, std::vector<uint32_t> labels, const PatchMerging& merging);

}  // namespace patina
