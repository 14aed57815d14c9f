// lib/color/perceptual.glsl against the same on the processor, whose values tests/unit/perceptual_test.cpp knows.
#include "passes/specular/perceptual.h"

#include <random>

#include "shared/specular/specular_estimates.h"
#include "spirv/shaders.h"
#include "tests/gpu/gpu_test.h"

namespace patina::perceptual_test {
namespace {

class PerceptualShader : public GpuTest {};

TEST_F(PerceptualShader, AgreesWithTheProcessorAndReturnsToTheMaterial) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> level(0, 1), gloss(0.02f, 0.6f);
    std::vector<gpu::WardMaterial> materials{{{0, 0, 0, 0}, {0, 0, 0, 0.5f}}, {{1, 1, 1, 0}, {1, 1, 1, 0.01f}}};
    for (int i = 0; i < 500; ++i) {
        const float dark = i % 2 == 0 ? 0.01f : 1.0f;  // CIELAB is a straight line below 0.009
        materials.push_back({glm::vec4(level(random), level(random), level(random), 0) * dark,
                             glm::vec4(level(random), level(random), level(random), 0) * 0.5f});
        materials.back().ks_alpha.w = gloss(random);
    }
    const auto count = static_cast<uint32_t>(materials.size());
    graph::FrameGraph frame = runner().begin();
    auto pass = frame.compute("test.perceptual", spirv::test_perceptual);
    pass.read("Materials", frame.upload<gpu::WardMaterial>("materials", materials));
    const auto perceptual_id = pass.create("Perceptual", count * sizeof(gpu::PerceptualMaterial));
    const auto returned_id = pass.create("Returned", count * sizeof(gpu::WardMaterial));
    pass.push(gpu::PerceptualParams{count});
    pass.dispatch_covering(count);
    const graph::Readback perceptual = frame.read_back(perceptual_id), returned = frame.read_back(returned_id);
    run(std::move(frame));
    const auto got = perceptual.as<gpu::PerceptualMaterial>();
    const auto back = returned.as<gpu::WardMaterial>();
    for (size_t i = 0; i < materials.size(); ++i) {
        const gpu::WardMaterial& m = materials[i];
        const Perceptual want = perceptual_of({glm::dvec3(m.kd_weight), glm::dvec3(m.ks_alpha), double{m.ks_alpha.w}});
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(got[i].lab_cr[c], want[static_cast<size_t>(c)], 1e-5) << i;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[i].cgb_d_weight[c], want[static_cast<size_t>(4 + c)], 1e-5) << i;
        // The matrices are each other's inverse to 7 digits, and cubes triple the relative error of roots.
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(back[i].kd_weight[c], m.kd_weight[c], 1e-5) << i;
            EXPECT_NEAR(back[i].ks_alpha[c], m.ks_alpha[c], 1e-5) << i;
        }
        EXPECT_NEAR(back[i].ks_alpha.w, std::max(m.ks_alpha.w, 0.01f), 1e-6) << i;
    }
}

}  // namespace
}  // namespace patina::perceptual_test
