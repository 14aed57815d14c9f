#include "tools/bench/example_fit.h"

#include <cmath>

#include "tests/gpu/gpu_test.h"

namespace patina::example_fit_test {
namespace {

using scenes::ExampleScene;

class ExampleFitTest : public GpuTest {
  protected:
    /// With exact normals, one material, no noise, no sky, and dim enough not to clip.
    static ExampleScene clean(ExampleScene scene) {
        scene.scene.read = scene.scene.shot = 0;
        scene.scene.sky = {0, 0, 0, 0.2f};
        scene.scene.ground = glm::vec4(0);
        scene.materials.front().ks_alpha = {0.2f, 0.15f, 0.1f, 0.3f};
        for (gpu::ExampleVoxel& voxel : scene.voxels) {
            voxel.material = 0;
            voxel.stored_normal = voxel.normal;
        }
        return scene;
    }

    /// The first of a seed whose lamps alone light it, or not.
    static std::vector<ExampleScene> draw(bool lamps, size_t count) {
        std::vector<ExampleScene> scenes;
        for (uint64_t i = 0; scenes.size() < count; ++i) {
            const ExampleScene scene = scenes::draw_example_scene(9, i);
            if ((scene.scene.windows == 0) == lamps && (lamps || scene.scene.lamps == 0)) scenes.push_back(scene);
        }
        return scenes;
    }
};

TEST_F(ExampleFitTest, FindsTheMaterialsOfCleanScenes) {
    // Behind one that no lamp lights: each scene has lights of its own.
    std::vector<ExampleScene> scenes = draw(false, 1);
    for (const ExampleScene& scene : draw(true, 11)) scenes.push_back(clean(scene));
    const auto count = static_cast<uint32_t>(scenes.size());
    tools::ExampleRenderer renderer(device(), count, HemisphereMap::kParabolic, true);
    const ExampleBatch batch = render_examples(renderer, 9, 0, scenes);
    ExampleFit fit(device(), count);
    const std::vector<gpu::WardFit> fits = fit.fit(batch, {}, 4);
    EXPECT_EQ(fits[0].estimates, 0u);
    // Not all are seen from where their highlights are, nor are 8 bits always enough.
    size_t right = 0;
    for (size_t i = 1; i < count; ++i) {
        EXPECT_EQ(fits[i].estimates, 4u) << i;
        const glm::vec3 off = glm::abs(glm::vec3(fits[i].ks_alpha) - glm::vec3(0.2f, 0.15f, 0.1f));
        if (glm::max(off.x, glm::max(off.y, off.z)) < 0.005f && std::abs(fits[i].ks_alpha.w - 0.3f) < 0.005f) ++right;
    }
    EXPECT_GE(right, 6u) << "of " << count - 1;

    // Without the one before, every label is another scene's, the first's too.
    const std::vector<ExampleScene> lit(scenes.begin() + 1, scenes.end());
    const std::vector<gpu::WardFit> again = fit.fit(render_examples(renderer, 9, 1, lit), {}, 4);
    for (size_t i = 0; i < lit.size(); ++i) EXPECT_NEAR(again[i].ks_alpha.w, fits[i + 1].ks_alpha.w, 0.01f) << i;
}

}  // namespace
}  // namespace patina::example_fit_test
