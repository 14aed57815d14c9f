// Which records have their turn though nothing says that they have changed.
#include <random>
#include <set>

#include "passes/reflectance/find_due_records.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/observation/entered_records.h"
#include "tests/gpu/reflectance/reflectance_rig.h"

namespace patina::due_window_test {
namespace {

class DueWindowTest : public GpuTest {
  protected:
    static constexpr uint32_t kNear = 3000;

    /// Near the origin kNear of them, and `far` others.
    static std::vector<FilledRecord> records(uint32_t far) {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> meters(-0.9f, 0.9f);
        std::vector<FilledRecord> all;
        std::set<std::array<int, 3>> voxels;
        while (all.size() < kNear + far) {
            const glm::vec3 at = glm::vec3(meters(random), meters(random), meters(random)) +
                                 (all.size() < kNear ? glm::vec3(0) : glm::vec3(9, 0, 0));
            const glm::ivec3 voxel(glm::floor(at / 0.02f));
            if (!voxels.insert({voxel.x, voxel.y, voxel.z}).second) continue;
            all.push_back({at, {0, -1, 0}, 1, {{{0, -1, 0}, {0.3f, 0.2f, 0.1f}, {}}}});
        }
        return all;
    }

    /// After each update, the records near the origin whose albedo is known.
    std::vector<std::set<uint32_t>> turns(uint32_t capacity_blocks, uint32_t far, uint32_t refreshed,
                                          uint32_t updates) {
        VoxelMap voxels(device(), {.capacity_blocks = 64});
        ObservationMap map(device(), {.capacity_blocks = capacity_blocks, .capacity_records = 16384});
        ReflectanceRig rig(device(), runner(), voxels, map);
        const std::vector<FilledRecord> filled = records(far);
        graph::FrameGraph frame = runner().begin();
        voxels.reset(frame, glm::dvec3(0));
        map.reset(frame, glm::dvec3(0));
        run(std::move(frame));
        frame = runner().begin();
        ObservationMapIds ids = map.import(frame);
        add_fill_records(frame, map, ids, filled);
        ids.albedo = frame.fill(ids.albedo, 0);
        ids.visibility = frame.fill(ids.visibility, 0);
        ObservationMap::keep(frame, ids);
        run(std::move(frame));
        enter_records(runner(), map, filled);
        rig.lights.set(std::vector<Light>{{{0, -3, 0}, {4, 4, 4}}}, glm::dvec3(0.1));
        rig.part.cube_m = {0, 0, 0, 2};
        ReflectanceSettings settings;
        settings.shadows = false;
        settings.refreshed_records = refreshed;
        std::vector<std::set<uint32_t>> after;
        for (uint32_t i = 0; i < updates; ++i) {
            rig.update(settings);
            auto& known = after.emplace_back();
            const auto refined = rig.records(kNear + far);
            for (uint32_t record = 0; record < refined.size(); ++record) {
                if (refined[record].albedo != glm::uvec2(0)) known.insert(record);
            }
            EXPECT_TRUE(known.empty() || *known.rbegin() < kNear) << "what is far has no turn";
        }
        return after;
    }
};

TEST_F(DueWindowTest, NeitherTheSizeOfTheTableNorWhatIsFarMatters) {
    const auto small = turns(8192, 0, 200, 30);
    EXPECT_EQ(turns(8192, 5000, 200, 30), small);
    EXPECT_EQ(turns(100000, 0, 200, 30), small);
    EXPECT_EQ(turns(100000, 5000, 200, 30), small);
    EXPECT_EQ(small.back().size(), kNear) << "each has had its turn";
}

TEST_F(DueWindowTest, AboutAsManyHaveATurnAsShould) {
    const auto known = turns(8192, 0, 100, 24);
    const double a_turn = static_cast<double>(known[23].size() - known[3].size()) / 20;
    EXPECT_GT(a_turn, 75);
    EXPECT_LT(a_turn, 130);
}

}  // namespace
}  // namespace patina::due_window_test
