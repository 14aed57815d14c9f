#include "reconstruction/streaming/extract_parts.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "engine/core/error.h"
#include "passes/state/block_keys.h"
#include "passes/surface/extract_surface.h"

namespace patina {

namespace {

constexpr int kLargestCube = 256, kSmallestCube = 8;  // blocks along an edge

/// How many blocks the fullest cube has, with those beside it.
uint64_t fullest_cube(const std::vector<glm::ivec3>& blocks, int edge) {
    std::map<std::array<int, 3>, uint64_t> counts;
    uint64_t most = 0;
    for (const glm::ivec3& block : blocks) {
        // Cubes that begin at most kBelow above it, and end at most kAbove below it, need it.
        const glm::ivec3 first = (block - SurfacePart::kAbove) / edge, last = (block + SurfacePart::kBelow) / edge;
        for (int z = first.z; z <= last.z; ++z) {
            for (int y = first.y; y <= last.y; ++y) {
                for (int x = first.x; x <= last.x; ++x) most = std::max(most, ++counts[{x, y, z}]);
            }
        }
    }
    return most;
}

/// Cubes that together hold all blocks, as large as the pool holds with what is beside them.
std::vector<SurfacePart> parts_of(std::vector<glm::ivec3> blocks, uint32_t capacity) {
    glm::ivec3 low = blocks.front();
    for (const glm::ivec3& block : blocks) low = glm::min(low, block);
    low -= SurfacePart::kAbove;  // so that divisions round down
    for (glm::ivec3& block : blocks) block -= low;
    int edge = kLargestCube;
    uint64_t fullest = fullest_cube(blocks, edge);
    while (fullest > capacity && edge > kSmallestCube) fullest = fullest_cube(blocks, edge /= 2);
    if (fullest > capacity)
        throw Error("the pool of voxel blocks holds ", capacity, " blocks, but a cube of the map has ", fullest,
                    " with those beside it; raise map.initial_blocks, and map.capacity_blocks where that is set");
    std::map<std::array<int, 3>, SurfacePart> parts;
    for (const glm::ivec3& block : blocks) {
        const glm::ivec3 cube = block / edge;
        parts[{cube.z, cube.y, cube.x}] = {low + cube * edge, low + (cube + 1) * edge - 1};
    }
    std::vector<SurfacePart> ordered;
    for (const auto& [cube, part] : parts) ordered.push_back(part);
    return ordered;
}

void bring(Streaming& streaming, const SurfacePart& part) {
    streaming.require(StreamRegion::box(part.low - SurfacePart::kBelow, part.high + SurfacePart::kAbove));
}

/// Puts the elements of a part, which stand in the order of keys, to their places in the mesh.
void place(Mesh& mesh, const Mesh& part, std::span<const SurfaceElements> own) {
    gpu::BlockElements read{};
    for (const SurfaceElements& block : own) {
        const auto copy = [](auto& to, const auto& from, uint32_t first, uint32_t count, uint32_t at) {
            std::copy_n(from.begin() + first, count, to.begin() + at);
        };
        copy(mesh.positions_m, part.positions_m, read.vertices, block.own.vertices, block.before.vertices);
        copy(mesh.normals, part.normals, read.vertices, block.own.vertices, block.before.vertices);
        copy(mesh.colors, part.colors, read.vertices, block.own.vertices, block.before.vertices);
        copy(mesh.triangles, part.triangles, read.triangles, block.own.triangles, block.before.triangles);
        read.vertices += block.own.vertices;
        read.triangles += block.own.triangles;
    }
}

}  // namespace

Mesh extract_surface_in_parts(graph::Runner& runner, const VoxelMap& map, Streaming& streaming) {
    const std::vector<glm::ivec3> blocks = streaming.blocks();
    if (blocks.empty()) return {};
    const std::vector<SurfacePart> parts = parts_of(blocks, map.capacity());
    std::vector<SurfaceElements> elements;
    for (const SurfacePart& part : parts) {
        bring(streaming, part);
        runner.forget_shapes();  // extraction may need their memory
        const std::vector<SurfaceElements> counted = count_surface(runner, map, part);
        elements.insert(elements.end(), counted.begin(), counted.end());
    }
    number_surface(elements);
    Mesh mesh;
    if (elements.empty()) return mesh;
    const SurfaceElements& last = elements.back();
    for (auto* vectors : {&mesh.positions_m, &mesh.normals, &mesh.colors})
        vectors->resize(last.before.vertices + size_t{last.own.vertices});
    mesh.triangles.resize(last.before.triangles + size_t{last.own.triangles});
    for (const SurfacePart& part : parts) {
        bring(streaming, part);
        runner.forget_shapes();
        std::vector<SurfaceElements> own;
        std::copy_if(elements.begin(), elements.end(), std::back_inserter(own),
                     [&](const SurfaceElements& block) { return part.holds(block_of_key(map.grid(), block.key)); });
        place(mesh, extract_surface_part(runner, map, part, elements), own);
    }
    return mesh;
}

}  // namespace patina
