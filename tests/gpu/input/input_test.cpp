#include "passes/input/input.h"

#include <algorithm>

#include "engine/core/shader_camera.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"

namespace patina::input_test {
namespace {

using InputTest = GpuTest;

/// A noisy RGB-D picture from distorted cameras, the colour picture of another extent.
struct Recording {
    Recording() {
        std::mt19937 random(1);
        for (auto& code : depth) code = static_cast<uint16_t>(2000 + random() % 20);
        for (auto& pixel : color) pixel = glm::u8vec3(random(), random(), random());
    }
    InputImages add(graph::FrameGraph& frame) const {
        return add_input(frame, {std::span<const uint16_t>(depth), depth_camera},
                         {std::span<const glm::u8vec3>(color), color_camera},
                         make_camera(depth_camera, RigidTransform(1.0)));
    }

    Intrinsics depth_camera = distorted_camera({100, 80});
    Intrinsics color_camera = distorted_camera({131, 97});
    std::vector<uint16_t> depth = std::vector<uint16_t>(100 * 80);
    std::vector<glm::u8vec3> color = std::vector<glm::u8vec3>(131 * 97);
};

TEST_F(InputTest, TheSameInputGivesTheSameBytes) {
    const Recording recording;
    std::vector<std::vector<std::byte>> first;
    for (int repetition = 0; repetition < 5; ++repetition) {
        graph::FrameGraph frame = runner().begin();
        const InputImages images = recording.add(frame);
        std::vector<graph::Readback> results;
        for (const graph::ImageId id : {images.depth_m, images.filtered_depth_m, images.surface.position_m,
                                        images.surface.normal, images.color}) {
            results.push_back(frame.read_back(id));
        }
        run(std::move(frame));
        std::vector<std::vector<std::byte>> bytes;
        for (const auto& result : results) bytes.push_back(result.as<std::byte>());
        if (repetition == 0) first = bytes;
        EXPECT_TRUE(bytes == first);
    }
    EXPECT_EQ(runner().compilations(), 1u);
}

TEST_F(InputTest, PositionsComeFromTheSmoothedDepth) {
    const Recording recording;
    graph::FrameGraph frame = runner().begin();
    const InputImages images = recording.add(frame);
    const auto filtered = frame.read_back(images.filtered_depth_m);
    const auto position = frame.read_back(images.surface.position_m);
    run(std::move(frame));
    const auto filtered_m = filtered.as<float>();
    const auto position_m = position.as<glm::vec4>();
    EXPECT_GT(std::count_if(filtered_m.begin(), filtered_m.end(), [](float z) { return z > 0; }), 7000);
    for (size_t i = 0; i < filtered_m.size(); ++i) ASSERT_FLOAT_EQ(position_m[i].z, filtered_m[i]);
}

TEST_F(InputTest, PassesWithoutAUserAreCulled) {
    graph::FrameGraph frame = runner().begin();
    frame.keep(Recording().add(frame).color);
    run(std::move(frame));
    std::vector<std::string> names;
    for (const auto& timing : runner().pass_timings()) names.push_back(timing.name);
    EXPECT_THAT(names, ::testing::Not(::testing::Contains("input.convert_depth")));
}

}  // namespace
}  // namespace patina::input_test
