#include "passes/state/voxel_map.h"

#include <algorithm>
#include <map>
#include <random>

#include "shared/test/test_voxel_map.h"
#include "spirv/shaders.h"
#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"

namespace patina::voxel_map_test {
namespace {

class VoxelMapTest : public GpuTest {
  protected:
    struct Insertions {
        std::vector<glm::uvec2> slot_and_fresh;  ///< by item of the list
        std::vector<uint32_t> table;
    };

    /// Inserts a list of keys in one dispatch, as the touch pass does.
    Insertions insert(const VoxelMap& map, const std::vector<uint32_t>& list) {
        graph::FrameGraph frame = runner().begin();
        VoxelMapIds ids = map.import(frame);
        auto pass = frame.compute("test.insert_keys", spirv::test_insert_keys);
        pass.read("List", frame.upload<uint32_t>("list", list));
        ids.keys = pass.modify("Keys", ids.keys);
        const auto out = pass.create("Insertions", list.size() * sizeof(glm::uvec2));
        pass.push(gpu::TestMapParams{map.grid(), static_cast<uint32_t>(list.size()), 0, 0, 0});
        pass.dispatch_covering(static_cast<uint32_t>(list.size()));
        const graph::Readback insertions = frame.read_back(out), table = frame.read_back(ids.keys);
        run(std::move(frame));
        return {insertions.as<glm::uvec2>(), table.as<uint32_t>()};
    }

    void reset(VoxelMap& map) {
        graph::FrameGraph frame = runner().begin();
        map.reset(frame, glm::dvec3(0));
        run(std::move(frame));
    }
};

std::set<uint32_t> random_keys(size_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::set<uint32_t> keys;
    while (keys.size() < count) keys.insert(random() % gpu::kEmptyKey);
    return keys;
}

/// Six walls, each `thickness` blocks thick, of a box of blocks: keys that differ in a few bits of each coordinate.
std::set<uint32_t> room_keys(uint32_t edge, uint32_t thickness) {
    std::set<uint32_t> keys;
    const auto in_wall = [&](uint32_t i) { return i < thickness || i >= edge - thickness; };
    for (uint32_t z = 0; z < edge; ++z) {
        for (uint32_t y = 0; y < edge; ++y) {
            for (uint32_t x = 0; x < edge; ++x) {
                if (in_wall(x) || in_wall(y) || in_wall(z)) {
                    keys.insert((x + 1000) | (y + 480) << 11 | (z + 990) << 21);
                }
            }
        }
    }
    return keys;
}

/// Each key several times, shuffled, so that many invocations insert the same at once.
std::vector<uint32_t> repeated(const std::set<uint32_t>& keys, int times, uint32_t seed) {
    std::vector<uint32_t> list;
    for (int i = 0; i < times; ++i) list.insert(list.end(), keys.begin(), keys.end());
    std::shuffle(list.begin(), list.end(), std::mt19937(seed));
    // Neighbours too.
    for (size_t i = 0; i + 1 < list.size(); i += 16) list[i + 1] = list[i];
    return list;
}

TEST_F(VoxelMapTest, KeysAreEnteredOnceWhereverTheyAreInsertedAtOnce) {
    const std::pair<const char*, std::set<uint32_t>> cases[] = {{"random", random_keys(100000, 3)},
                                                                {"room", room_keys(95, 2)}};
    VoxelMap map(device(), {0.005f, 65536});
    for (const auto& [name, keys] : cases) {
        SCOPED_TRACE(name);
        reset(map);
        const std::vector<uint32_t> list = repeated(keys, 4, 7);
        const std::set<uint32_t> distinct(list.begin(), list.end());
        const Insertions got = insert(map, list);

        std::multiset<uint32_t> entered;
        for (const uint32_t key : got.table) {
            if (key != gpu::kEmptyKey) entered.insert(key);
        }
        EXPECT_EQ(entered.size(), distinct.size());
        EXPECT_EQ(std::set<uint32_t>(entered.begin(), entered.end()), distinct);
        size_t fresh = 0, lost = 0;
        for (size_t i = 0; i < list.size(); ++i) {
            fresh += got.slot_and_fresh[i].y;
            const uint32_t slot = got.slot_and_fresh[i].x;
            lost += slot >= got.table.size() || got.table[slot] != list[i];
        }
        EXPECT_EQ(fresh, distinct.size());
        EXPECT_EQ(lost, 0u);
        // At 40 % load nearly all keys lie in their own bucket.
        for (const glm::uvec2& again : insert(map, list).slot_and_fresh) ASSERT_EQ(again.y, 0u);
    }
}

TEST_F(VoxelMapTest, NoKeyLeavesAHoleBeforeIt) {
    // Look-ups stop at a bucket whose last slot is free: on the way to a key there must be none.
    VoxelMap map(device(), {0.005f, 32768});
    reset(map);
    const std::vector<uint32_t> list = repeated(random_keys(65536, 5), 3, 9);  // half the table, its limit
    const Insertions got = insert(map, list);
    std::map<uint32_t, uint32_t> slot_of;
    for (uint32_t slot = 0; slot < got.table.size(); ++slot) slot_of[got.table[slot]] = slot;
    const uint32_t buckets = map.table_slots() / gpu::kBucketSlots;
    uint64_t probes = 0;
    for (size_t i = 0; i < list.size(); ++i) {
        // The mixer, written down a second time.
        uint32_t hash = list[i] ^ list[i] >> 16;
        hash *= 0x7feb352d;
        hash ^= hash >> 15;
        hash *= 0x846ca68b;
        hash ^= hash >> 16;
        uint32_t bucket = hash % buckets;
        const uint32_t target = slot_of.at(list[i]) / gpu::kBucketSlots;
        uint32_t steps = 1;
        for (; bucket != target && steps <= gpu::kMaxProbes; bucket = (bucket + 1) % buckets, ++steps) {
            ASSERT_NE(got.table[bucket * gpu::kBucketSlots + 3], gpu::kEmptyKey);
        }
        ASSERT_LE(steps, gpu::kMaxProbes);
        probes += steps;
    }
    EXPECT_LT(static_cast<double>(probes) / static_cast<double>(list.size()), 2.0);
}

TEST_F(VoxelMapTest, ATableWithoutRoomLosesOnlyWhatItCannotTake) {
    VoxelMap map(device(), {0.005f, 1000});
    reset(map);
    const std::vector<uint32_t> list = repeated(random_keys(map.table_slots() * 3 / 2, 11), 1, 13);
    const std::set<uint32_t> distinct(list.begin(), list.end());
    const Insertions got = insert(map, list);
    size_t fresh = 0;
    std::set<uint32_t> refused;
    for (size_t i = 0; i < list.size(); ++i) {
        const glm::uvec2 at = got.slot_and_fresh[i];
        fresh += at.y;
        if (at.x == UINT32_MAX) {
            refused.insert(list[i]);
        } else {
            ASSERT_EQ(got.table.at(at.x), list[i]);
        }
    }
    EXPECT_EQ(fresh + refused.size(), distinct.size());
    EXPECT_GT(fresh, map.table_slots() * 9 / 10);
    const auto free = std::count(got.table.begin(), got.table.end(), gpu::kEmptyKey);
    EXPECT_EQ(fresh + static_cast<size_t>(free), got.table.size());
}

TEST_F(VoxelMapTest, AFullTableIsReportedAndKeepsWhatItHas) {
    // Noise that touches a little more than half of the smallest table, two blocks per reading.
    const Intrinsics camera{{200, 160}, 150, 150, 99.5, 79.5, {}};
    const auto noise = [&](uint32_t seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> depth(1.0f, 8.0f);
        Image<float> depth_m(camera.extent);
        for (float& value : depth_m.pixels()) value = depth(random);
        return depth_m;
    };
    FusionSettings settings;
    settings.max_depth_m = 8;
    settings.truncation_slope = 0;
    settings.allocation_stride_px = 1;
    FusionRig rig(device(), runner(), {0.005f, 64}, settings);
    rig.fuse(camera, RigidTransform(1.0), noise(1));
    const gpu::MapCounters first = rig.counters();
    ASSERT_GT(first.table_keys, rig.map().table_slots() / 2);
    EXPECT_EQ(first.refused_samples, 0u);

    rig.fuse(camera, RigidTransform(1.0), noise(1));
    EXPECT_EQ(rig.counters().refused_samples, 0u);  // all of these keys are known
    EXPECT_EQ(rig.counters().table_keys, first.table_keys);

    RigidTransform turned(1.0);
    turned[0] = {-1, 0, 0, 0};
    turned[2] = {0, 0, -1, 0};
    rig.fuse(camera, turned, noise(2));
    EXPECT_GT(rig.counters().refused_samples, camera.extent.area() / 2);
    EXPECT_EQ(rig.counters().table_keys, first.table_keys);
    EXPECT_EQ(rig.counters().refused_blocks, first.refused_blocks);
}

TEST_F(VoxelMapTest, PointsOutsideTheRangeOfKeysAreCountedAndHarmless) {
    const Intrinsics camera = pinhole_camera({64, 48});
    const reference::DistanceField field = reference::sphere({0, 0, 1}, 0.2);
    const Image<float> depth_m = reference::render_depth(field, camera, RigidTransform(1.0), 3);
    FusionRig rig(device(), runner());
    rig.fuse(camera, RigidTransform(1.0), depth_m);
    ASSERT_EQ(rig.counters().outside_samples, 0u);
    const MapContent before = rig.content();
    // The range ends 41 m from the origin in x and z, 20.5 m in y.
    for (const glm::dvec3& center : {glm::dvec3(41.5, 0, 0), {0, -21, 0}, {0, 0, 41}, {0, 0, -1e5}}) {
        const uint32_t outside = rig.counters().outside_samples;
        RigidTransform far_away(1.0);
        far_away[3] = glm::dvec4(center, 1);
        rig.fuse(camera, far_away, depth_m);
        EXPECT_GT(rig.counters().outside_samples, outside);
    }
    EXPECT_EQ(rig.content(), before);
    // Just within, blocks are where they should be.
    RigidTransform near_the_end(1.0);
    near_the_end[3] = {40, -20, -40.5, 1};
    rig.fuse(camera, near_the_end, depth_m);
    for (const reference::BlockCoordinates& block : rig.allocated()) {
        if (before.contains(block)) continue;
        EXPECT_NEAR(block[0] * 0.04, 40, 0.3);
        EXPECT_NEAR(block[1] * 0.04, -20, 0.3);
        EXPECT_NEAR(block[2] * 0.04, -39.7, 0.3);
    }
    EXPECT_GT(rig.allocated().size(), before.size());
}

TEST_F(VoxelMapTest, CapacitiesOutOfRangeAreErrors) {
    EXPECT_THAT(
        [&] {
            VoxelMap(device(), {0.005f, 0});
        },
        ::testing::ThrowsMessage<Error>(::testing::HasSubstr("the voxel pool's capacity is 0 blocks")));
    EXPECT_THAT(
        [&] {
            VoxelMap(device(), {0.005f, 81, 16 * 2048});
        },
        ::testing::ThrowsMessage<Error>(::testing::HasSubstr("is 81 blocks, it must be 1 to 80")));
    EXPECT_THAT(
        [&] {
            VoxelMap(device(), {0.0f, 128});
        },
        ::testing::ThrowsMessage<Error>(::testing::HasSubstr("the voxel size is 0 m")));
}

}  // namespace
}  // namespace patina::voxel_map_test
