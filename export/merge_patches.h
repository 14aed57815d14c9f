#pragma once

#include <cstdint>
#include <vector>

#include "patina/scene.h"

namespace patina {

/// Labels by vertex without specks. A patch is connected surface of one label. It is small with fewer vertices than
/// `least`; `in_pieces`, what an end of the mesh cuts off may go on in the next piece, and is not small (cut_off.h).
/// A small one takes the label that most of its border's edges lead to, of large patches and of those that were merged
/// before; not 0, which is no segment. One that has no such neighbour keeps its label. Of labels that equally many
/// edges lead to, the lowest is taken.
std::vector<uint32_t> merged_patches(const Mesh& mesh, std::vector<uint32_t> labels, uint32_t least, bool in_pieces);

}  // namespace patina
