#include "passes/segmentation/sample_records.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "passes/state/block_keys.h"
#include "reconstruction/streaming/stream_region.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/observation/entered_records.h"
#include "tests/gpu/segmentation/packed_albedo.h"

namespace patina::sample_records_test {
namespace {

/// Records as the observation passes leave them, by label and number of observations.
class SampleRecords : public GpuTest {
  protected:
    static constexpr uint32_t kLabels = 16, kDraws = 25;

    static gpu::VoxelRecord record(uint32_t index, uint32_t label, uint32_t observations = 10) {
        gpu::VoxelRecord record{};
        record.block_key = index / 8;
        record.state = observations | index % 8 << 5;
        record.label = label | 1u << 16;
        return record;
    }

    struct Sampled {
        std::vector<gpu::SegmentSampleCount> counts;
        std::vector<std::set<uint32_t>> kept;      ///< voxels by label
        std::vector<std::vector<uint32_t>> drawn;  ///< likewise, in the order of the draw
        std::vector<gpu::SegmentKd> kd;
    };

    /// `albedo`: by record, as the refinement stores it; none: nothing is known.
    Sampled sample(const std::vector<gpu::VoxelRecord>& records, uint32_t seed, uint32_t draw_seed,
                   const std::vector<glm::uvec2>& albedo = {}, const StreamRegion& region = {}) {
        graph::FrameGraph frame = runner().begin();
        ObservationMapIds ids = map_.import(frame);
        gpu::MapCounters counters{};
        counters.high_water = static_cast<uint32_t>(records.size());
        ids.record_counters = frame.upload_bytes(ids.record_counters, 0, std::as_bytes(std::span(&counters, 1)), true);
        ids.records = frame.upload_bytes(ids.records, 0, std::as_bytes(std::span(records)), false);
        if (!albedo.empty()) ids.albedo = frame.upload_bytes(ids.albedo, 0, std::as_bytes(std::span(albedo)), false);
        SegmentSampleIds sampled = samples_.import(frame);
        add_sample_records(frame, map_, ids, samples_, sampled, {voxels_, region.gpu(), 4, seed});
        ObservationMap::keep(frame, ids);
        SegmentSamples::keep(frame, sampled);
        const graph::Readback counts = frame.read_back(sampled.counts), kept = frame.read_back(sampled.kept),
                              kd = frame.read_back(sampled.kd),
                              drawn =
                                  frame.read_back(add_draw_records(frame, ids, samples_, sampled, kDraws, draw_seed));
        runner().submit(std::move(frame));
        runner().wait();
        Sampled result{counts.as<gpu::SegmentSampleCount>(), {}, {}, kd.as<gpu::SegmentKd>()};
        const auto voxel = [&](uint32_t id) { return records[id].block_key * 8 + (records[id].state >> 5 & 7); };
        const auto all = kept.as<uint32_t>(), draws = drawn.as<uint32_t>();
        for (uint32_t label = 0; label < kLabels; ++label) {
            auto& set = result.kept.emplace_back();
            for (uint32_t i = 0; i < result.counts[label].kept; ++i)
                set.insert(voxel(all[label * gpu::kSegmentSamples + i]));
            auto& list = result.drawn.emplace_back();
            for (uint32_t i = 0; i < kDraws; ++i) {
                const uint32_t id = draws[label * kDraws + i];
                if (id != gpu::kNoRecord) list.push_back(voxel(id));
            }
        }
        return result;
    }

    /// Blocks of 4 cm, as those of the observations.
    gpu::VoxelGrid voxels_ = [] {
        gpu::VoxelGrid grid{};
        grid.voxel_m = 0.005f;
        return grid;
    }();
    ObservationMap map_{device(), {.capacity_blocks = 1024, .capacity_records = 8192}};
    SegmentSamples samples_{device(), kLabels};
};

/// The statistic of Pearson's test for counts that should be equal, in standard deviations from its mean.
double chi_square_deviation(const std::vector<uint32_t>& counts) {
    double total = 0;
    for (const uint32_t count : counts) total += count;
    const double expected = total / static_cast<double>(counts.size()),
                 freedom = static_cast<double>(counts.size()) - 1;
    double sum = 0;
    for (const uint32_t count : counts) sum += (count - expected) * (count - expected) / expected;
    return (sum - freedom) / std::sqrt(2 * freedom);
}

TEST_F(SampleRecords, KeepsAllOfASmallSegmentAndBetweenHalfAndAllPlacesOfALargeOne) {
    std::vector<gpu::VoxelRecord> records;
    for (uint32_t i = 0; i < 6000; ++i) {
        const uint32_t label = i < 24 ? 1 : i < 49 ? 2 : i < 305 ? 3 : i < 1000 ? 4 : 5;
        records.push_back(record(i, label, label == 4 ? 0 : 10));
    }
    const Sampled sampled = sample(records, 1, 2);
    EXPECT_EQ(sampled.kept[1].size(), 24u);
    EXPECT_EQ(sampled.kept[2].size(), 25u);
    EXPECT_EQ(sampled.kept[3].size(), 256u);
    EXPECT_EQ(sampled.counts[4].eligible, 0u) << "no observations";
    EXPECT_EQ(sampled.counts[5].eligible, 5000u);
    EXPECT_THAT(sampled.kept[5].size(), ::testing::AllOf(::testing::Ge(100u), ::testing::Le(256u)));
    EXPECT_TRUE(sampled.drawn[1].empty()) << "fewer than are drawn";
    for (const uint32_t label : {2u, 3u, 5u}) {
        const std::set<uint32_t> different(sampled.drawn[label].begin(), sampled.drawn[label].end());
        EXPECT_EQ(different.size(), kDraws) << label;
        EXPECT_TRUE(std::ranges::includes(sampled.kept[label], different)) << label;
    }
}

TEST_F(SampleRecords, RecordsWithFewObservationsFillUpTheRoomThatOthersLeave) {
    std::vector<gpu::VoxelRecord> records;
    std::set<uint32_t> often, seldom;
    for (uint32_t i = 0; i < 6000; ++i) {
        const uint32_t label = i < 3000 ? 1 : i < 3100 ? 2 : 3;
        const bool well = label == 1 ? i % 15 == 0 : label == 3;
        records.push_back(record(i, label, well ? 4 : 1 + i % 3));
        if (label == 1) (well ? often : seldom).insert(i);
    }
    const Sampled sampled = sample(records, 1, 2);
    EXPECT_TRUE(std::ranges::includes(sampled.kept[1], often)) << "all 200";
    EXPECT_THAT(sampled.kept[1].size() - often.size(), ::testing::AllOf(::testing::Ge(20u), ::testing::Le(56u)));
    EXPECT_EQ(sampled.counts[1].eligible, 3000u);
    EXPECT_EQ(sampled.kept[2].size(), 100u) << "where nothing was seen often, those few times";
    EXPECT_GT(sampled.kept[3].size(), 100u);
}

TEST_F(SampleRecords, SumsUpTheAlbedoOfTheRecordsThatAreKept) {
    std::vector<gpu::VoxelRecord> records;
    std::vector<glm::uvec2> albedo;
    for (uint32_t i = 0; i < 1200; ++i) {
        records.push_back(record(i, i < 40 ? 1 : i < 80 ? 2 : 3));
        const glm::vec3 kd = i < 40 ? glm::vec3(i % 2 == 0 ? 0.6f : 0.2f, 0.5f, 0.3f) : glm::vec3(0.7f);
        albedo.push_back(packed_albedo(kd, i >= 40 && i < 80 ? 0.4f : 0.9f));
    }
    const Sampled sampled = sample(records, 1, 2, albedo);
    EXPECT_EQ(sampled.kd[1].samples, 40u);
    EXPECT_NEAR(sampled.kd[1].r / (40 * gpu::kKdSteps), 0.4, 2e-3);  // 9 bits, and steps of kd
    EXPECT_NEAR(sampled.kd[1].g / (40 * gpu::kKdSteps), 0.5, 2e-3);
    EXPECT_NEAR(sampled.kd[1].b / (40 * gpu::kKdSteps), 0.3, 2e-3);
    EXPECT_EQ(sampled.kd[2].samples, 0u) << "not sure";
    EXPECT_EQ(sampled.kd[3].samples, sampled.kept[3].size());
    EXPECT_NEAR(sampled.kd[3].g / (float(sampled.kd[3].samples) * gpu::kKdSteps), 0.7, 2e-3);
    EXPECT_EQ(sample({record(0, 1)}, 1, 2, {glm::uvec2(0)}).kd[1].samples, 0u) << "begun anew, and nothing is known";
}

TEST_F(SampleRecords, RecordsOutsideTheRegionAreNotKept) {
    std::vector<gpu::VoxelRecord> records;
    for (uint32_t i = 0; i < 2000; ++i) records.push_back(record(i, 1));
    const glm::dvec3 middle_m = (glm::dvec3(block_of_key(voxels_, records[800].block_key)) + 0.5) * 0.04;
    const StreamRegion region = StreamRegion::ball(middle_m, 0.5);
    std::set<uint32_t> within;
    for (uint32_t i = 0; i < 2000; ++i) {
        if (region.holds(voxels_, block_of_key(voxels_, records[i].block_key))) within.insert(i);
    }
    EXPECT_EQ(within.size(), 25 * 8u) << "0.5 m to both sides along x";
    const Sampled sampled = sample(records, 1, 2, {}, region);
    EXPECT_EQ(sampled.kept[1], within);
    EXPECT_EQ(sampled.counts[1].eligible, within.size());
}

TEST_F(SampleRecords, AreFoundAgainWhereTheyLieWhenTheyAreOtherRecords) {
    std::vector<FilledRecord> filled;
    for (uint32_t i = 0; i < 700; ++i) {
        const glm::ivec3 voxel(i % 10, i / 10 % 10, i / 100);
        filled.push_back({(glm::vec3(voxel) + 0.5f) * 0.02f, {0, -1, 0}, i < 100 ? 1u : i < 110 ? 2u : 3u, {}});
        filled.back().observations.resize(5);
    }
    const auto fill = [&](const std::vector<FilledRecord>& records) {
        graph::FrameGraph frame = runner().begin();
        map_.reset(frame, glm::dvec3(0));
        run(std::move(frame));
        frame = runner().begin();
        ObservationMapIds ids = map_.import(frame);
        add_fill_records(frame, map_, ids, records);
        ObservationMap::keep(frame, ids);
        run(std::move(frame));
        enter_records(runner(), map_, records);
    };
    fill(filled);
    graph::FrameGraph frame = runner().begin();
    ObservationMapIds ids = map_.import(frame);
    gpu::MapCounters counters{};
    counters.high_water = static_cast<uint32_t>(filled.size());
    ids.record_counters = frame.upload_bytes(ids.record_counters, 0, std::as_bytes(std::span(&counters, 1)), true);
    SegmentSampleIds sampled = samples_.import(frame);
    add_sample_records(frame, map_, ids, samples_, sampled, {voxels_, StreamRegion{}.gpu(), 4, 1});
    SegmentSamples::keep(frame, sampled);
    const graph::Readback places_read = frame.read_back(add_place_samples(frame, ids, samples_, sampled));
    const graph::Readback counts_read = frame.read_back(sampled.counts), kept_read = frame.read_back(sampled.kept);
    run(std::move(frame));
    const auto counts = counts_read.as<gpu::SegmentSampleCount>();
    const auto kept = kept_read.as<uint32_t>();
    const auto places = places_read.as<glm::uvec2>();
    ASSERT_EQ(counts[1].kept, 100u);
    ASSERT_EQ(counts[2].kept, 10u);
    ASSERT_LT(counts[3].kept, 300u);

    // In another order; every seventh is gone.
    std::vector<FilledRecord> others;
    std::vector<uint32_t> now(filled.size(), gpu::kNoRecord);
    for (uint32_t i = static_cast<uint32_t>(filled.size()); i-- > 0;) {
        if (i % 7 == 0) continue;
        now[i] = static_cast<uint32_t>(others.size());
        others.push_back(filled[i]);
    }
    fill(others);
    frame = runner().begin();
    sampled = samples_.import(frame);
    add_find_samples(frame, map_, map_.import(frame), samples_, sampled, frame.upload<glm::uvec2>("places", places));
    const graph::Readback counts_found = frame.read_back(sampled.counts), kept_found = frame.read_back(sampled.kept);
    run(std::move(frame));
    for (uint32_t label = 1; label < 4; ++label) {
        std::set<uint32_t> expected, found;
        for (uint32_t i = 0; i < counts[label].kept; ++i) {
            const uint32_t record = now[kept[label * gpu::kSegmentSamples + i]];
            if (record != gpu::kNoRecord) expected.insert(record);
        }
        const uint32_t left = counts_found.as<gpu::SegmentSampleCount>()[label].kept;
        for (uint32_t i = 0; i < left; ++i) found.insert(kept_found.as<uint32_t>()[label * gpu::kSegmentSamples + i]);
        EXPECT_EQ(found, expected) << label;
        EXPECT_EQ(left, expected.size()) << label;
        EXPECT_LT(left, counts[label].kept) << label;
    }
}

TEST_F(SampleRecords, NeitherTheOrderOfRecordsNorTheRunMatters) {
    std::vector<gpu::VoxelRecord> records;
    for (uint32_t i = 0; i < 3000; ++i) records.push_back(record(i, 1 + i % 2));
    const Sampled one = sample(records, 7, 8);
    std::reverse(records.begin(), records.end());
    const Sampled two = sample(records, 7, 8), three = sample(records, 7, 9), four = sample(records, 6, 8);
    EXPECT_EQ(one.kept, two.kept);
    EXPECT_EQ(one.drawn, two.drawn);
    EXPECT_EQ(one.kept, three.kept);
    EXPECT_NE(one.drawn, three.drawn);
    EXPECT_NE(one.kept, four.kept);
}

TEST_F(SampleRecords, EveryRecordIsAsLikelyToBeKeptAndDrawn) {
    std::vector<gpu::VoxelRecord> records;
    for (uint32_t i = 0; i < 1000; ++i) records.push_back(record(i, 1));
    std::vector<uint32_t> kept(1000), drawn(1000), first(1000);
    for (uint32_t seed = 0; seed < 120; ++seed) {
        const Sampled sampled = sample(records, seed, seed + 1000);
        for (const uint32_t voxel : sampled.kept[1]) ++kept[voxel];
        for (const uint32_t voxel : sampled.drawn[1]) ++drawn[voxel];
        ++first[sampled.drawn[1].front()];
    }
    // Draws without putting back spread more evenly than independent ones: the statistic is a little small.
    EXPECT_LT(std::abs(chi_square_deviation(drawn)), 4);
    EXPECT_LT(chi_square_deviation(kept), 4);
    EXPECT_LT(std::abs(chi_square_deviation(first)), 4);
}

TEST_F(SampleRecords, MoreDrawsThanLargeSegmentsKeepAreRefused) {
    graph::FrameGraph frame = runner().begin();
    const ObservationMapIds ids = map_.import(frame);
    EXPECT_THROW(add_draw_records(frame, ids, samples_, samples_.import(frame), 129, 1), Error);
    EXPECT_THROW(add_draw_records(frame, ids, samples_, samples_.import(frame), 0, 1), Error);
}

}  // namespace
}  // namespace patina::sample_records_test
