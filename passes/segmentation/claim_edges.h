#pragma once

#include "passes/segmentation/find_edges.h"

namespace patina {

/// Where the components of a frame touch.
struct Contacts {
    graph::BufferId table;  ///< gpu::Contact[gpu::kContactSlots], a hash table
    graph::BufferId count;  ///< u32: slots in use; gpu::kMostContacts or more: overflow, and the table is incomplete
};

struct ClaimedEdges {
    graph::ImageId component;  ///< W x H r32ui: key, 0: none
    Contacts contacts;
};

/// Gives pixels that have depth but no component, or a small one, to one nearby: the one on whose tangent plane they
/// lie, and of several planes that of their colour. Collects the colours on both sides of pixels between two planes.
/// `component` and `pixels` as in Components. Throws Error when extents differ.
ClaimedEdges add_claim_edges(graph::FrameGraph& frame, graph::ImageId component, graph::BufferId pixels,
                             const FrameSurface& surface, graph::ImageId normal, const gpu::FrameSurfaceParams& params);

/// When two components that touch are one thing.
struct FoldSettings {
    float strong_chroma = 0.12f;    ///< both lie farther than this from grey, which many things share,
    float same_hue_degrees = 2.5f;  ///< in directions from grey that differ by no more along their contact;
    float same_saturation = 0.1f;   ///< highlights change the distance from grey, by so much
    float least_weight = 1;         ///< pixels of the contact times that distance squared: noise does less then
};

/// Joins components across creases within one colour, as a figure has. `parents` and `pixels` as in Components;
/// `pixels` of a component that was joined to another forwards to that one: gpu::kForwardedKey | key. If the table of
/// contacts has overflowed nothing is joined. Returns the new version of `pixels`.
graph::BufferId add_join_folds(graph::FrameGraph& frame, const Contacts& contacts, graph::BufferId parents,
                               graph::BufferId pixels, const FoldSettings& settings);

}  // namespace patina
