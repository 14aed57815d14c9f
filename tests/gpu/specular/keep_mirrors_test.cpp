#include "passes/specular/keep_mirrors.h"

#include "shared/reflectance/reflectance.h"
#include "tests/gpu/gpu_test.h"

namespace patina::keep_mirrors_test {
namespace {

constexpr uint32_t kLabels = 70, kMaterials = 69;  // no multiples of a group

class KeepMirrorsTest : public GpuTest {};

TEST_F(KeepMirrorsTest, OnlySureMirrorsStay) {
    std::vector<gpu::MirrorFit> mirrors(kLabels, {{1, 1, 1, 1}, {2, 2, 2, 2}, 3, 4, 0, 0});
    std::vector<gpu::SegmentMaterial> materials(kMaterials);
    for (uint32_t label = 0; label < kMaterials; ++label)
        materials[label] = {glm::vec4(0.2f, 0.3f, 0.4f, 0.1f), label == 3 ? 0 : label + 1, float(label) / 70, 0, 0};
    materials[68].version = 0xffff;
    materials[67].version = 0xffff;
    materials[67].mirror = 0.5f;
    const WardFits table(device(), kLabels);
    graph::FrameGraph frame = runner().begin();
    WardFitIds ids = table.import(frame);
    ids.mirrors = frame.upload("mirrors", std::span<const gpu::MirrorFit>(mirrors));
    graph::BufferId changed = frame.upload("materials", std::span<const gpu::SegmentMaterial>(materials));
    add_keep_mirrors(frame, table, ids, kMaterials, changed);
    const graph::Readback fits = frame.read_back(ids.mirrors), read = frame.read_back(changed);
    run(std::move(frame));
    for (uint32_t label = 0; label < kLabels; ++label) {
        const bool sure = label < kMaterials && materials[label].mirror >= 0.9f;
        EXPECT_EQ(fits.as<gpu::MirrorFit>()[label].pairs, sure ? 4 : 0) << label;
        if (label >= kMaterials) continue;
        const gpu::SegmentMaterial now = read.as<gpu::SegmentMaterial>()[label], before = materials[label];
        if (sure || before.version == 0) {
            EXPECT_EQ(now.version, before.version) << label;
            EXPECT_EQ(now.ks_alpha, before.ks_alpha) << label;
            EXPECT_EQ(now.mirror, before.mirror) << label;
        } else {
            EXPECT_NE(now.version, before.version) << label;
            EXPECT_NE(now.version, 0u) << label;
            EXPECT_EQ(now.ks_alpha, glm::vec4(0, 0, 0, 1)) << label;
            EXPECT_EQ(now.mirror, 0) << label;
        }
    }
    EXPECT_EQ(materials[65].mirror >= 0.9f, true) << "some are sure";
}

}  // namespace
}  // namespace patina::keep_mirrors_test
