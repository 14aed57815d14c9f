#include "reconstruction/streaming/surface_cells.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <span>

#include "engine/core/error.h"
#include "engine/core/used_vertices.h"
#include "passes/state/block_keys.h"

namespace patina {

namespace {

constexpr int kSmallestCube = 8;  // blocks along an edge

// A cell's triangles reach into the blocks that follow it along each axis.
constexpr int kBorder = 1;

/// Blocks along one axis, from 0 on: cells, each of which is divided into cubes.
struct Division {
    int cell, cube;

    int per_cell() const { return (cell + cube - 1) / cube; }
    int cube_of(int block) const { return block / cell * per_cell() + block % cell / cube; }
    int low(int index) const { return index / per_cell() * cell + index % per_cell() * cube; }
    int high(int index) const { return std::min(low(index) + cube, (index / per_cell() + 1) * cell) - 1; }
};

/// Ascending in z, y, x, as keys are.
struct KeyOrder {
    bool operator()(glm::ivec3 a, glm::ivec3 b) const { return std::array{a.z, a.y, a.x} < std::array{b.z, b.y, b.x}; }
};

template <class Function>
glm::ivec3 each_axis(glm::ivec3 v, Function&& f) {
    return {f(v.x), f(v.y), f(v.z)};
}

/// How many blocks the fullest cube needs, with those beside it. Blocks from 0 on.
uint64_t fullest_cube(const std::vector<glm::ivec3>& blocks, Division division) {
    std::map<glm::ivec3, uint64_t, KeyOrder> counts;
    uint64_t most = 0;
    const auto cube_of = [&](int block) { return division.cube_of(std::max(block, 0)); };
    for (const glm::ivec3& block : blocks) {
        const glm::ivec3 first = each_axis(block - SurfacePart::kAbove - kBorder, cube_of);
        const glm::ivec3 last = each_axis(block + SurfacePart::kBelow, cube_of);
        for (int z = first.z; z <= last.z; ++z) {
            for (int y = first.y; y <= last.y; ++y) {
                for (int x = first.x; x <= last.x; ++x) most = std::max(most, ++counts[{x, y, z}]);
            }
        }
    }
    return most;
}

/// Puts the elements of a cube, which stand in the order of keys, to their places in a cell's mesh.
void place(Mesh& mesh, const Mesh& cube, std::span<const SurfaceElements> own) {
    gpu::BlockElements read{};
    for (const SurfaceElements& block : own) {
        const auto copy = [](auto& to, const auto& from, uint32_t first, uint32_t count, uint32_t at) {
            std::copy_n(from.begin() + first, count, to.begin() + at);
        };
        copy(mesh.positions_m, cube.positions_m, read.vertices, block.own.vertices, block.before.vertices);
        copy(mesh.normals, cube.normals, read.vertices, block.own.vertices, block.before.vertices);
        copy(mesh.colors, cube.colors, read.vertices, block.own.vertices, block.before.vertices);
        copy(mesh.triangles, cube.triangles, read.triangles, block.own.triangles, block.before.triangles);
        read.vertices += block.own.vertices;
        read.triangles += block.own.triangles;
    }
}

Mesh sized(const SurfaceElements& last) {
    Mesh mesh;
    for (auto* vectors : {&mesh.positions_m, &mesh.normals, &mesh.colors})
        vectors->resize(last.before.vertices + size_t{last.own.vertices});
    mesh.triangles.resize(last.before.triangles + size_t{last.own.triangles});
    return mesh;
}

/// Keeps the triangles of some blocks, in their order, and the vertices of these.
void keep_triangles(Mesh& mesh, std::span<const SurfaceElements> blocks) {
    auto end = mesh.triangles.begin();
    for (const SurfaceElements& block : blocks) {
        const auto first = mesh.triangles.begin() + block.before.triangles;
        end = std::copy(first, first + block.own.triangles, end);
    }
    mesh.triangles.erase(end, mesh.triangles.end());

    const std::vector<uint32_t> used = number_used(mesh.triangles, mesh.positions_m.size());
    for (auto* vectors : {&mesh.positions_m, &mesh.normals, &mesh.colors}) {
        for (size_t i = 0; i < used.size(); ++i) (*vectors)[i] = (*vectors)[used[i]];
        vectors->resize(used.size());
    }
}

}  // namespace

SurfaceCells::SurfaceCells(graph::Runner& runner, const VoxelMap& map, Streaming& streaming,
                           std::optional<double> edge_m)
    : runner_(runner), map_(map), streaming_(streaming) {
    std::vector<glm::ivec3> blocks = streaming.blocks();
    if (blocks.empty()) return;
    low_ = blocks.front();
    glm::ivec3 high = low_;
    for (const glm::ivec3& block : blocks) {
        low_ = glm::min(low_, block);
        high = glm::max(high, block);
    }
    for (glm::ivec3& block : blocks) block -= low_;
    const glm::ivec3 extent = high - low_ + 1;
    cell_ = std::max({extent.x, extent.y, extent.z});
    const double block_m = double{map.grid().voxel_m} * gpu::kBlockEdge;
    if (edge_m) cell_ = std::clamp(static_cast<int>(std::lround(*edge_m / block_m)), 1, cell_);

    any_away_ = streaming.any_blocks_away();
    std::set<glm::ivec3, KeyOrder> cells;
    for (const glm::ivec3& block : blocks) cells.insert(block / cell_);
    cells_.assign(cells.begin(), cells.end());
    cube_ = cell_;
    if (any_away_) choose_cubes(blocks, map.capacity());
    if (any_away_ || cells_.size() > 1) count(blocks);
}

/// As large as the pool holds with what is beside them.
void SurfaceCells::choose_cubes(const std::vector<glm::ivec3>& blocks, uint64_t most_blocks) {
    uint64_t fullest = fullest_cube(blocks, {cell_, cube_});
    while (fullest > most_blocks && cube_ > kSmallestCube) {
        cube_ = std::max((cube_ + 1) / 2, kSmallestCube);
        fullest = fullest_cube(blocks, {cell_, cube_});
    }
    if (fullest > most_blocks)
        throw Error("the pool of voxel blocks holds ", most_blocks, " blocks, but a cube of the map has ", fullest,
                    " with those beside it; raise map.initial_blocks, and map.capacity_blocks where that is set");
}

/// The cubes that hold blocks. Blocks and cubes from 0 on.
std::vector<SurfacePart> SurfaceCells::cubes_of(const std::vector<glm::ivec3>& blocks) const {
    const Division division{cell_, cube_};
    std::map<glm::ivec3, SurfacePart, KeyOrder> cubes;
    for (const glm::ivec3& block : blocks) {
        const glm::ivec3 cube = each_axis(block, [&](int at) { return division.cube_of(at); });
        cubes[cube] = {each_axis(cube, [&](int index) { return division.low(index); }),
                       each_axis(cube, [&](int index) { return division.high(index); })};
    }
    std::vector<SurfacePart> all;
    for (const auto& [index, cube] : cubes) all.push_back(cube);
    return all;
}

void SurfaceCells::bring(const SurfacePart& cube) {
    if (any_away_)
        streaming_.require_blocks(StreamRegion::box(cube.low - SurfacePart::kBelow, cube.high + SurfacePart::kAbove));
    runner_.forget_shapes();  // extraction may need their memory
}

void SurfaceCells::count(const std::vector<glm::ivec3>& blocks) {
    const std::vector<SurfacePart> cubes =
        any_away_ ? cubes_of(blocks) : std::vector{SurfacePart{glm::ivec3(0), glm::ivec3(INT_MAX / 2)}};
    for (SurfacePart cube : cubes) {
        cube = {cube.low + low_, cube.high + low_};
        bring(cube);
        const std::vector<SurfaceElements> counted = count_surface(runner_, map_, cube);
        elements_.insert(elements_.end(), counted.begin(), counted.end());
    }
}

Mesh SurfaceCells::extract(size_t cell) {
    if (!any_away_ && cells_.size() == 1) {
        runner_.forget_shapes();
        return extract_surface(runner_, map_);
    }
    const SurfacePart own{low_ + cells_.at(cell) * cell_, low_ + (cells_.at(cell) + 1) * cell_ - 1};
    const SurfacePart with_border{own.low, own.high + kBorder};
    // Of the cell and its border, in the order of keys.
    std::vector<SurfaceElements> elements;
    std::copy_if(elements_.begin(), elements_.end(), std::back_inserter(elements),
                 [&](const SurfaceElements& block) { return with_border.holds(block_of_key(map_.grid(), block.key)); });
    if (elements.empty()) return {};
    number_surface(elements);

    Mesh mesh = sized(elements.back());
    std::vector<glm::ivec3> within;
    for (const SurfaceElements& block : elements)
        within.push_back(glm::min(block_of_key(map_.grid(), block.key), own.high) - low_);
    for (SurfacePart cube : cubes_of(within)) {
        // The last ones of a cell take its border along.
        cube = {cube.low + low_, cube.high + low_};
        for (int axis = 0; axis < 3; ++axis) cube.high[axis] += cube.high[axis] == own.high[axis] ? kBorder : 0;
        bring(cube);
        std::vector<SurfaceElements> in_cube;
        std::copy_if(elements.begin(), elements.end(), std::back_inserter(in_cube),
                     [&](const SurfaceElements& block) { return cube.holds(block_of_key(map_.grid(), block.key)); });
        place(mesh, extract_surface_part(runner_, map_, cube, elements), in_cube);
    }
    if (cells_.size() == 1) return mesh;
    std::erase_if(elements,
                  [&](const SurfaceElements& block) { return !own.holds(block_of_key(map_.grid(), block.key)); });
    keep_triangles(mesh, elements);
    return mesh;
}

}  // namespace patina
