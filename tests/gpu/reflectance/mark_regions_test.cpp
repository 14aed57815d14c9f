// Regions of the map that rays cross in one step.

#include "passes/reflectance/mark_regions.h"

#include <cmath>
#include <set>

#include "tests/gpu/reflectance/radiant_room.h"

namespace patina::mark_regions_test {
namespace {

using MarkRegions = RadiantRoomTest;

constexpr uint64_t kAt = kSurroundingsCellsAt - gpu::kMapRegionWords * sizeof(uint32_t);

TEST_F(MarkRegions, RegionsWithBlocksAreMarked) {
    const auto model = fused(grey, std::array{glm::dvec3(0, 0, 1)});
    model->reflectance.update_all({});
    graph::Readback read;
    model->reflectance.change([&](graph::FrameGraph& frame, ReflectanceStateIds& state) {
        read = frame.read_back(state.surroundings, kAt, gpu::kMapRegionWords * sizeof(uint32_t));
    });
    std::set<uint32_t> expected, marked;
    for (const reference::BlockCoordinates& block : model->observations.fusion().allocated()) {
        uint32_t bit = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const int region = static_cast<int>(std::floor(block[axis] / 8.0));
            bit |= static_cast<uint32_t>((region % 128 + 128) % 128) << 7 * axis;
        }
        expected.insert(bit);
    }
    const auto words = read.as<uint32_t>();
    for (uint32_t bit = 0; bit < 32 * gpu::kMapRegionWords; ++bit) {
        if ((words[bit / 32] >> bit % 32 & 1) != 0) marked.insert(bit);
    }
    EXPECT_GT(expected.size(), 3u);
    EXPECT_EQ(marked, expected);
}

TEST_F(MarkRegions, RaysFindTheSameAsWhereEveryRegionIsLookedAt) {
    const std::vector<uint32_t> all(gpu::kMapRegionWords, 0xffffffffu);
    ReflectanceSettings settings;
    settings.gathered_rays = 4;
    std::array<std::vector<RefinedRecord>, 2> found;
    for (size_t every = 0; every < 2; ++every) {
        const auto model = fused(grey, std::array{glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)});
        if (every == 1) {
            model->reflectance.change([&](graph::FrameGraph& frame, ReflectanceStateIds& state) {
                state.surroundings = frame.upload_bytes(state.surroundings, kAt, std::as_bytes(std::span(all)), false);
            });
        }
        model->reflectance.update_all(settings);
        found[every] = model->reflectance.records();
    }
    ASSERT_EQ(found[0].size(), found[1].size());
    double met = 0;
    for (size_t i = 0; i < found[0].size(); ++i) {
        // Where a ray enters a block may differ in the last digit, and with it the voxel whose colour it takes.
        ASSERT_EQ(found[0][i].gathered.met, found[1][i].gathered.met) << i;
        ASSERT_LT(glm::distance(found[0][i].gathered.mean, found[1][i].gathered.mean), kColorStep) << i;
        met += found[0][i].gathered.met;
    }
    EXPECT_GT(met, 1000) << "one wall sees the other";
}

}  // namespace
}  // namespace patina::mark_regions_test
