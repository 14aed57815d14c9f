#include "passes/segmentation/update_labels.h"

#include <numeric>

#include "engine/core/shader_camera.h"
#include "passes/fusion/visible_blocks.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/segmentation/label_rig.h"

namespace patina::update_labels_test {
namespace {

constexpr uint32_t kSegments = 40;

class UpdateLabels : public GpuTest {
  protected:
    struct Update {
        reference::LabelledView view;
        gpu::SegmentCounters counters{};
    };

    /// Updates all blocks in use from a view whose pixels are in these segments; `listed_as`: gpu::kSettledBlock for
    /// blocks that have settled.
    Update update(LabelRig& rig, const RigidTransform& world_from_camera, const Image<uint32_t>& segment,
                  const std::vector<uint32_t>& segment_labels, const std::vector<uint32_t>& roots, uint32_t stride = 1,
                  uint32_t listed_as = 0, const std::vector<uint32_t>& partners = {}) {
        const Intrinsics& camera = LabelRig::camera();
        const std::vector<uint32_t> list = blocks_in_use(rig, listed_as);
        graph::FrameGraph frame = runner().begin();
        const VoxelMapIds voxels = rig.map().import(frame);
        const VisibleBlocks visible =
            add_visible_blocks(frame, rig.map(), voxels, make_camera(camera, world_from_camera), 0.1f, 2.1f);
        const RaycastImages model = add_raycast(frame, rig.map(), voxels, visible, MapAccess::kStorage);
        const SurfaceView surface{model.position_m, model.normal, visible.view, visible.grid, visible.list};
        const uint32_t count = (list[0] + gpu::kUpdateBlocks - 1) / gpu::kUpdateBlocks;
        const std::vector<uint32_t> groups{gpu::kGroupsPerRow, (count + gpu::kGroupsPerRow - 1) / gpu::kGroupsPerRow, 1,
                                           0};
        const DueBlocks due{frame.upload<uint32_t>("blocks", list), frame.upload<uint32_t>("arguments", groups)};
        const FrameSegments segments{frame.upload("segment", {segment.extent(), vulkan::Format::kR32u},
                                                  std::as_bytes(std::span(segment.pixels()))),
                                     {},
                                     {},
                                     stride};
        SegmentTableIds table = table_.import(frame);
        table.parents = frame.upload<uint32_t>("parents", roots);
        table.partners =
            partners.empty() ? frame.fill(table.partners, 0) : frame.upload<uint32_t>("partners", std::span(partners));
        table.counters = frame.fill(table.counters, 0);
        LabelMapIds labels = rig.labels().import(frame);
        add_update_labels(frame, rig.map(), voxels, labels, table, surface, due, segments,
                          frame.upload<uint32_t>("segment_labels", segment_labels),
                          storage_ ? MapAccess::kStorage : preferred_map_access(device().caps(), rig.map()));
        LabelMap::keep(frame, labels);
        const graph::Readback position = frame.read_back(model.position_m), normal = frame.read_back(model.normal),
                              counters = frame.read_back(table.counters);
        run(std::move(frame));
        return {{camera, world_from_camera, position.image<glm::vec4>(), widen(normal.image<uint64_t>()), segment,
                 segment_labels, rig.map().settings().voxel_m, static_cast<int>(stride)},
                counters.as<gpu::SegmentCounters>().front()};
    }

    SegmentTable table_{device(), LabelRig::kLabels};
    bool storage_ = false;  ///< the map in storage buffers, whatever this device is faster with

  private:
    /// Count, then ids.
    static std::vector<uint32_t> blocks_in_use(LabelRig& rig, uint32_t listed_as) {
        std::vector<uint32_t> list{0};
        const std::vector<uint32_t> keys = rig.fusion().table().block_keys;
        for (uint32_t block = 0; block < keys.size(); ++block) {
            if (keys[block] != gpu::kEmptyKey) list.push_back(block | listed_as);
        }
        list[0] = static_cast<uint32_t>(list.size() - 1);
        return list;
    }
};

bool is_near_surface(const reference::Voxel& voxel, double voxel_m) {
    return voxel.weight > 0 && std::abs(voxel.sdf_m) < voxel_m;
}

class UpdateLabelsAtStride : public UpdateLabels, public ::testing::WithParamInterface<std::tuple<uint32_t, bool>> {};

/// Some of the labels that are their own roots are partners, each of the next one.
std::vector<uint32_t> some_partners(const std::vector<uint32_t>& roots) {
    std::vector<uint32_t> partners(roots.size());
    uint32_t single = 0;
    for (uint32_t label = 1; label < roots.size(); ++label) {
        if (roots[label] != label || label % 4 == 0) continue;
        if (single == 0) {
            single = label;
            continue;
        }
        partners[single] = label;
        partners[label] = std::exchange(single, 0u);
    }
    return partners;
}

TEST_P(UpdateLabelsAtStride, AgreesWithTheReference) {
    std::mt19937 random(23);
    const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
    LabelRig rig(device(), runner());
    rig.set_random(random, 2);
    const std::vector<uint32_t> roots = random_roots(LabelRig::kLabels, random);
    const std::vector<uint32_t> partners = some_partners(roots);
    std::vector<uint32_t> labels(kSegments);
    for (uint32_t s = 1; s < kSegments; ++s) labels[s] = roots[below(LabelRig::kLabels)];
    const auto [stride, storage] = GetParam();
    storage_ = storage;
    Image<uint32_t> segment(sampled_extent(LabelRig::camera().extent, stride));
    for (size_t i = 0; i < segment.pixels().size(); ++i) {
        segment.pixels()[i] = static_cast<uint32_t>(i / 7 * 31 % kSegments);  // runs of seven pixels
    }
    const reference::Volume volume = rig.fusion().volume();
    const reference::LabelVolume before = rig.volume();
    const Update got =
        update(rig, reference::look_at({0.2, -0.1, 0.1}, {0, 0, 1}), segment, labels, roots, stride, 0, partners);
    const reference::LabelVolume after = rig.volume();
    uint32_t voted = 0, flipped = 0, differ = 0, meant = 0;
    for (const auto& [block, voxels] : volume.blocks) {
        for (size_t i = 0; i < voxels.size(); ++i) {
            const glm::dvec3 center_m = volume.center_m(block, static_cast<int>(i));
            const reference::VoxelLabel known = before.blocks.at(block)[i];
            const uint32_t label =
                is_near_surface(voxels[i], volume.voxel_m) ? reference::seen_label(got.view, center_m, known) : 0;
            const reference::VoxelLabel root = reference::relabelled(known, roots);
            const bool of_partner = label != 0 && root.label != 0 && partners[root.label] == label;
            meant += of_partner ? 1 : 0;
            const reference::VoxelLabel expected =
                label == 0 ? known : reference::voted(root, of_partner ? root.label : label);
            voted += label != 0 ? 1 : 0;
            flipped += label != 0 && root.label != 0 && expected.label != root.label ? 1 : 0;
            differ += after.blocks.at(block)[i] != expected ? 1 : 0;
        }
    }
    EXPECT_GT(voted, 5000u);
    EXPECT_GT(flipped, 100u);
    EXPECT_GT(meant, 30u) << "votes for the partner of what a voxel has";
    // Single precision decides otherwise where a centre is between two pixels, or just within a voxel.
    EXPECT_LE(differ, voted / 500);
    EXPECT_NEAR(got.counters.frame_voxels, voted, voted / 500.0);
    EXPECT_NEAR(got.counters.frame_flips, flipped, 3);
}

INSTANTIATE_TEST_SUITE_P(Strides, UpdateLabelsAtStride,
                         ::testing::Combine(::testing::Values(1u, 2u, 3u), ::testing::Bool()));

/// How near the way from a point to a camera passes the ball's centre.
double distance_from_ball_m(glm::dvec3 from_m, const RigidTransform& world_from_camera) {
    const glm::dvec3 center_m(0.05, 0, 0.8), direction = glm::normalize(glm::dvec3(world_from_camera[3]) - from_m);
    return glm::distance(center_m, from_m + direction * glm::dot(center_m - from_m, direction));
}

/// Whether a camera's picture shows a point, not at its rim.
bool shows(const RigidTransform& world_from_camera, glm::dvec3 point_m) {
    const glm::dvec2 pixel =
        project(LabelRig::camera(), glm::dvec3(rigid_inverse(world_from_camera) * glm::dvec4(point_m, 1)));
    return pixel.x > 4 && pixel.y > 4 && pixel.x < 91 && pixel.y < 59;
}

TEST_F(UpdateLabels, TheWallGetsItsLabelButNotBehindTheBall) {
    LabelRig rig(device(), runner());
    rig.set(std::vector<uint32_t>(size_t{LabelRig::kCapacity} * gpu::kBlockVoxels),
            std::vector<uint32_t>(LabelRig::kCapacity));
    std::vector<uint32_t> roots(LabelRig::kLabels);
    std::iota(roots.begin(), roots.end(), 0u);
    const Image<uint32_t> segment(LabelRig::camera().extent, 1);
    // From aside the ball hides a part of the wall that was fused before.
    const RigidTransform aside = reference::look_at({0.5, 0, 0.2}, {0, 0, 1});
    for (int i = 0; i < 4; ++i) rig.fusion().fuse(LabelRig::camera(), aside, LabelRig::depth_m(aside));
    const auto label_all = [&](uint32_t label) { return update(rig, aside, segment, {0, label}, roots); };
    EXPECT_EQ(label_all(5).counters.frame_flips, 0u) << "none had a label";
    const uint32_t flips = label_all(6).counters.frame_flips;
    EXPECT_EQ(label_all(6).counters.frame_voxels, flips);
    uint32_t free = 0, hidden = 0;
    const reference::LabelVolume volume = rig.volume();
    const reference::Volume distances = rig.fusion().volume();
    for (const auto& [block, voxels] : distances.blocks) {
        for (size_t i = 0; i < voxels.size(); ++i) {
            const glm::dvec3 center_m = distances.center_m(block, static_cast<int>(i));
            if (!is_near_surface(voxels[i], distances.voxel_m) || center_m.z < 0.95) continue;
            if (!shows(aside, center_m)) continue;
            const double way_m = distance_from_ball_m(center_m, aside);
            const reference::VoxelLabel label = volume.blocks.at(block)[i];
            if (way_m > 0.18) {
                ++free;
                EXPECT_EQ(label, (reference::VoxelLabel{6, 2}));
            } else if (way_m < 0.12) {
                ++hidden;
                EXPECT_EQ(label, reference::VoxelLabel{});
            }
        }
    }
    EXPECT_GT(free, 1000u);
    EXPECT_GT(hidden, 50u);
}

TEST_F(UpdateLabels, ABlockSettlesWhenAllItsVoxelsNearTheSurfaceAreSure) {
    LabelRig rig(device(), runner());
    std::vector<uint32_t> roots(LabelRig::kLabels);
    std::iota(roots.begin(), roots.end(), 0u);
    const Image<uint32_t> segment(LabelRig::camera().extent, 1);
    const RigidTransform front(1.0);
    const auto settled = [&] {
        size_t count = 0;
        for (const uint32_t stamp : rig.stamps()) count += stamp >= gpu::kSettledBlock ? 1 : 0;
        return count;
    };
    const std::vector<uint32_t> no_stamps(LabelRig::kCapacity);
    const size_t voxels = size_t{LabelRig::kCapacity} * gpu::kBlockVoxels;
    for (const auto& [confidence, expected] :
         {std::pair(gpu::kSettledConfidence - 2, false), {gpu::kSettledConfidence - 1, true}}) {
        rig.set(std::vector<uint32_t>(voxels, label_word({5, confidence})), no_stamps);
        update(rig, front, segment, {0, 5}, roots);
        EXPECT_EQ(settled() > 10, expected) << confidence;
    }
    const size_t before = settled();
    rig.set(std::vector<uint32_t>(voxels, label_word({5, 100})), no_stamps);
    update(rig, front, segment, {0, 6}, roots);
    EXPECT_LT(settled(), before / 2) << "contradicted, but for blocks out of sight";
}

TEST_F(UpdateLabels, ABlockIsRestlessWhileAVoxelNearTheSurfaceHasNoLabelOrIsContradicted) {
    LabelRig rig(device(), runner());
    std::vector<uint32_t> roots(LabelRig::kLabels);
    std::iota(roots.begin(), roots.end(), 0u);
    rig.set(std::vector<uint32_t>(size_t{LabelRig::kCapacity} * gpu::kBlockVoxels),
            std::vector<uint32_t>(LabelRig::kCapacity));
    // The picture's left half has no segment.
    Image<uint32_t> segment(LabelRig::camera().extent);
    for (uint32_t y = 0; y < segment.extent().height; ++y) {
        for (uint32_t x = segment.extent().width / 2; x < segment.extent().width; ++x) segment.at(x, y) = 1;
    }
    const reference::Volume volume = rig.fusion().volume();
    const std::vector<uint32_t> keys = rig.fusion().table().block_keys;
    // Labels first appear, then agree, then are contradicted.
    for (const uint32_t label : {5u, 5u, 6u}) {
        const reference::LabelVolume before = rig.volume();
        rig.set(rig.words(), std::vector<uint32_t>(LabelRig::kCapacity));
        update(rig, RigidTransform(1.0), segment, {0, label}, roots);
        const reference::LabelVolume after = rig.volume();
        const std::vector<uint32_t> stamps = rig.stamps();
        size_t restless = 0, calm = 0;
        for (size_t block = 0; block < keys.size(); ++block) {
            if (keys[block] == gpu::kEmptyKey) continue;
            const auto at = coordinates_of_key(keys[block]);
            bool near = false, expected = false;
            for (size_t i = 0; i < gpu::kBlockVoxels; ++i) {
                if (!is_near_surface(volume.blocks.at(at)[i], volume.voxel_m)) continue;
                const reference::VoxelLabel &was = before.blocks.at(at)[i], &is = after.blocks.at(at)[i];
                near = true;
                expected = expected || is.label == 0 || is.confidence < was.confidence;
            }
            EXPECT_EQ((stamps[block] & gpu::kRestlessBlock) != 0, expected) << "block " << block;
            restless += expected ? 1 : 0;
            calm += near && !expected ? 1 : 0;
        }
        EXPECT_GT(restless, 20u) << label;
        EXPECT_EQ(calm > 20, label == 5) << calm;
    }
}

TEST_F(UpdateLabels, InFourTurnsEveryVoxelOfASettledBlockHasOne) {
    LabelRig rig(device(), runner());
    std::vector<uint32_t> roots(LabelRig::kLabels);
    std::iota(roots.begin(), roots.end(), 0u);
    const Image<uint32_t> segment(LabelRig::camera().extent, 1);
    const std::vector<uint32_t> words(size_t{LabelRig::kCapacity} * gpu::kBlockVoxels, label_word({5, 100}));
    rig.set(words, std::vector<uint32_t>(LabelRig::kCapacity, 1));
    const uint32_t votes = update(rig, RigidTransform(1.0), segment, {0, 5}, roots).counters.frame_voxels;
    const std::vector<uint32_t> expected = rig.words();
    rig.set(words, std::vector<uint32_t>(LabelRig::kCapacity, 1));
    uint32_t all = 0;
    for (uint32_t turn = 0; turn < gpu::kLabelQuads; ++turn) {
        rig.set(rig.words(), std::vector<uint32_t>(LabelRig::kCapacity, 7 + turn * gpu::kSettledFrames));
        const uint32_t own =
            update(rig, RigidTransform(1.0), segment, {0, 5}, roots, 1, gpu::kSettledBlock).counters.frame_voxels;
        EXPECT_NEAR(own, votes / 4.0, votes / 40.0);
        all += own;
    }
    EXPECT_EQ(all, votes);
    EXPECT_EQ(rig.words(), expected);
    for (const uint32_t stamp : rig.stamps()) {
        EXPECT_TRUE(stamp >= gpu::kSettledBlock || stamp == 7 + 3 * gpu::kSettledFrames) << "free blocks have no turn";
    }
    update(rig, RigidTransform(1.0), segment, {0, 6}, roots, 1, gpu::kSettledBlock);
    size_t contradicted = 0;
    for (const uint32_t word : rig.words()) contradicted += word >> 16 == 100 ? 1 : 0;
    EXPECT_GT(contradicted, 0u);
}

}  // namespace
}  // namespace patina::update_labels_test
