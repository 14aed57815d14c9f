#include "export/merge_patches.h"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include "export/connected_vertices.h"
#include "export/cut_off.h"

namespace patina {

namespace {

/// Small patches by their first vertex, each with how many edges lead to which other patch.
using SmallPatches = std::map<uint32_t, std::map<uint32_t, uint32_t>>;

SmallPatches small_patches(const Mesh& mesh, std::span<const uint32_t> part, uint32_t least, bool in_pieces) {
    std::vector<uint32_t> vertices(part.size());
    for (const uint32_t of : part) ++vertices[of];
    const std::vector<bool> cut_off =
        in_pieces ? cut_off_parts(mesh.positions_m, part) : std::vector<bool>(part.size());
    SmallPatches small;
    for (const auto& triangle : mesh.triangles) {
        for (size_t corner = 0; corner < 3; ++corner) {
            const uint32_t a = part[triangle[corner]], b = part[triangle[(corner + 1) % 3]];
            if (a == b) continue;
            for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}})
                if (vertices[from] < least && !cut_off[from]) ++small[from][to];
        }
    }
    return small;
}

/// The label that most edges to patches that are not waiting lead to; 0: there is none.
uint32_t neighbour_of(const std::map<uint32_t, uint32_t>& edges, const SmallPatches& waiting,
                      std::span<const uint32_t> label_of_patch) {
    std::map<uint32_t, uint32_t> by_label;
    for (const auto& [patch, count] : edges)
        if (label_of_patch[patch] != 0 && !waiting.contains(patch)) by_label[label_of_patch[patch]] += count;
    const auto most = std::ranges::max_element(by_label, {}, &std::pair<const uint32_t, uint32_t>::second);
    return most == by_label.end() ? 0 : most->first;
}

}  // namespace

std::vector<uint32_t> merged_patches(const Mesh& mesh, std::vector<uint32_t> labels, uint32_t least, bool in_pieces) {
    if (labels.empty() || least == 0) return labels;
    ConnectedVertices connected(mesh.positions_m, mesh.triangles, labels);
    std::vector<uint32_t> part(labels.size());
    for (uint32_t i = 0; i < part.size(); ++i) part[i] = connected.part_of(i);
    std::vector<uint32_t> label_of_patch = labels;  // by a patch's first vertex
    SmallPatches waiting = small_patches(mesh, part, least, in_pieces);
    // Round by round, from what is around them inwards.
    for (bool any = true; any;) {
        std::map<uint32_t, uint32_t> merged;
        for (const auto& [patch, edges] : waiting)
            if (const uint32_t label = neighbour_of(edges, waiting, label_of_patch)) merged[patch] = label;
        for (const auto& [patch, label] : merged) {
            label_of_patch[patch] = label;
            waiting.erase(patch);
        }
        any = !merged.empty();
    }
    for (uint32_t i = 0; i < labels.size(); ++i) labels[i] = label_of_patch[part[i]];
    return labels;
}

}  // namespace patina
