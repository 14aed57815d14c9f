#include "tools/bench/filled_records.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/gtc/packing.hpp>

#include "engine/core/error.h"
#include "shared/test/test_observations.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

glm::vec2 to_octahedral(glm::vec3 direction) {
    const glm::vec3 d = direction / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
    if (d.z >= 0) return glm::vec2(d);
    return {(1 - std::abs(d.y)) * (d.x >= 0 ? 1.f : -1.f), (1 - std::abs(d.x)) * (d.y >= 0 ? 1.f : -1.f)};
}

uint32_t packed(float value, float levels, uint32_t mask) {
    return static_cast<uint32_t>(static_cast<int>(std::round(value * levels))) & mask;
}

uint32_t direction_word(const FilledObservation& seen) {
    const glm::vec2 at = to_octahedral(seen.to_viewer);
    uint32_t word = packed(at.x, 4095, 0x1fff) | packed(at.y, 4095, 0x1fff) << 13;
    for (uint32_t c = 0; c < 3; ++c) word |= static_cast<uint32_t>(seen.clipped[c]) << (26 + c);
    return word;
}

glm::ivec3 voxel_of(const ObservationMap& map, const FilledRecord& record) {
    return glm::ivec3(glm::floor(record.point_m / map.settings().voxel_m));
}

/// Along the normal from the voxel's centre, in voxels.
float offset_vox(const ObservationMap& map, const FilledRecord& record) {
    const glm::vec3 center_vox = glm::vec3(voxel_of(map, record)) + 0.5f;
    return glm::dot(record.point_m / map.settings().voxel_m - center_vox, record.normal);
}

gpu::VoxelRecord packed_record(const ObservationMap& map, const FilledRecord& record) {
    const FilledPlace place = place_of(map, record);
    const glm::vec2 normal = to_octahedral(record.normal);
    gpu::VoxelRecord result{};
    result.block_key = place.block_key;
    result.normal = packed(normal.x, 32767, 0xffff) | packed(normal.y, 32767, 0xffff) << 16;
    result.state = static_cast<uint32_t>(record.observations.size()) | place.voxel << 5 | 1u << 11 |
                   packed(std::clamp(offset_vox(map, record), -1.f, 1.f), 32767, 0xffff) << 16;
    result.label = record.label | 255u << 16;
    return result;
}

}  // namespace

FilledPlace place_of(const ObservationMap& map, const FilledRecord& record) {
    const glm::ivec3 voxel = voxel_of(map, record);
    const int shift = static_cast<int>(map.edge_shift());
    const glm::uvec3 block(glm::ivec3(voxel.x >> shift, voxel.y >> shift, voxel.z >> shift) -
                           glm::ivec3(map.grid().origin_block) + glm::ivec3(1024, 512, 1024));
    const glm::uvec3 within = glm::uvec3(voxel) & ((1u << map.edge_shift()) - 1);
    return {block.x | block.y << 11 | block.z << 21,
            within.x | within.y << map.edge_shift() | within.z << 2 * map.edge_shift()};
}

glm::vec3 kept_point_m(const ObservationMap& map, const FilledRecord& record) {
    const glm::vec3 center_vox = glm::vec3(voxel_of(map, record)) + 0.5f;
    return (center_vox + record.normal * offset_vox(map, record)) * map.settings().voxel_m;
}

void add_fill_records(graph::FrameGraph& frame, const ObservationMap& map, ObservationMapIds& ids,
                      const std::vector<FilledRecord>& records) {
    constexpr size_t kWords = gpu::kRecordQuads * 4;
    std::vector<gpu::VoxelRecord> packed_records;
    std::vector<uint32_t> directions(records.size() * kWords), colors(records.size() * kWords);
    for (size_t i = 0; i < records.size(); ++i) {
        packed_records.push_back(packed_record(map, records[i]));
        for (size_t k = 0; k < records[i].observations.size(); ++k) {
            directions[i * kWords + k] = direction_word(records[i].observations[k]);
            colors[i * kWords + k] = glm::packF3x9_E1x5(records[i].observations[k].rgb);
        }
    }
    const auto count = static_cast<uint32_t>(records.size());
    auto scatter = frame.compute("test.scatter_records", spirv::test_scatter_records);
    scatter.read("GivenDirections", frame.upload<uint32_t>("given_directions", directions));
    scatter.read("GivenColors", frame.upload<uint32_t>("given_colors", colors));
    scatter.specialise("kVoxelChunks", map.chunks()).push(gpu::TestObservationParams{map.grid(), count, 0, 0, 0});
    ids.directions = scatter.modify("Directions", ids.directions);
    ids.colors = scatter.modify("Colors", ids.colors);
    scatter.dispatch_covering(count);
    ids.records = frame.upload_bytes(ids.records, 0, std::as_bytes(std::span(packed_records)), false);
}

void add_keep_records(graph::FrameGraph& frame, const SegmentSamples& samples,
                      const std::vector<std::vector<uint32_t>>& kept) {
    PATINA_ASSERT(kept.size() <= samples.labels(), kept.size(), " labels of ", samples.labels());
    std::vector<gpu::SegmentSampleCount> counts(samples.labels());
    std::vector<uint32_t> slots(size_t{samples.labels()} * gpu::kSegmentSamples, gpu::kNoRecord);
    for (size_t label = 0; label < kept.size(); ++label) {
        PATINA_ASSERT(kept[label].size() <= gpu::kSegmentSamples, kept[label].size(), " records of ", label);
        counts[label].kept = counts[label].eligible = static_cast<uint32_t>(kept[label].size());
        std::copy(kept[label].begin(), kept[label].end(),
                  slots.begin() + static_cast<ptrdiff_t>(label * gpu::kSegmentSamples));
    }
    SegmentSampleIds ids = samples.import(frame);
    ids.counts = frame.upload_bytes(ids.counts, 0, std::as_bytes(std::span(counts)), true);
    ids.kept = frame.upload_bytes(ids.kept, 0, std::as_bytes(std::span(slots)), true);
    SegmentSamples::keep(frame, ids);
}

RecordList add_list_records(graph::FrameGraph& frame, uint32_t count) {
    std::vector<uint32_t> list(1 + count);
    list[0] = count;
    std::iota(list.begin() + 1, list.end(), 0u);
    const std::vector<uint32_t> arguments{(count + gpu::kRecordGroup - 1) / gpu::kRecordGroup, 1, 1, 0};
    return {frame.upload<uint32_t>("filled", list), frame.upload<uint32_t>("filled_arguments", arguments)};
}

}  // namespace patina
