#include <random>

#include "passes/state/observation_map.h"
#include "passes/state/record_list.h"
#include "shared/test/test_observations.h"
#include "spirv/shaders.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/observation/observation_set.h"

namespace patina::insert_observation_test {
namespace {

/// A random word that stands for a direction of its own (not one on the rim of the octahedron's unfolded square), which
/// no device rounds otherwise.
uint32_t random_word(std::mt19937& random) {
    std::uniform_int_distribution<int> inner(-4094, 4094);
    for (;;) {
        const uint32_t word =
            (static_cast<uint32_t>(inner(random)) & 8191) | (static_cast<uint32_t>(inner(random)) & 8191) << 13;
        bool clear = false;
        reference::on_grid(reference::unpack_direction(word), &clear);
        if (clear) return word;
    }
}

class InsertObservationTest : public GpuTest {
  protected:
    /// What each of `records` streams leaves in its record: the directions kept, by slot.
    std::vector<std::vector<uint32_t>> insert_on_gpu(const std::vector<uint32_t>& words, uint32_t records,
                                                     float merge_distance2) {
        ObservationMapSettings settings;
        settings.capacity_blocks = 64;
        settings.capacity_records = records;
        settings.max_chunk_bytes = uint64_t{1} << 15;  // 256 records a chunk
        const ObservationMap map(device(), settings);
        const auto steps = static_cast<uint32_t>(words.size() / records);
        const auto counts = device().create_buffer({"counts", records * 4});
        {
            graph::FrameGraph frame = runner().begin();
            frame.keep(frame.fill(frame.import(counts), 0));
            run(std::move(frame));
        }
        for (uint32_t step = 0; step < steps; ++step) {
            graph::FrameGraph frame = runner().begin();
            const auto streams = frame.upload<uint32_t>("streams", words);
            ObservationMapIds ids = map.import(frame);
            RecordList stale = create_record_list(frame, "stale", records);
            const gpu::TestObservationParams params{map.grid(), records, step, merge_distance2, 0};
            auto insert = frame.compute("test.insert", spirv::test_insert_observations);
            insert.read("Streams", streams).push(params).specialise("kVoxelChunks", map.chunks());
            const auto next_counts = insert.modify("Counts", frame.import(counts));
            stale.list = insert.modify("Stale", stale.list);
            stale.arguments = insert.modify("StaleArguments", stale.arguments);
            ids.directions = insert.modify("Directions", ids.directions);
            ids.colors = insert.modify("Colors", ids.colors);
            insert.dispatch_covering(records);
            auto closest = frame.compute("test.closest", spirv::find_closest_pair);
            closest.read("Stale", stale.list).push(map.grid()).specialise("kVoxelChunks", map.chunks());
            ids.directions = closest.modify("Directions", ids.directions);
            closest.dispatch_indirect(stale.arguments);
            for (const graph::BufferId id : {next_counts, ids.directions, ids.colors}) frame.keep(id);
            runner().submit(std::move(frame));
        }
        return read(map, counts, records);
    }

  private:
    std::vector<std::vector<uint32_t>> read(const ObservationMap& map, const vulkan::BufferRef& counts,
                                            uint32_t records) {
        graph::FrameGraph frame = runner().begin();
        const ObservationMapIds ids = map.import(frame);
        auto gather = frame.compute("test.gather_records", spirv::test_gather_records);
        gather.read("Directions", ids.directions).read("Colors", ids.colors);
        gather.specialise("kVoxelChunks", map.chunks());
        const auto directions_id = gather.create("GatheredDirections", records * gpu::kRecordQuads * 16);
        gather.create("GatheredColors", records * gpu::kRecordQuads * 16);
        gather.push(gpu::TestObservationParams{map.grid(), records, 0, 0, 0});
        gather.dispatch_covering(records);
        const graph::Readback directions_read = frame.read_back(directions_id),
                              counts_read = frame.read_back(frame.import(counts));
        run(std::move(frame));
        const auto directions = directions_read.as<uint32_t>();
        const auto count = counts_read.as<uint32_t>();
        std::vector<std::vector<uint32_t>> kept(records);
        for (uint32_t record = 0; record < records; ++record) {
            for (uint32_t i = 0; i < count[record]; ++i)
                kept[record].push_back(directions[record * 32 + i] & 0x3ffffffu);
        }
        return kept;
    }
};

TEST_F(InsertObservationTest, KeepsTheSameSetAsBruteForceOnRandomStreams) {
    constexpr uint32_t kRecords = 700, kSteps = 150;
    std::mt19937 random(7);
    std::vector<uint32_t> words(size_t{kRecords} * kSteps);
    for (uint32_t& word : words) word = random_word(random);
    const auto got = insert_on_gpu(words, kRecords, 1277);
    for (uint32_t record = 0; record < kRecords; ++record) {
        std::vector<reference::Direction> set;
        for (uint32_t step = 0; step < kSteps; ++step) {
            const glm::dvec3 direction = reference::unpack_direction(words[step * kRecords + record]);
            reference::insert(set, {reference::on_grid(direction), step}, gpu::kMaxObservations, 1277);
        }
        std::vector<uint32_t> expected;
        for (const reference::Direction& d : set) expected.push_back(words[d.id * kRecords + record]);
        ASSERT_EQ(got[record], expected) << record;
    }
}

}  // namespace
}  // namespace patina::insert_observation_test
