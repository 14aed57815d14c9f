#include "passes/surface/extract_surface.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "engine/core/error.h"
#include "passes/state/block_keys.h"
#include "passes/surface/case_table.h"
#include "spirv/shaders.h"

namespace patina {

namespace {

constexpr uint32_t kAttributeBytes = 3 * sizeof(glm::vec3);  // position, normal, colour

using Triangle = std::array<uint32_t, 3>;

/// A block that owns vertices or triangles, where it is on the device, and how many are written before them.
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
        if (keys[id] != gpu::kEmptyKey && counts[id].vertices + counts[id].triangles > 0)
            blocks.push_back({keys[id], id, counts[id], {}});
    }
    std::sort(blocks.begin(), blocks.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    return blocks;
}

/// Counts on from one to the next.
class Numbering {
  public:
    gpu::BlockElements next(const gpu::BlockElements& own) {
        const gpu::BlockElements first{static_cast<uint32_t>(vertices_), static_cast<uint32_t>(triangles_)};
        vertices_ += own.vertices;
        triangles_ += own.triangles;
        return first;
    }
    void expect_in_range() const {
        if (std::max(vertices_, triangles_) <= UINT32_MAX) return;
        throw Error("the surface has ", vertices_, " vertices and ", triangles_, " triangles, at most ", UINT32_MAX,
                    " can be numbered");
    }

  private:
    uint64_t vertices_ = 0, triangles_ = 0;
};

void number(std::vector<SurfaceBlock>& blocks) {
    Numbering numbering;
    for (SurfaceBlock& block : blocks) block.first = numbering.next(block.elements);
    numbering.expect_in_range();
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
    /// Of the whole map, or of a part, whose blocks have these numbers in the whole mesh.
    Mesh run();
    Mesh run(const SurfacePart& part, std::span<const SurfaceElements> numbered);
    std::vector<SurfaceElements> count(const SurfacePart& part);

  private:
    uint32_t count_block_ids();
    void create_arrays();
    std::vector<SurfaceBlock> count_elements();
    std::vector<SurfaceBlock> count_blocks();
    void keep_own(std::vector<SurfaceBlock>& blocks, const SurfacePart& part) const;
    PendingPart write_elements(graph::FrameGraph& frame, std::span<const SurfaceBlock> blocks,
                               std::span<const gpu::BlockElements> in_mesh);
    void append(Mesh& mesh, std::span<const SurfaceBlock> blocks, std::span<const gpu::BlockElements> in_mesh);
    Mesh write(std::span<const SurfaceBlock> blocks, std::span<const gpu::BlockElements> in_mesh);

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

/// `in_mesh`: by block id, the elements of the whole mesh before its own.
PendingPart Extraction::write_elements(graph::FrameGraph& frame, std::span<const SurfaceBlock> blocks,
                                       std::span<const gpu::BlockElements> in_mesh) {
    const gpu::BlockElements batch_first = blocks.front().first;
    const auto [vertex_count, triangle_count] = total_of(blocks);
    std::vector<uint32_t> block_ids;
    std::vector<gpu::BlockElements> first(no_block_);
    for (const SurfaceBlock& block : blocks) {
        block_ids.push_back(block.id);
        first[block.id] = block.first;
    }

    const VoxelMapIds ids = map_.import(frame);
    const graph::BufferId neighbours = frame.import(arrays_.neighbours), edges = frame.import(arrays_.edges);
    const graph::BufferId cases = frame.upload<uint32_t>("surface.cases", cases_);

    auto list = frame.compute("surface.list_elements", spirv::list_elements);
    list.read("Neighbours", neighbours).read("Inside", frame.import(arrays_.inside));
    list.read("Complete", frame.import(arrays_.complete)).read("Cases", cases).read("Edges", edges);
    list.read("TriangleOffsets", frame.import(arrays_.triangle_offsets));
    list.read("First", frame.upload<gpu::BlockElements>("surface.first", first));
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
    write_triangles.read("First", frame.upload("surface.in_mesh", in_mesh))
        .read("Triangles", triangles)
        .push(params(triangle_count));
    const graph::BufferId indices = write_triangles.create("Indices", uint64_t{triangle_count} * sizeof(Triangle));
    dispatch_items(write_triangles, triangle_count);

    const uint64_t n = vertex_count;
    return {read_elements(frame, attributes, 0, n), read_elements(frame, attributes, n, n),
            read_elements(frame, attributes, 2 * n, n), read_elements(frame, indices, 0, triangle_count)};
}

void Extraction::append(Mesh& mesh, std::span<const SurfaceBlock> blocks, std::span<const gpu::BlockElements> in_mesh) {
    graph::FrameGraph frame = runner_.begin();
    const PendingPart part = write_elements(frame, blocks, in_mesh);
    runner_.submit(std::move(frame));
    runner_.wait();
    const auto [vertices, triangles] = total_of(blocks);
    append_to(mesh.positions_m, part.positions, vertices);
    append_to(mesh.normals, part.normals, vertices);
    append_to(mesh.colors, part.colors, vertices);
    append_to(mesh.triangles, part.triangles, triangles);
}

/// Those that own something, of all that the device has.
std::vector<SurfaceBlock> Extraction::count_blocks() {
    no_block_ = count_block_ids();
    if (no_block_ == 0) return {};
    create_arrays();
    return count_elements();
}

void Extraction::keep_own(std::vector<SurfaceBlock>& blocks, const SurfacePart& part) const {
    std::erase_if(blocks, [&](const SurfaceBlock& block) { return !part.holds(block_of_key(map_.grid(), block.key)); });
}

Mesh Extraction::write(std::span<const SurfaceBlock> blocks, std::span<const gpu::BlockElements> in_mesh) {
    Mesh mesh;
    while (!blocks.empty()) {
        const size_t length = batch_length(blocks, batch_elements_);
        append(mesh, blocks.first(length), in_mesh);
        blocks = blocks.subspan(length);
    }
    return mesh;
}

Mesh Extraction::run() {
    std::vector<SurfaceBlock> blocks = count_blocks();
    number(blocks);
    std::vector<gpu::BlockElements> in_mesh(no_block_);
    for (const SurfaceBlock& block : blocks) in_mesh[block.id] = block.first;
    return write(blocks, in_mesh);
}

std::vector<SurfaceElements> Extraction::count(const SurfacePart& part) {
    std::vector<SurfaceBlock> blocks = count_blocks();
    keep_own(blocks, part);
    std::vector<SurfaceElements> counted;
    for (const SurfaceBlock& block : blocks) counted.push_back({block.key, block.elements, {}});
    return counted;
}

Mesh Extraction::run(const SurfacePart& part, std::span<const SurfaceElements> numbered) {
    std::vector<SurfaceBlock> blocks = count_blocks();
    std::vector<gpu::BlockElements> in_mesh(no_block_);
    auto at = numbered.begin();
    for (const SurfaceBlock& block : blocks) {
        at = std::lower_bound(at, numbered.end(), block.key, [](const auto& a, uint32_t key) { return a.key < key; });
        if (at != numbered.end() && at->key == block.key) in_mesh[block.id] = at->before;
    }
    keep_own(blocks, part);
    number(blocks);
    return write(blocks, in_mesh);
}

}  // namespace

Mesh extract_surface(graph::Runner& runner, const VoxelMap& map, const SurfaceOptions& options) {
    return Extraction(runner, map, options).run();
}

std::vector<SurfaceElements> count_surface(graph::Runner& runner, const VoxelMap& map, const SurfacePart& part) {
    return Extraction(runner, map, {}).count(part);
}

void number_surface(std::vector<SurfaceElements>& blocks) {
    std::sort(blocks.begin(), blocks.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    Numbering numbering;
    for (SurfaceElements& block : blocks) block.before = numbering.next(block.own);
    numbering.expect_in_range();
}

Mesh extract_surface_part(graph::Runner& runner, const VoxelMap& map, const SurfacePart& part,
                          std::span<const SurfaceElements> numbered) {
    return Extraction(runner, map, {}).run(part, numbered);
}

}  // namespace patina
