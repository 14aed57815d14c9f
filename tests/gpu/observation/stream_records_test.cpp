#include "passes/observation/stream_records.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

#include <glm/gtc/packing.hpp>

#include "passes/reflectance/average_segments.h"
#include "passes/segmentation/relabel_away.h"
#include "passes/state/away_albedo.h"
#include "passes/state/block_keys.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/observation/observed_scene.h"
#include "tests/gpu/segmentation/label_rig.h"

namespace patina::stream_records_test {
namespace {

using namespace observed_scene;

const reference::DistanceField kWall = reference::half_space({0, 0, -1}, -1.203);  // z = 1.203
constexpr uint32_t kLabels = 8;

/// All that there is of a record, by the key of its block and its voxel's number.
struct WholeRecord {
    gpu::StreamedRecord own{};
    std::vector<uint32_t> directions, colors;

    bool operator==(const WholeRecord& other) const {
        return std::memcmp(&own, &other.own, sizeof(own)) == 0 && directions == other.directions &&
               colors == other.colors;
    }
};
using WholeRecords = std::map<std::pair<uint32_t, uint32_t>, WholeRecord>;

/// Observations past the count hold anything.
WholeRecord whole_of(const gpu::StreamedRecord& own, const uint32_t* directions, const uint32_t* colors) {
    const uint32_t count = own.record.state & 31;
    WholeRecord whole{own, {directions, directions + count}, {colors, colors + count}};
    if (count >= 2) whole.directions.insert(whole.directions.end(), directions + 30, directions + 32);
    return whole;
}

uint32_t voxel_of(const gpu::VoxelRecord& record) { return record.state >> 5 & 63; }

class StreamRecordsTest : public GpuTest {
  protected:
    struct Rig {
        ObservationRig observations;
        ReflectanceState state;
        AwayAlbedo away;
    };

    Rig rig(float voxel_m = 0.02f, uint32_t records = 16384, uint64_t chunk_bytes = uint64_t{1} << 27) {
        ObservationSettings settings;
        settings.stride_px = 1;
        VoxelMapSettings voxels;
        voxels.capacity_blocks = 8192;
        ObservationMapSettings map;
        map.voxel_m = voxel_m;
        map.capacity_blocks = 4096;
        map.capacity_records = records;
        map.max_chunk_bytes = chunk_bytes;
        ObservationRig observations(device(), runner(), map, settings, {}, voxels);
        ReflectanceState state(device(), observations.map());
        AwayAlbedo away(device(), kLabels);
        graph::FrameGraph frame = runner().begin();
        state.reset(frame);
        away.reset(frame);
        run(std::move(frame));
        return {std::move(observations), std::move(state), std::move(away)};
    }

    static RigFrame wall_frame(glm::dvec3 at_m = {}) {
        RigidTransform pose(1.0);
        pose[3] = glm::dvec4(at_m, 1);
        RigFrame frame = frame_of(kWall, pose);
        frame.labels = Image<uint32_t>(kCamera.extent, 0u);
        for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
            for (uint32_t x = 0; x < kCamera.extent.width; ++x) frame.labels->at(x, y) = x / 20;
        }
        return frame;
    }

    static void observe(Rig& rig, const RigFrame& frame) {
        rig.observations.fuse(frame);
        rig.observations.collect(frame);
        rig.observations.collect(frame);
    }

    /// Gives the records of a rig albedos and all else that the refinement keeps, at random.
    void refine(Rig& rig) {
        const uint32_t capacity = rig.observations.map().capacity_records();
        std::vector<glm::uvec2> albedo(capacity), visibility(capacity);
        std::vector<gpu::RecordStatus> status(capacity);
        std::vector<gpu::RecordSurroundings> around(capacity);
        for (uint32_t i = 0; i < capacity; ++i) {
            // Mantissas are odd: no sum falls between two steps.
            const auto odd = [&] { return random_() % 256 * 2 + 1; };
            albedo[i] = {odd() | odd() << 9 | odd() << 18 | 15u << 27, random_() & 0x3fffffff};
            visibility[i] = {random_(), random_()};
            const auto word = [&] { return static_cast<uint32_t>(random_()); };
            status[i] = {word(), word(), word(), word(), {word(), word()}, {word(), word()}, word(), 0};
            around[i].around = word();
        }
        graph::FrameGraph frame = runner().begin();
        ObservationMapIds ids = rig.observations.map().import(frame);
        ids.albedo = frame.upload_bytes(ids.albedo, 0, std::as_bytes(std::span(albedo)), false);
        ids.visibility = frame.upload_bytes(ids.visibility, 0, std::as_bytes(std::span(visibility)), false);
        ReflectanceStateIds state = rig.state.import(frame);
        state.status = frame.upload_bytes(state.status, 0, std::as_bytes(std::span(status)), false);
        state.gathered = frame.upload_bytes(state.gathered, 0, std::as_bytes(std::span(around)), false);
        ObservationMap::keep(frame, ids);
        ReflectanceState::keep(frame, state);
        run(std::move(frame));
    }

    /// All records of the device, as its table finds them.
    WholeRecords records_on(Rig& rig) {
        const ObservationMap& map = rig.observations.map();
        graph::FrameGraph frame = runner().begin();
        const ObservationMapIds ids = map.import(frame);
        const auto keys_read = frame.read_back(ids.block_keys), table_read = frame.read_back(ids.record_table);
        const auto records_read = frame.read_back(ids.records), seen_read = frame.read_back(ids.seen);
        const auto changed_read = frame.read_back(ids.changed), albedo_read = frame.read_back(ids.albedo);
        const auto visible_read = frame.read_back(ids.visibility), directions_read = frame.read_back(ids.directions);
        const auto colors_read = frame.read_back(ids.colors);
        const ReflectanceStateIds state = rig.state.import(frame);
        const auto status_read = frame.read_back(state.status), around_read = frame.read_back(state.gathered);
        run(std::move(frame));
        const auto keys = keys_read.as<uint32_t>(), table = table_read.as<uint32_t>(), seen = seen_read.as<uint32_t>();
        const auto changed = changed_read.as<uint32_t>(), directions = directions_read.as<uint32_t>(),
                   colors = colors_read.as<uint32_t>();
        const auto records = records_read.as<gpu::VoxelRecord>();
        const auto albedo = albedo_read.as<glm::uvec2>(), visible = visible_read.as<glm::uvec2>();
        const auto status = status_read.as<gpu::RecordStatus>();
        const auto around = around_read.as<gpu::RecordSurroundings>();
        const uint32_t per_block = 1u << 3 * map.edge_shift();
        WholeRecords all;
        for (uint32_t entry = 0; entry < keys.size() * per_block; ++entry) {
            const uint32_t key = keys[entry / per_block], id = table[entry];
            if (key == gpu::kEmptyKey || id >= gpu::kNewRecord) continue;
            EXPECT_EQ(records[id].block_key, key);
            EXPECT_EQ(voxel_of(records[id]), entry % per_block);
            const gpu::StreamedRecord own{records[id], seen[id],          changed[id], albedo[id], visible[id],
                                          status[id],  around[id].around, 0,           0,          0};
            all[{key, entry % per_block}] = whole_of(own, &directions[size_t{id} * 32], &colors[size_t{id} * 32]);
        }
        return all;
    }

    struct Left {
        std::vector<gpu::StreamedBlock> blocks;
        std::vector<gpu::StreamedRecord> records;
        std::vector<uint32_t> directions, colors;
        uint32_t outside = 0;

        WholeRecords whole() const {
            WholeRecords all;
            for (const gpu::StreamedBlock& block : blocks) {
                for (uint32_t i = block.first_record; i < block.first_record + block.records; ++i) {
                    EXPECT_EQ(records[i].record.block_key, block.key);
                    all[{block.key, voxel_of(records[i].record)}] =
                        whole_of(records[i], &directions[size_t{i} * 32], &colors[size_t{i} * 32]);
                }
            }
            return all;
        }
    };

    Left leave(Rig& rig, const StreamRegion& region, uint32_t most) {
        graph::FrameGraph frame = runner().begin();
        ObservationMapIds ids = rig.observations.map().import(frame);
        ReflectanceStateIds state = rig.state.import(frame);
        graph::BufferId away = rig.away.import(frame);
        const LeavingRecords leaving = add_leave_records(frame, {rig.observations.map(), ids, state, away},
                                                         rig.observations.fusion().map().grid(), region.gpu(), most);
        keep(frame, ids, state, away);
        const auto counts = frame.read_back(leaving.counts), count_read = frame.read_back(leaving.count);
        const auto blocks = frame.read_back(leaving.blocks), records = frame.read_back(leaving.records);
        const auto directions = frame.read_back(leaving.directions), colors = frame.read_back(leaving.colors);
        run(std::move(frame));
        const gpu::LeavingCount count = count_read.as<gpu::LeavingCount>().front();
        Left left{blocks.as<gpu::StreamedBlock>(), records.as<gpu::StreamedRecord>(), directions.as<uint32_t>(),
                  colors.as<uint32_t>(), counts.as<uint32_t>()[gpu::kLeavingOutside]};
        left.blocks.resize(count.blocks);
        left.records.resize(count.records);
        return left;
    }

    /// Returns the list of blocks as it came back.
    std::vector<gpu::StreamedBlock> return_to(Rig& rig, Left left) {
        std::sort(left.blocks.begin(), left.blocks.end(),
                  [](const auto& a, const auto& b) { return a.first_record < b.first_record; });
        for (uint32_t place = 0; place < left.blocks.size(); ++place) {
            const gpu::StreamedBlock& block = left.blocks[place];
            for (uint32_t i = 0; i < block.records; ++i) left.records[block.first_record + i].record.block_key = place;
        }
        graph::FrameGraph frame = runner().begin();
        ObservationMapIds ids = rig.observations.map().import(frame);
        ReflectanceStateIds state = rig.state.import(frame);
        graph::BufferId away = rig.away.import(frame);
        const ReturningRecords returning{static_cast<uint32_t>(left.blocks.size()),
                                         static_cast<uint32_t>(left.records.size()),
                                         frame.upload<gpu::StreamedBlock>("blocks", left.blocks),
                                         frame.upload<gpu::StreamedRecord>("records", left.records),
                                         frame.upload<uint32_t>("directions", left.directions),
                                         frame.upload<uint32_t>("colors", left.colors)};
        const auto read =
            frame.read_back(add_return_records(frame, {rig.observations.map(), ids, state, away}, returning));
        keep(frame, ids, state, away);
        run(std::move(frame));
        return read.as<gpu::StreamedBlock>();
    }

    static void keep(graph::FrameGraph& frame, const ObservationMapIds& ids, const ReflectanceStateIds& state,
                     graph::BufferId away) {
        ObservationMap::keep(frame, ids);
        ReflectanceState::keep(frame, state);
        frame.keep(away);
    }

    std::vector<gpu::SegmentAlbedo> sums_of(Rig& rig) {
        graph::FrameGraph frame = runner().begin();
        const auto read = frame.read_back(rig.away.import(frame));
        run(std::move(frame));
        return read.as<gpu::SegmentAlbedo>();
    }

    /// What the sums must be when these records are away.
    static void expect_sums(const std::vector<gpu::SegmentAlbedo>& sums, const WholeRecords& away) {
        std::vector<gpu::SegmentAlbedo> expected(size_t{kLabels} * gpu::kSweepParts, gpu::SegmentAlbedo{});
        for (const auto& [at, record] : away) {
            const uint32_t label = record.own.record.label & 0xffff;
            if (label == 0) continue;
            gpu::SegmentAlbedo& own = expected[label * gpu::kSweepParts + hash_of_key(at.first) % gpu::kSweepParts];
            const glm::vec3 kd = glm::unpackF3x9_E1x5(record.own.albedo.x);
            for (int c = 0; c < 3; ++c) {
                const auto weight = static_cast<uint32_t>(
                    std::lround((record.own.albedo.y >> 10 * c & 1023) * double{gpu::kCertaintySteps} / 1023));
                own.weight[c] += weight;
                own.kd[c] += static_cast<uint32_t>(std::lround(std::min(double{kd[c]}, 1.0) * 1023)) * weight;
            }
            own.kd.w += 1;
            own.weight.w += record.own.record.state & 31;
        }
        ASSERT_EQ(sums.size(), expected.size());
        EXPECT_EQ(std::memcmp(sums.data(), expected.data(), sums.size() * sizeof(sums[0])), 0);
    }

    /// Table, lists and counters fit each other.
    static void expect_sound(Rig& rig) {
        const auto expect_once = [](const ObservationRig::PoolIds& pool, uint32_t capacity) {
            std::vector<uint32_t> ids = pool.used, expected(capacity);
            ids.insert(ids.end(), pool.free.begin(), pool.free.end());
            std::sort(ids.begin(), ids.end());
            std::iota(expected.begin(), expected.end(), 0u);
            EXPECT_EQ(ids, expected) << "each place is in use or free, once";
        };
        expect_once(rig.observations.block_ids(), rig.observations.map().capacity_blocks());
        expect_once(rig.observations.record_ids(), rig.observations.map().capacity_records());
        for (const uint32_t id : rig.observations.record_ids().used)
            EXPECT_LT(id, rig.observations.record_counters().high_water);
    }

    static std::pair<WholeRecords, WholeRecords> split(Rig& rig, const WholeRecords& all, const StreamRegion& region) {
        std::pair<WholeRecords, WholeRecords> parts;
        const gpu::VoxelGrid grid = rig.observations.fusion().map().grid();
        for (const auto& [at, record] : all)
            (region.holds(grid, block_of_key(grid, at.first)) ? parts.first : parts.second)[at] = record;
        return parts;
    }

    std::mt19937 random_{29};
};

const StreamRegion kBall = StreamRegion::ball({0.1, 0, 1.2}, 0.3);
constexpr uint32_t kAll = 1u << 15;

TEST_F(StreamRecordsTest, WhatLiesOutsideLeavesAndComesBackAsItWas) {
    for (const float voxel_m : {0.02f, 0.01f}) {
        SCOPED_TRACE(voxel_m);
        Rig rig = this->rig(voxel_m);
        observe(rig, wall_frame());
        refine(rig);
        const WholeRecords before = records_on(rig);
        const auto [inside, outside] = split(rig, before, kBall);
        ASSERT_GT(inside.size(), 300u);
        ASSERT_GT(outside.size(), 500u);
        const Left left = leave(rig, kBall, kAll);
        EXPECT_EQ(left.whole(), outside);
        EXPECT_EQ(left.outside, outside.size());
        EXPECT_EQ(records_on(rig), inside);
        EXPECT_EQ(rig.observations.content().size(), inside.size());
        EXPECT_EQ(rig.observations.record_counters().left_blocks, outside.size());
        expect_sums(sums_of(rig), outside);
        expect_sound(rig);

        for (const gpu::StreamedBlock& block : return_to(rig, left)) EXPECT_NE(block.block, gpu::kNoBlock);
        EXPECT_EQ(records_on(rig), before);
        EXPECT_EQ(rig.observations.record_counters().returned_blocks, outside.size());
        expect_sums(sums_of(rig), {});
        expect_sound(rig);
    }
}

TEST_F(StreamRecordsTest, ObservationsAreFoundInEveryChunk) {
    Rig rig = this->rig(0.02f, 3200, 1u << 17);
    ASSERT_EQ(rig.observations.map().chunks(), 4u);
    observe(rig, wall_frame());
    const ObservationContent before = rig.observations.content();
    ASSERT_GT(before.size(), 2 * rig.observations.map().chunk_records());
    const Left left = leave(rig, kBall, kAll);
    EXPECT_LT(rig.observations.content().size(), before.size() / 2);
    return_to(rig, left);
    EXPECT_EQ(rig.observations.content(), before);
}

TEST_F(StreamRecordsTest, OfTooManyTheSameOnesLeaveInEveryRun) {
    std::vector<WholeRecords> runs;
    for (int run = 0; run < 2; ++run) {
        Rig rig = this->rig();
        observe(rig, wall_frame());
        const WholeRecords all = records_on(rig);
        const Left left = leave(rig, kBall, 300);
        EXPECT_LE(left.records.size(), 300u);
        EXPECT_GT(left.records.size(), 200u);
        EXPECT_EQ(left.outside, split(rig, all, kBall).second.size());
        runs.push_back(left.whole());
    }
    EXPECT_EQ(runs[0], runs[1]);
}

TEST_F(StreamRecordsTest, WhatFindsNoPlaceStaysAway) {
    Rig rig = this->rig(0.02f, 4096);
    observe(rig, wall_frame());
    const uint32_t size = static_cast<uint32_t>(records_on(rig).size());
    Rig tight = this->rig(0.02f, size + size / 2);
    observe(tight, wall_frame());
    refine(tight);
    const WholeRecords first = records_on(tight);
    const Left left = leave(tight, StreamRegion::ball({9, 9, 9}, 0.1), kAll);
    EXPECT_TRUE(records_on(tight).empty());
    observe(tight, wall_frame({3, 0, 0}));
    const WholeRecords second = records_on(tight);
    WholeRecords expected = second, away = left.whole();
    uint32_t refused = 0;
    for (const gpu::StreamedBlock& block : return_to(tight, left)) {
        refused += block.block == gpu::kNoBlock ? block.records : 0;
        if (block.block == gpu::kNoBlock) continue;
        for (uint32_t voxel = 0; voxel < 64; ++voxel) {
            const auto node = away.extract({block.key, voxel});
            if (node) expected[node.key()] = node.mapped();
        }
    }
    EXPECT_GT(refused, size / 3);
    EXPECT_LT(refused, size);
    EXPECT_EQ(refused, away.size());
    EXPECT_EQ(tight.observations.record_counters().refused_blocks, refused);
    EXPECT_EQ(records_on(tight), expected);
    expect_sums(sums_of(tight), away);
    expect_sound(tight);
}

TEST_F(StreamRecordsTest, OfAKeyThatHasABlockWhatComesBackIsDropped) {
    Rig rig = this->rig();
    observe(rig, wall_frame());
    refine(rig);
    const Left left = leave(rig, kBall, kAll);
    observe(rig, wall_frame({-0.2, 0, 0}));
    const WholeRecords now = records_on(rig), old = left.whole();
    std::set<uint32_t> there;
    for (const auto& [at, record] : now) there.insert(at.first);
    WholeRecords expected = now;
    uint32_t dropped = 0;
    for (const auto& [at, record] : old) {
        dropped += there.contains(at.first);
        if (!there.contains(at.first)) expected[at] = record;
    }
    ASSERT_GT(dropped, 100u);
    ASSERT_LT(dropped, old.size());
    return_to(rig, left);
    EXPECT_EQ(records_on(rig), expected);
    expect_sums(sums_of(rig), {});
    expect_sound(rig);
}

TEST_F(StreamRecordsTest, SumsFollowTheRootsOfTheirLabelsPartByPart) {
    constexpr uint32_t kMany = 150;  // more than two groups, and a part of one
    const AwayAlbedo away(device(), kMany);
    SegmentTable table(device(), kMany);
    const std::vector<uint32_t> roots = random_roots(kMany, random_);
    std::vector<gpu::SegmentAlbedo> sums(size_t{kMany} * gpu::kSweepParts), expected;
    for (uint32_t i = gpu::kSweepParts; i < sums.size(); ++i) {
        const auto some = [&] { return glm::uvec4(random_() % 9999, random_() % 9999, random_() % 9999, 1); };
        sums[i] = {some(), some()};
    }
    expected = sums;
    constexpr uint32_t kPart = 5;
    for (uint32_t label = 1; label < kMany; ++label) {
        if (roots[label] == label) continue;
        const size_t from = label * gpu::kSweepParts + kPart, to = roots[label] * gpu::kSweepParts + kPart;
        expected[from] = {};
        if (roots[label] == 0) continue;
        expected[to].kd += sums[from].kd;
        expected[to].weight += sums[from].weight;
    }
    Rig rig = this->rig();
    const ObservationMap& map = rig.observations.map();
    gpu::SegmentationParams params{};
    params.stamp = (gpu::kSweepParts * 3 + kPart) * gpu::kSweepEvery + 3;
    graph::FrameGraph frame = runner().begin();
    SegmentTableIds ids = table.import(frame);
    ids.parents = frame.upload<uint32_t>("parents", roots);
    graph::BufferId moved = frame.upload<gpu::SegmentAlbedo>("sums", sums);
    add_relabel_away(frame, moved, ids,
                     frame.upload<gpu::SegmentationParams>("params", std::span(&std::as_const(params), 1)));
    // And what a segment has on the whole counts them.
    const auto averaged = frame.read_back(add_average_segments(frame, map, map.import(frame), kMany, moved));
    const auto read = frame.read_back(moved);
    run(std::move(frame));
    const auto got = read.as<gpu::SegmentAlbedo>(), all = averaged.as<gpu::SegmentAlbedo>();
    EXPECT_EQ(std::memcmp(got.data(), expected.data(), got.size() * sizeof(got[0])), 0);
    for (uint32_t label = 0; label < kMany; ++label) {
        glm::uvec4 kd(0), weight(0);
        for (uint32_t part = 0; part < gpu::kSweepParts; ++part) {
            kd += expected[label * gpu::kSweepParts + part].kd;
            weight += expected[label * gpu::kSweepParts + part].weight;
        }
        EXPECT_EQ(all[label].kd, kd) << label;
        EXPECT_EQ(all[label].weight, weight) << label;
    }
}

}  // namespace
}  // namespace patina::stream_records_test
