#include "reconstruction/streaming/voxel_stream.h"

#include "passes/fusion/stream_blocks.h"
#include "reconstruction/streaming/upload_padded.h"
#include "reconstruction/streaming/voxel_codec.h"

namespace patina {

namespace {

constexpr BlockStream::Limits kVoxelLimits{2048, 1024};  // 12 MiB of blocks, and half of it

}  // namespace

VoxelStream::VoxelStream(graph::Runner& runner, Stages& stages, BlockStore& store)
    : BlockStream(runner, stages.geometry.map(), kVoxelLimits, store), stages_(stages) {}

BlockStream::Leaving VoxelStream::leave(graph::FrameGraph& graph, const gpu::StreamRegion& region, uint32_t most) {
    VoxelMapIds voxels = map_.import(graph);
    std::optional<LabelMapIds> labels;
    if (stages_.segmentation) labels = stages_.segmentation->labels().import(graph);
    const LeavingBlocks blocks = add_leave_blocks(graph, map_, voxels, labels ? &*labels : nullptr, region, most);
    Leaving leaving;
    leaving.counts = graph.read_back(blocks.counts, 0, gpu::kLeavingBins * sizeof(uint32_t));
    leaving.count = graph.read_back(blocks.count);
    leaving.blocks = graph.read_back(blocks.blocks);
    leaving.words = {graph.read_back(blocks.tsdf), graph.read_back(blocks.color)};
    if (labels) leaving.words.push_back(graph.read_back(blocks.labels));
    return leaving;
}

uint32_t VoxelStream::keep_left(const Leaving& leaving) {
    const auto count = elements<uint32_t>(leaving.count).front();
    const auto blocks = elements<gpu::StreamedBlock>(leaving.blocks);
    const auto words = [&](size_t array, size_t block) {
        if (array >= leaving.words.size()) return std::span<const uint32_t>();
        return elements<uint32_t>(leaving.words[array]).subspan(block * gpu::kBlockVoxels, gpu::kBlockVoxels);
    };
    for (uint32_t i = 0; i < count; ++i) {
        store_.put(blocks[i].key, pack_voxels(packer_, blocks[i].label_stamp, {words(0, i), words(1, i), words(2, i)}));
    }
    return count;
}

graph::BufferId VoxelStream::bring_back(graph::FrameGraph& graph, std::span<const uint32_t> keys) {
    const bool labelled = stages_.segmentation.has_value();
    std::vector<gpu::StreamedBlock> blocks;
    std::vector<uint32_t> tsdf(keys.size() * gpu::kBlockVoxels), color(tsdf.size()), words(labelled ? tsdf.size() : 0);
    const auto part = [](std::vector<uint32_t>& all, size_t i) {
        return all.empty() ? std::span<uint32_t>() : std::span(all).subspan(i * gpu::kBlockVoxels, gpu::kBlockVoxels);
    };
    for (size_t i = 0; i < keys.size(); ++i) {
        unpack_voxels(packer_, store_, keys[i], {part(tsdf, i), part(color, i), part(words, i)});
        blocks.push_back({keys[i], gpu::kNoBlock, 0, store_.at(keys[i]).label_stamp, 0, 0});
    }
    const uint32_t size = padded(keys.size());
    ReturningBlocks list;
    list.count = static_cast<uint32_t>(keys.size());
    list.blocks = upload_padded(graph, "streaming.blocks", blocks, size);
    list.tsdf = upload_padded(graph, "streaming.tsdf", tsdf, uint64_t{size} * gpu::kBlockVoxels);
    list.color = upload_padded(graph, "streaming.color", color, uint64_t{size} * gpu::kBlockVoxels);
    if (labelled) list.labels = upload_padded(graph, "streaming.labels", words, uint64_t{size} * gpu::kBlockVoxels);

    VoxelMapIds voxels = map_.import(graph);
    std::optional<LabelMapIds> labels;
    if (labelled) labels = stages_.segmentation->labels().import(graph);
    return add_return_blocks(graph, map_, voxels, labels ? &*labels : nullptr, list);
}

void VoxelStream::keep(graph::FrameGraph& graph) {
    VoxelMap::keep(graph, map_.import(graph));
    if (stages_.segmentation) LabelMap::keep(graph, stages_.segmentation->labels().import(graph));
}

bool VoxelStream::has_room(std::span<const uint32_t> keys) {
    graph::FrameGraph graph = runner_.begin();
    const graph::Readback counters = graph.read_back(map_.import(graph).counters);
    runner_.submit(std::move(graph));
    runner_.wait();
    return counters.as<gpu::MapCounters>().front().free_blocks >= keys.size();
}

}  // namespace patina
