// Light from where there is no surface.

#include "passes/reflectance/collect_far_field.h"

#include <array>
#include <map>

#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "shared/fusion/voxel_map.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/reflectance/octahedral_texel.h"
#include "tests/reference/scenes/analytic_scene.h"

namespace patina::collect_far_field_test {
namespace {

const Intrinsics kCamera{{96, 80}, 60, 60, 47.5, 39.5, {}};
constexpr int kEdge = gpu::kFarFieldEdge;

/// A frame of a camera; what it shows left of pixel 40 is a surface.
struct Sky {
    RigidTransform world_from_camera = reference::look_at({0, 0, 0}, {0.3, 0.4, 1});
    Image<float> depth_m{kCamera.extent, 0.0f};
    Image<glm::vec4> position_m{kCamera.extent, glm::vec4(0)};
    Image<glm::vec4> color{kCamera.extent, glm::vec4(0)};

    Sky() {
        for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
            for (uint32_t x = 0; x < kCamera.extent.width; ++x)
                color.at(x, y) = glm::vec4(static_cast<float>(x) / 64, static_cast<float>(y) / 64, 7, 1);
        }
    }

    glm::dvec3 direction(double x, double y) const {
        const glm::dvec3 in_camera((x - kCamera.cx) / kCamera.fx, (y - kCamera.cy) / kCamera.fy, 1);
        return glm::dmat3(world_from_camera) * in_camera;
    }
};

class CollectFarFieldTest : public GpuTest {
  protected:
    using Texels = std::map<int, glm::uvec4>;

    /// All 64 phases of a frame, so that every pixel looks once.
    Texels collect(const Sky& sky) {
        graph::FrameGraph frame = runner().begin();
        ReflectanceStateIds state;
        state.surroundings =
            frame.fill(frame.create_buffer("far_field", kEdge * kEdge * sizeof(gpu::FarFieldTexel)), 0);
        FarFieldInputs inputs;
        inputs.depth_m = frame.upload("depth", {kCamera.extent, vulkan::Format::kR32f},
                                      std::as_bytes(std::span(sky.depth_m.pixels())));
        inputs.position_m = frame.upload("position", {kCamera.extent, vulkan::Format::kRgba32f},
                                         std::as_bytes(std::span(sky.position_m.pixels())));
        std::vector<uint64_t> halves;
        for (const glm::vec4& pixel : sky.color.pixels()) halves.push_back(glm::packHalf4x16(pixel));
        inputs.color_linear =
            frame.upload("color", {kCamera.extent, vulkan::Format::kRgba16f}, std::as_bytes(std::span(halves)));
        inputs.depth_camera = inputs.color_camera = make_camera(kCamera, sky.world_from_camera);
        for (inputs.frame_index = 0; inputs.frame_index < 64; ++inputs.frame_index)
            add_collect_far_field(frame, state, inputs);
        const graph::Readback read = frame.read_back(state.surroundings);
        run(std::move(frame));
        Texels texels;
        const auto all = read.as<gpu::FarFieldTexel>();
        for (int i = 0; i < kEdge * kEdge; ++i) {
            if (all[i].sums.w > 0) texels[i] = all[i].sums;
        }
        return texels;
    }

    /// The same by a plain loop; `open(x, y)`: nothing within six pixels.
    template <class Open>
    static Texels expected(const Sky& sky, Open&& open) {
        Texels texels;
        for (uint32_t y = 6; y + 6 < kCamera.extent.height; ++y) {
            for (uint32_t x = 6; x + 6 < kCamera.extent.width; ++x) {
                if (!open(x, y)) continue;
                const glm::vec4 seen = glm::min(sky.color.at(x, y), glm::vec4(gpu::kColorRange));
                if (seen.a == 0) continue;
                glm::uvec4& sums = texels[reference::octahedral_texel(sky.direction(x, y), kEdge)];
                sums += glm::uvec4(glm::uvec3(glm::vec3(seen) * gpu::kFarFieldSteps + 0.5f), 1);
            }
        }
        return texels;
    }
};

TEST_F(CollectFarFieldTest, EveryPixelOfTheSkyCountsOnceInItsDirection) {
    const Sky sky;
    const Texels found = collect(sky), wanted = expected(sky, [](uint32_t, uint32_t) { return true; });
    ASSERT_GT(wanted.size(), 80u);
    uint64_t apart = 0, pixels = 0;
    for (const auto& [texel, sums] : wanted) {
        const glm::uvec4 got = found.contains(texel) ? found.at(texel) : glm::uvec4(0);
        apart += got.w > sums.w ? got.w - sums.w : sums.w - got.w;
        pixels += sums.w;
    }
    EXPECT_EQ(pixels, 84u * 68u);
    EXPECT_LT(apart, 12u) << "on borders of texels float and double differ";
}

TEST_F(CollectFarFieldTest, RadianceIsTheMeanAndIsClippedToWhatAVoxelHolds) {
    const Texels found = collect(Sky());
    for (const auto& [texel, sums] : found) EXPECT_EQ(sums.b, sums.w * 4096u) << texel;
}

TEST_F(CollectFarFieldTest, PixelsNearASurfaceOrOfTheModelDoNotCount) {
    Sky sky;
    for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
        for (uint32_t x = 0; x < 30; ++x) sky.depth_m.at(x, y) = 2;
        for (uint32_t x = 60; x < kCamera.extent.width; ++x) sky.position_m.at(x, y) = {1, 1, 1, 2};
    }
    uint64_t pixels = 0;
    for (const auto& [texel, sums] : collect(sky)) pixels += sums.w;
    EXPECT_EQ(pixels, (54u - 36u) * 68u) << "columns 36 to 53";
}

TEST_F(CollectFarFieldTest, PixelsWithoutAColourDoNotCount) {
    Sky sky;
    for (glm::vec4& pixel : sky.color.pixels()) pixel.a = 0;
    EXPECT_TRUE(collect(sky).empty());
}

}  // namespace
}  // namespace patina::collect_far_field_test
