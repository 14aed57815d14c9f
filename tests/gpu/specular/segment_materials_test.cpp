#include "passes/state/segment_materials.h"

#include "engine/graph/enlargement.h"
#include "tests/gpu/gpu_test.h"

// Materials that the device estimated, in a table that grows.

namespace patina::segment_materials_test {
namespace {

constexpr uint32_t kBefore = 4, kAfter = 8;

class SegmentMaterialsTest : public GpuTest {
  protected:
    /// What a pass writes that estimates materials.
    static gpu::SegmentMaterial estimate(uint32_t label) {
        gpu::SegmentMaterial material{};
        material.ks_alpha = glm::vec4(0.1f * float(label));
        material.version = label;
        return material;
    }

    /// In a frame that uploads nothing else, where the table is the device's own.
    void write_estimates() {
        std::vector<gpu::SegmentMaterial> estimates;
        for (uint32_t label = 0; label < materials_.capacity(); ++label) estimates.push_back(estimate(label));
        graph::FrameGraph frame = runner().begin();
        const graph::BufferId id = materials_.import(frame);
        frame.keep(frame.upload_bytes(id, 0, std::as_bytes(std::span(estimates)), false));
        run(std::move(frame));
    }

    void grow() {
        graph::Enlargement enlargement(device());
        materials_.enlarge(enlargement, kAfter);
        enlargement.allocate();
        graph::FrameGraph frame = runner().begin();
        enlargement.commit(frame);
        enlargement.keep(frame);
        run(std::move(frame));
        enlargement.accept();
    }

    std::vector<gpu::SegmentMaterial> read() {
        graph::FrameGraph frame = runner().begin();
        const graph::Readback read = frame.read_back(materials_.import(frame));
        run(std::move(frame));
        return read.as<gpu::SegmentMaterial>();
    }

    SegmentMaterials materials_{device(), kBefore};
};

TEST_F(SegmentMaterialsTest, EstimatesStayWhenTheTableGrows) {
    read();  // the table is uploaded once
    write_estimates();
    {
        graph::Enlargement not_accepted(device());
        materials_.enlarge(not_accepted, kAfter);
    }
    EXPECT_EQ(materials_.capacity(), kBefore);
    grow();
    const std::vector<gpu::SegmentMaterial> grown = read();
    ASSERT_EQ(grown.size(), kAfter);
    for (uint32_t label = 0; label < kAfter; ++label) {
        const gpu::SegmentMaterial expected = label < kBefore ? estimate(label) : gpu::SegmentMaterial{};
        EXPECT_EQ(grown[label].ks_alpha, expected.ks_alpha) << label;
        EXPECT_EQ(grown[label].version, expected.version) << label;
    }
    write_estimates();  // no frame uploads it any more
}

TEST_F(SegmentMaterialsTest, WhatWasSetBeyondTheCapacityComesWithTheGrowth) {
    materials_.set(6, glm::vec3(0.2f), 0.3f);
    EXPECT_EQ(read().size(), kBefore);
    grow();
    const std::vector<gpu::SegmentMaterial> grown = read();
    ASSERT_EQ(grown.size(), kAfter);
    EXPECT_EQ(grown[6].ks_alpha, glm::vec4(0.2f, 0.2f, 0.2f, 0.3f));
    EXPECT_EQ(grown[5].version, 0u);
}

}  // namespace
}  // namespace patina::segment_materials_test
