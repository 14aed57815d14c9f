#pragma once

#include <random>
#include <vector>

#include "passes/segmentation/surface_view.h"
#include "passes/state/label_map.h"
#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/reference/segmentation/labels.h"

namespace patina {

/// What became of labels: each its own root, merged into a smaller one, or given up (0).
std::vector<uint32_t> random_roots(uint32_t labels, std::mt19937& random);

/// A ball before a wall, fused from one place, whose voxels' labels a test chooses.
class LabelRig {
  public:
    static constexpr uint32_t kLabels = 64;
    static constexpr uint32_t kCapacity = 1024;  ///< blocks
    static constexpr double kWallM = 1.003;

    LabelRig(vulkan::Device& device, graph::Runner& runner);

    static const Intrinsics& camera();
    static const reference::DistanceField& scene();
    static Image<float> depth_m(const RigidTransform& world_from_camera);

    /// The label words of the whole pool, by block id; those of free blocks too.
    std::vector<uint32_t> words();
    std::vector<uint32_t> stamps();
    void set(const std::vector<uint32_t>& words, const std::vector<uint32_t>& stamps);
    /// Random words for the whole pool, `empty` of 8 voxels having none.
    void set_random(std::mt19937& random, uint32_t empty_of_8 = 0);

    /// The labels of the blocks in use.
    reference::LabelVolume volume();

    FusionRig& fusion() { return fusion_; }
    const VoxelMap& map() { return fusion_.map(); }
    const LabelMap& labels() const { return labels_; }

  private:
    std::vector<uint32_t> read(graph::BufferId LabelMapIds::*buffer);

    graph::Runner& runner_;
    FusionRig fusion_;
    LabelMap labels_;
};

/// A word as the pool holds it.
inline uint32_t label_word(reference::VoxelLabel label) { return label.label | label.confidence << 16; }
inline reference::VoxelLabel label_of(uint32_t word) { return {word & 0xffff, word >> 16}; }

}  // namespace patina
