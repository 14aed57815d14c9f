#include "tests/gpu/observation/entered_records.h"

#include <map>

#include "engine/core/error.h"
#include "shared/test/test_voxel_map.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

/// The slots of the table that keys are in from now on, by key.
std::vector<uint32_t> insert_keys(graph::Runner& runner, const ObservationMap& map, const std::vector<uint32_t>& keys) {
    graph::FrameGraph frame = runner.begin();
    ObservationMapIds ids = map.import(frame);
    auto insert = frame.compute("test.insert_keys", spirv::test_insert_keys);
    insert.read("List", frame.upload<uint32_t>("list", keys));
    ids.keys = insert.modify("Keys", ids.keys);
    const auto out = insert.create("Insertions", keys.size() * sizeof(glm::uvec2));
    insert.push(gpu::TestMapParams{map.grid(), static_cast<uint32_t>(keys.size()), 0, 0, 0});
    insert.dispatch_covering(static_cast<uint32_t>(keys.size()));
    frame.keep(ids.keys);
    const graph::Readback insertions = frame.read_back(out);
    runner.submit(std::move(frame));
    runner.wait();
    std::vector<uint32_t> slots;
    for (const glm::uvec2& insertion : insertions.as<glm::uvec2>()) slots.push_back(insertion.x);
    return slots;
}

}  // namespace

void enter_records(graph::Runner& runner, const ObservationMap& map, const std::vector<FilledRecord>& records) {
    std::map<uint32_t, uint32_t> block_of_key;
    for (const FilledRecord& record : records)
        block_of_key.try_emplace(place_of(map, record).block_key, static_cast<uint32_t>(block_of_key.size()));
    const uint32_t capacity = map.capacity_blocks();
    if (block_of_key.size() > capacity)
        throw Error(block_of_key.size(), " blocks of records, the map holds ", capacity);
    std::vector<uint32_t> keys;
    for (const auto& [key, block] : block_of_key) keys.push_back(key);
    const std::vector<uint32_t> slots = insert_keys(runner, map, keys);

    const uint32_t shift = 3 * map.edge_shift();
    std::vector<uint32_t> blocks((map.grid().bucket_mask + 1) * gpu::kBucketSlots, gpu::kNoBlock);
    std::vector<uint32_t> table(size_t{capacity} << shift, gpu::kNoRecord);
    for (size_t i = 0; i < keys.size(); ++i) blocks[slots[i]] = block_of_key.at(keys[i]);
    for (uint32_t i = 0; i < records.size(); ++i) {
        const FilledPlace place = place_of(map, records[i]);
        table[block_of_key.at(place.block_key) << shift | place.voxel] = i;
    }
    graph::FrameGraph frame = runner.begin();
    const ObservationMapIds ids = map.import(frame);
    frame.keep(frame.upload_bytes(ids.blocks, 0, std::as_bytes(std::span(blocks)), true));
    frame.keep(frame.upload_bytes(ids.record_table, 0, std::as_bytes(std::span(table)), true));
    runner.submit(std::move(frame));
    runner.wait();
}

}  // namespace patina
