#include "passes/segmentation/sample_labels.h"

#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "passes/fusion/visible_blocks.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/segmentation/label_rig.h"

namespace patina::sample_labels_test {
namespace {

class SampleLabels : public GpuTest {
  protected:
    struct Points {
        Image<glm::vec4> position_m{LabelRig::camera().extent};
        Image<glm::vec4> normal{LabelRig::camera().extent};  ///< as half floats hold it
    };

    Image<uint32_t> sample(LabelRig& rig, const std::vector<uint32_t>& roots, const Points& points, MapAccess access) {
        graph::FrameGraph frame = runner().begin();
        const Extent2D extent = points.position_m.extent();
        const VoxelMapIds voxels = rig.map().import(frame);
        const VisibleBlocks visible = add_visible_blocks(
            frame, rig.map(), voxels, make_camera(LabelRig::camera(), RigidTransform(1)), 0.1f, 2.1f);
        std::vector<uint64_t> halves;
        for (const glm::vec4& normal : points.normal.pixels()) halves.push_back(glm::packHalf4x16(normal));
        const SurfaceView surface{
            frame.upload("position_m", {extent, vulkan::Format::kRgba32f},
                         std::as_bytes(std::span(points.position_m.pixels()))),
            frame.upload("normal", {extent, vulkan::Format::kRgba16f}, std::as_bytes(std::span(halves))), visible.view,
            visible.grid, visible.list};
        const graph::Readback label = frame.read_back(add_sample_labels(
            frame, rig.map(), rig.labels().import(frame), frame.upload<uint32_t>("parents", roots), surface, access));
        run(std::move(frame));
        return label.image<uint32_t>();
    }

    void expect(LabelRig& rig, const std::vector<uint32_t>& roots, const Points& points,
                const Image<uint32_t>& expected) {
        for (const MapAccess access : {MapAccess::kStorage, preferred_map_access(device().caps(), rig.map())}) {
            const Image<uint32_t> got = sample(rig, roots, points, access);
            for (size_t i = 0; i < got.pixels().size(); ++i) {
                EXPECT_EQ(got.pixels()[i], expected.pixels()[i]) << "pixel " << i;
            }
        }
    }

    /// Points so far from the sides of voxels, before and behind too, that rounding does not decide.
    static bool is_clear(glm::dvec3 point_m, glm::dvec3 normal) {
        for (const double along_vox : {0.0, -0.75, 0.75}) {
            const glm::dvec3 at = point_m * 100.0 + normal * along_vox;
            const glm::dvec3 off = glm::abs(at - glm::round(at));
            if (std::min({off.x, off.y, off.z}) < 1e-3) return false;
        }
        return true;
    }
};

TEST_F(SampleLabels, AgreeWithTheReference) {
    std::mt19937 random(7);
    LabelRig rig(device(), runner());
    rig.set_random(random, 5);
    const std::vector<uint32_t> roots = random_roots(LabelRig::kLabels, random);
    const Image<float> depth_m = LabelRig::depth_m(RigidTransform(1));
    std::normal_distribution<float> off_m(0, 0.01f), any;
    const Intrinsics& camera = LabelRig::camera();
    Points points;
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            glm::vec4& point = points.position_m.at(x, y);
            glm::vec4& normal = points.normal.at(x, y);
            do {
                // Most lie near the surface, some where nothing is allocated.
                const float z = random() % 16 == 0 ? 0.3f + 0.0001f * static_cast<float>(random() % 9000)
                                                   : depth_m.at(x, y) + off_m(random);
                point =
                    glm::vec4((static_cast<float>(x) - 47.5f) / 90 * z, (static_cast<float>(y) - 31.5f) / 90 * z, z, z);
                normal = glm::vec4(glm::normalize(glm::vec3(any(random), any(random), any(random))), 0);
                normal = glm::unpackHalf4x16(glm::packHalf4x16(normal));
            } while (!is_clear(glm::dvec3(point), glm::dvec3(normal)));
            if (random() % 16 == 0) point.w = 0;
        }
    }
    const reference::LabelVolume volume = rig.volume();
    Image<uint32_t> expected(camera.extent);
    size_t own = 0, beside = 0, none = 0;
    for (size_t i = 0; i < expected.pixels().size(); ++i) {
        const glm::vec4 point = points.position_m.pixels()[i];
        if (point.w == 0) continue;
        const glm::dvec3 at(point);
        uint32_t& label = expected.pixels()[i];
        label = reference::sampled_label(volume, roots, at, glm::dvec3(points.normal.pixels()[i]));
        (label == 0 ? none : roots[volume.at(at).label] == 0 ? beside : own) += 1;
    }
    EXPECT_GT(std::min({own, beside, none}), 500u) << own << ' ' << beside << ' ' << none;
    expect(rig, roots, points, expected);
}

TEST_F(SampleLabels, TheSideBehindComesBeforeTheSideInFront) {
    LabelRig rig(device(), runner());
    // Three layers of voxels along z, of which the middle one has no label; the wall lies in it.
    const std::vector<uint32_t> keys = rig.fusion().table().block_keys;
    std::vector<uint32_t> words(size_t{LabelRig::kCapacity} * gpu::kBlockVoxels);
    for (uint32_t block = 0; block < keys.size(); ++block) {
        if (keys[block] == gpu::kEmptyKey) continue;
        for (uint32_t i = 0; i < gpu::kBlockVoxels; ++i) {
            const int z = coordinates_of_key(keys[block])[2] * 8 + static_cast<int>(i / 64);
            const uint32_t x = i % 8;
            if (z == 101 && x < 4) words[block * gpu::kBlockVoxels + i] = label_word({7, 1});
            if (z == 99) words[block * gpu::kBlockVoxels + i] = label_word({9, 1});
        }
    }
    rig.set(words, std::vector<uint32_t>(LabelRig::kCapacity));
    std::vector<uint32_t> roots(LabelRig::kLabels);
    for (uint32_t label = 0; label < roots.size(); ++label) roots[label] = label;
    Points points;
    Image<uint32_t> expected(LabelRig::camera().extent);
    for (uint32_t x = 0; x < 16; ++x) {
        points.position_m.at(x, 0) = glm::vec4(-0.4f + 0.01f * (static_cast<float>(x) + 0.5f), 0.005f, 1.005f, 1);
        points.normal.at(x, 0) = glm::vec4(0, 0, -1, 0);
        expected.at(x, 0) = x % 8 < 4 ? 7 : 9;
    }
    expect(rig, roots, points, expected);
}

}  // namespace
}  // namespace patina::sample_labels_test
