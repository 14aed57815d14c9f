#include "passes/state/segment_batch.h"

#include <array>

#include "tests/gpu/gpu_test.h"

namespace patina::segment_batch_test {
namespace {

class SegmentBatchTest : public GpuTest {
  protected:
    std::vector<glm::uvec4> plan(uint32_t count, uint32_t capacity, std::span<const gpu::BatchWork> work) {
        const std::array list{count, 0u};
        graph::FrameGraph frame = runner().begin();
        const graph::BufferId arguments = add_plan_batch(frame, {frame.upload<uint32_t>("list", list), capacity}, work);
        const graph::Readback read = frame.read_back(arguments);
        run(std::move(frame));
        return read.as<glm::uvec4>();
    }
};

TEST_F(SegmentBatchTest, GroupsCoverTheWorkOfTheSegmentsThereAre) {
    // A group per segment; 25 images in tiles of 8, 5 items each.
    const std::array work{gpu::BatchWork{1, 1, gpu::kBatchGroup, 3}, gpu::BatchWork{25, 8, 5, 1}};
    using Arguments = std::vector<glm::uvec4>;
    EXPECT_EQ(plan(0, 9, work), (Arguments{{0, 3, 1, 0}, {0, 1, 1, 0}}));
    EXPECT_EQ(plan(1, 9, work), (Arguments{{1, 3, 1, 0}, {1, 1, 1, 0}}));
    EXPECT_EQ(plan(9, 9, work), (Arguments{{9, 3, 1, 0}, {3, 1, 1, 0}})) << "29 tiles, 145 items";
    EXPECT_EQ(plan(1000, 9, work), plan(9, 9, work)) << "more than there is room for";
}

TEST_F(SegmentBatchTest, ABatchThatCannotBeDispatchedIsRefused) {
    const std::array work{gpu::BatchWork{1, 1, gpu::kBatchGroup, 1}};
    EXPECT_THAT([&] { plan(1, 65536, work); },
                ::testing::ThrowsMessage<Error>(
                    ::testing::HasSubstr("65536 segments takes 65536 groups, at most 65535 can be dispatched")));
    EXPECT_THROW(plan(1, 0, work), Error);
}

}  // namespace
}  // namespace patina::segment_batch_test
