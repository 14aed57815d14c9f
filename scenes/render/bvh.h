#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace patina::scenes {

/// An axis-aligned box; the default holds nothing.
struct Bounds {
    glm::vec3 low{std::numeric_limits<float>::infinity()};
    glm::vec3 high{-std::numeric_limits<float>::infinity()};

    void add(glm::vec3 point) { low = glm::min(low, point), high = glm::max(high, point); }
    void add(const Bounds& other) { low = glm::min(low, other.low), high = glm::max(high, other.high); }
    bool empty() const { return low.x > high.x; }
    bool contains(const Bounds& other) const {
        return glm::all(glm::lessThanEqual(low, other.low)) && glm::all(glm::greaterThanEqual(high, other.high));
    }
    bool operator==(const Bounds&) const = default;
};

/// A bounding volume hierarchy: a binary tree of boxes over primitives.
struct Bvh {
    struct Node {
        Bounds bounds;
        uint32_t first = 0;  ///< leaf: index into `primitives`
        uint32_t count = 0;  ///< leaf: how many; 0 for an inner node
        /// Inner node: the child with the lower centroids along `axis`, and the other.
        uint32_t lower = 0, upper = 0;
        uint32_t axis = 0;
    };
    std::vector<Node> nodes;           ///< the root first; none without primitives
    std::vector<uint32_t> primitives;  ///< indices of the boxes, each once, in the leaves' order
};

/// Builds a tree over boxes by the surface area heuristic on binned centroids (Wald, On fast Construction of SAH-based
/// Bounding Volume Hierarchies, 2007), with at most `max_leaf` boxes in a leaf. The same boxes give the same tree.
/// Boxes may be flat, equal, or none at all; they must be finite.
Bvh build_bvh(std::span<const Bounds> boxes, uint32_t max_leaf);

/// A node in a depth-first list: after it comes its nearer child, or, for a leaf and where its box is missed, the node
/// at `skip`; skip = the length of the list ends the walk.
struct ThreadedNode {
    Bounds bounds;
    uint32_t skip = 0;
    uint32_t first = 0;  ///< leaf
    uint32_t count = 0;  ///< leaf; 0 for an inner node
};

/// The tree's nodes in the order in which rays should meet them whose direction is negative along each axis i for which
/// bit i of `octant` is set (Torres et al., Ray Casting using a Roped BVH with CUDA, 2009).
std::vector<ThreadedNode> thread_bvh(const Bvh& bvh, uint32_t octant);

}  // namespace patina::scenes
