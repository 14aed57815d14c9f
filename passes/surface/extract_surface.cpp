#include "passes/surface/extract_surface.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "engine/core/error.h"
#include "passes/surface/case_table.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr uint32_t kAttributeBytes = 3 * sizeof(glm::vec3);  // position, normal, colour

using Triangle = std::array<uint32_t, 3>;

/// A block that owns vertices or triangles, and how many come before it.
struct SurfaceBlock {
    uint32_t key = 0;
    uint32_t id = 0;
    gpu::BlockElements elements{};
    gpu::BlockElements first{};
};

/// The blocks that own something, in the order of their keys: block ids depend on how the device scheduled invocations.
std::vector<SurfaceBlock> sort_surface_blocks(const std::vector<uint32_t>& keys,
                                              const std::vector<gpu::BlockElements>& counts) {
    std::vector<SurfaceBlock> blocks;
    for (uint32_t id = 0; id < keys.size(); ++id) {
        if (counts[id].vertices + counts[id].triangles > 0) blocks.push_back({keys[id], id, counts[id], {}});
    }
    std::sort(blocks.begin(), blocks.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    uint64_t vertices = 0, triangles = 0;
    for (SurfaceBlock& block : blocks) {
        block.first = {static_cast<uint32_t>(vertices), static_cast<uint32_t>(triangles)};
        vertices += block.elements.vertices;
        triangles += block.elements.triangles;
    }
    if (std::max(vertices, triangles) > UINT32_MAX) {
        throw Error("the surface has ", vertices, " vertices and ", triangles, " triangles, at most ", UINT32_MAX,
                    " can be numbered");
    }
    return blocks;
}

/// Elements of consecutive blocks.
gpu::BlockElements total_of(std::span<const SurfaceBlock> blocks) {
    const SurfaceBlock& last = blocks.back();
    return {last.first.vertices + last.elements.vertices - blocks.front().first.vertices,
            last.first.triangles + last.elements.triangles - blocks.front().first.triangles};
}

/// How many of the first blocks stay within `limit` vertices and `limit` triangles.
size_t batch_length(std::span<const SurfaceBlock> blocks, uint32_t limit) {
    size_t length = 1;
    while (length < blocks.size()) {
        const gpu::BlockElements total = total_of(blocks.first(length + 1));
        if (std::max(total.vertices, total.triangles) > limit) break;
        ++length;
    }
    return length;
}

/// Reads `count` elements of 12 bytes, or one that append_to() leaves out: a batch can lack vertices or triangles, and
/// no copy is empty.
graph::Readback read_elements(graph::FrameGraph& frame, graph::BufferId id, uint64_t first, uint64_t count) {
    static_assert(sizeof(glm::vec3) == sizeof(Triangle));
    return frame.read_back(id, first * sizeof(Triangle), std::max<uint64_t>(count, 1) * sizeof(Triangle));
}

template <class T>
void append_to(std::vector<T>& all, const graph::Readback& part, size_t count) {
    const std::vector<T> values = part.as<T>();
    all.insert(all.end(), values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
}

/// Groups of a pass with one invocation per item, in the rows that group_item() reads.
void dispatch_items(graph::PassBuilder& pass, uint64_t items) {
    const auto groups = static_cast<uint32_t>((items + gpu::kSurfaceGroup - 1) / gpu::kSurfaceGroup);
    pass.dispatch(std::min(groups, gpu::kGroupsPerRow), (groups + gpu::kGroupsPerRow - 1) / gpu::kGroupsPerRow);
}

/// What the counting frame leaves for the frames that write; freed when the extraction ends.
struct SurfaceArrays {
    vulkan::BufferRef neighbours;        ///< kNeighbourStride u32 per block
    vulkan::BufferRef inside;            ///< kBlockWords u32 per block
    vulkan::BufferRef complete;          ///< kBlockWords u32 per block: cells whose corners have all been seen
    vulkan::BufferRef edges;             ///< kBlockEdgeWords gpu::EdgeWord per block
    vulkan::BufferRef triangle_offsets;  ///< kBlockWords u32 per block: triangles of its words before
};

/// A batch's part of the mesh, while the device writes it.
struct PendingPart {
    graph::Readback positions, normals, colors, triangles;
};

class Extraction {
  public:
    Extraction(graph::Runner& runner, const VoxelMap& map, const SurfaceOptions& options);
    Mesh run();

  private:
    uint32_t count_block_ids();
    void create_arrays();
    std::vector<SurfaceBlock> count_elements();
    PendingPart write_elements(graph::FrameGraph& frame, std::span<const SurfaceBlock> blocks,
                               std::span<const gpu::BlockElements> first);
    void append(Mesh& mesh, std::span<const SurfaceBlock> blocks, std::span<const gpu::BlockElements> first);

    gpu::SurfaceParams params(uint64_t items, gpu::BlockElements first = {}) const {
        return {map_.grid(), static_cast<uint32_t>(items), no_block_, first.vertices, first.triangles};
    }

    graph::Runner& runner_;
    const VoxelMap& map_;
    MapAccess access_;
    uint32_t batch_elements_;
    std::vector<uint32_t> cases_ = surface::packed_case_table();
    uint32_t no_block_ = 0;  ///< one more than the largest block id; the arrays have an entry of zeros for it
    SurfaceArrays arrays_;
};

uint32_t batch_limit(const vulkan::DeviceCaps& caps, const SurfaceOptions& options) {
    // Four million elements keep the device busy and the memory for their read-back small.
    const auto most = static_cast<uint32_t>(std::min<uint64_t>(caps.max_storage_range / kAttributeBytes, 1u << 22));
    const uint32_t limit = std::min(options.batch_elements.value_or(most), most);
    if (limit < kMaxBlockElements) {
        throw Error("surface extraction writes ", limit, " elements at once, a block can have ", kMaxBlockElements);
    }
    return limit;
}

Extraction::Extraction(graph::Runner& runner, const VoxelMap& map, const SurfaceOptions& options)
    : runner_(runner),
      map_(map),
      access_(options.access.value_or(preferred_map_access(runner.device().caps(), map))),
      batch_elements_(batch_limit(runner.device().caps(), options)) {}

uint32_t Extraction::count_block_ids() {
    graph::FrameGraph frame = runner_.begin();
    const graph::Readback counters = frame.read_back(map_.import(frame).counters);
    runner_.submit(std::move(frame));
    runner_.wait();
    return counters.as<gpu::MapCounters>().front().high_water;
}

void Extraction::create_arrays() {
    const auto create = [&](const char* name, uint64_t bytes_per_block) {
        return runner_.device().create_buffer({name, (no_block_ + uint64_t{1}) * bytes_per_block});
    };
    arrays_.neighbours = create("surface.neighbours", gpu::kNeighbourStride * sizeof(uint32_t));
    arrays_.inside = create("surface.inside", gpu::kBlockWords * sizeof(uint32_t));
    arrays_.complete = create("surface.complete", gpu::kBlockWords * sizeof(uint32_t));
    arrays_.edges = create("surface.edges", gpu::kBlockEdgeWords * sizeof(gpu::EdgeWord));
    arrays_.triangle_offsets = create("surface.triangle_offsets", gpu::kBlockWords * sizeof(uint32_t));
}

std::vector<SurfaceBlock> Extraction::count_elements() {
    graph::FrameGraph frame = runner_.begin();
    const VoxelMapIds ids = map_.import(frame);
    const uint64_t blocks = no_block_ + uint64_t{1};

    auto find = frame.compute("surface.find_neighbours", spirv::find_neighbours);
    find.read("Keys", ids.keys).read("Blocks", ids.blocks).read("BlockKeys", ids.block_keys).push(params(blocks));
    const graph::BufferId neighbours = find.write("Neighbours", frame.import(arrays_.neighbours));
    dispatch_items(find, blocks * gpu::kNeighbourStride);

    auto pack =
        frame.compute("surface.pack_signs", access_ == MapAccess::kTexel ? spirv::pack_signs_texel : spirv::pack_signs);
    pack.read("BlockKeys", ids.block_keys).read("Tsdf", ids.tsdf).push(params(blocks));
    pack.specialise("kVoxelChunks", map_.chunks());
    const graph::BufferId inside = pack.write("Inside", frame.import(arrays_.inside));
    const graph::BufferId seen = pack.create("Seen", blocks * gpu::kBlockWords * sizeof(uint32_t));
    dispatch_items(pack, blocks * gpu::kBlockWords);

    auto complete_cells = frame.compute("surface.complete_cells", spirv::complete_cells);
    complete_cells.read("Neighbours", neighbours).read("Seen", seen).push(params(blocks));
    const graph::BufferId complete = complete_cells.write("Complete", frame.import(arrays_.complete));
    dispatch_items(complete_cells, blocks * gpu::kBlockWords);

    auto count = frame.compute("surface.count_elements", spirv::count_elements);
    count.read("Neighbours", neighbours).read("Inside", inside).read("Complete", complete);
    count.read("Cases", frame.upload<uint32_t>("surface.cases", cases_)).push(params(blocks));
    const graph::BufferId edges = count.write("Edges", frame.import(arrays_.edges));
    const graph::BufferId offsets = count.write("TriangleOffsets", frame.import(arrays_.triangle_offsets));
    const graph::BufferId counts = count.create("Counts", blocks * sizeof(gpu::BlockElements));
    dispatch_items(count, blocks * gpu::kBlockWords);

    for (const graph::BufferId id : {neighbours, inside, complete, edges, offsets}) frame.keep(id);
    const graph::Readback read_keys = frame.read_back(ids.block_keys, 0, no_block_ * sizeof(uint32_t));
    const graph::Readback read_counts = frame.read_back(counts);
    runner_.submit(std::move(frame));
    runner_.wait();
    return sort_surface_blocks(read_keys.as<uint32_t>(), read_counts.as<gpu::BlockElements>());
}

PendingPart Extraction::write_elements(graph::FrameGraph& frame, std::span<const SurfaceBlock> blocks,
                                       std::span<const gpu::BlockElements> first) {
    const gpu::BlockElements batch_first = blocks.front().first;
    const auto [vertex_count, triangle_count] = total_of(blocks);
    std::vector<uint32_t> block_ids;
    for (const SurfaceBlock& block : blocks) block_ids.push_back(block.id);

    const VoxelMapIds ids = map_.import(frame);
    const graph::BufferId neighbours = frame.import(arrays_.neighbours), edges = frame.import(arrays_.edges);
    const graph::BufferId cases = frame.upload<uint32_t>("surface.cases", cases_);
    const graph::BufferId first_id = frame.upload("surface.first", first);

    auto list = frame.compute("surface.list_elements", spirv::list_elements);
    list.read("Neighbours", neighbours).read("Inside", frame.import(arrays_.inside));
    list.read("Complete", frame.import(arrays_.complete)).read("Cases", cases).read("Edges", edges);
    list.read("TriangleOffsets", frame.import(arrays_.triangle_offsets)).read("First", first_id);
    list.read("Batch", frame.upload<uint32_t>("surface.batch", block_ids)).push(params(blocks.size(), batch_first));
    const graph::BufferId vertices = list.create("Vertices", vertex_count * sizeof(gpu::SurfaceElement));
    const graph::BufferId triangles = list.create("Triangles", triangle_count * sizeof(gpu::SurfaceElement));
    dispatch_items(list, blocks.size() * gpu::kBlockWords);

    auto write_vertices = frame.compute(
        "surface.write_vertices", access_ == MapAccess::kTexel ? spirv::write_vertices_texel : spirv::write_vertices);
    write_vertices.read("Neighbours", neighbours).read("Vertices", vertices);
    write_vertices.read("Tsdf", ids.tsdf).specialise("kVoxelChunks", map_.chunks());
    write_vertices.read("Color", ids.color);
    const graph::BufferId attributes =
        write_vertices.push(params(vertex_count)).create("Attributes", uint64_t{vertex_count} * kAttributeBytes);
    dispatch_items(write_vertices, vertex_count);

    auto write_triangles = frame.compute("surface.write_triangles", spirv::write_triangles);
    write_triangles.read("Neighbours", neighbours).read("Cases", cases).read("Edges", edges);
    write_triangles.read("First", first_id).read("Triangles", triangles).push(params(triangle_count));
    const graph::BufferId indices = write_triangles.create("Indices", uint64_t{triangle_count} * sizeof(Triangle));
    dispatch_items(write_triangles, triangle_count);

    const uint64_t n = vertex_count;
    return {read_elements(frame, attributes, 0, n), read_elements(frame, attributes, n, n),
            read_elements(frame, attributes, 2 * n, n), read_elements(frame, indices, 0, triangle_count)};
}

void Extraction::append(Mesh& mesh, std::span<const SurfaceBlock> blocks, std::span<const gpu::BlockElements> first) {
    graph::FrameGraph frame = runner_.begin();
    const PendingPart part = write_elements(frame, blocks, first);
    runner_.submit(std::move(frame));
    runner_.wait();
    const auto [vertices, triangles] = total_of(blocks);
    append_to(mesh.positions_m, part.positions, vertices);
    append_to(mesh.normals, part.normals, vertices);
    append_to(mesh.colors, part.colors, vertices);
    append_to(mesh.triangles, part.triangles, triangles);
}

Mesh Extraction::run() {
    Mesh mesh;
    no_block_ = count_block_ids();
    if (no_block_ == 0) return mesh;
    create_arrays();
    const std::vector<SurfaceBlock> blocks = count_elements();
    std::vector<gpu::BlockElements> first(no_block_);
    for (const SurfaceBlock& block : blocks) first[block.id] = block.first;
    for (std::span<const SurfaceBlock> rest(blocks); !rest.empty();) {
        const size_t length = batch_length(rest, batch_elements_);
        append(mesh, rest.first(length), first);
        rest = rest.subspan(length);
    }
    return mesh;
}

}  // namespace

Mesh extract_surface(graph::Runner& runner, const VoxelMap& map, const SurfaceOptions& options) {
    return Extraction(runner, map, options).run();
}

}  // namespace patina
