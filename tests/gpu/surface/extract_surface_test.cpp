#include "passes/surface/extract_surface.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <tuple>

#include "engine/core/error.h"
#include "passes/state/block_keys.h"
#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/surface/marching_cubes.h"
#include "tests/reference/surface/mesh_facts.h"
#include "tests/support/same_bytes.h"

namespace patina::extract_surface_test {
namespace {

const Intrinsics kCamera{{320, 240}, 300, 300, 159.5, 119.5, {}};
constexpr double kRadiusM = 0.2;
const reference::DistanceField kSphere = reference::sphere({0, 0, 0}, kRadiusM);

using Paint = std::function<glm::vec3(glm::dvec3 point_m)>;

/// What the camera sees of a painted surface.
Image<glm::vec4> render_color(const Image<float>& depth_m, const RigidTransform& world_from_camera,
                              const Paint& paint) {
    Image<glm::vec4> color(depth_m.extent());
    for (uint32_t y = 0; y < depth_m.extent().height; ++y) {
        for (uint32_t x = 0; x < depth_m.extent().width; ++x) {
            const double z = depth_m.at(x, y);
            if (z == 0) continue;
            const glm::dvec4 point(z * (x - kCamera.cx) / kCamera.fx, z * (y - kCamera.cy) / kCamera.fy, z, 1);
            color.at(x, y) = glm::vec4(paint(glm::dvec3(world_from_camera * point)), 1);
        }
    }
    return color;
}

void fuse_from_all_sides(FusionRig& rig, const reference::DistanceField& scene, const Paint& paint = nullptr,
                         int views = 40) {
    for (const RigidTransform& pose : reference::orbit({0, 0, 0}, 1.0, views)) {
        const Image<float> depth = reference::render_depth(scene, kCamera, pose, 4.0);
        if (paint) {
            rig.fuse(kCamera, pose, depth, ColorView{kCamera, pose, render_color(depth, pose, paint)});
        } else {
            rig.fuse(kCamera, pose, depth);
        }
    }
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

using patina::same_bytes;

bool same_bytes(const Mesh& a, const Mesh& b) {
    return same_bytes(a.positions_m, b.positions_m) && same_bytes(a.normals, b.normals) &&
           same_bytes(a.colors, b.colors) && same_bytes(a.triangles, b.triangles);
}

void expect_sound(const Mesh& mesh) {
    const reference::MeshFacts facts = reference::mesh_facts(mesh.positions_m, mesh.triangles);
    EXPECT_EQ(facts.crowded_edges, 0u);
    EXPECT_EQ(facts.turned_edges, 0u);
    EXPECT_EQ(facts.unused_vertices, 0u);
    EXPECT_EQ(facts.flat_triangles, 0u);
    EXPECT_EQ(mesh.normals.size(), mesh.positions_m.size());
    EXPECT_EQ(mesh.colors.size(), mesh.positions_m.size());
    for (const glm::vec3& normal : mesh.normals) ASSERT_NEAR(glm::length(normal), 1, 1e-5);
}

void expect_close_to(const Mesh& mesh, const reference::DistanceField& scene) {
    std::vector<double> distances_m, angles_deg;
    for (size_t i = 0; i < mesh.positions_m.size(); ++i) {
        const glm::dvec3 position(mesh.positions_m[i]), normal(mesh.normals[i]);
        const glm::dvec3 expected = reference::normal_at(scene, position);
        distances_m.push_back(std::abs(scene(position)));
        angles_deg.push_back(
            glm::degrees(std::atan2(glm::length(glm::cross(normal, expected)), glm::dot(normal, expected))));
    }
    EXPECT_LE(median(distances_m), 0.0005);
    EXPECT_LE(median(angles_deg), 2.0);
}

class ExtractSurfaceTest : public GpuTest {
  protected:
    Mesh extract(FusionRig& rig, const SurfaceOptions& options = {}) {
        Mesh mesh = extract_surface(runner(), rig.map(), options);
        const graph::CompiledFrame& last = runner().last_frame();
        EXPECT_THAT(graph::check(last.description, last.plan), ::testing::IsEmpty());
        EXPECT_THAT(graph::find_unneeded_barriers(last.description, last.plan), ::testing::IsEmpty());
        return mesh;
    }
};

TEST_F(ExtractSurfaceTest, EmptyMapHasNoSurface) {
    FusionRig rig(device(), runner());
    const Mesh mesh = extract(rig);
    EXPECT_TRUE(mesh.positions_m.empty());
    EXPECT_TRUE(mesh.triangles.empty());
}

TEST_F(ExtractSurfaceTest, SphereIsClosedWithEulerNumberTwo) {
    FusionRig rig(device(), runner());
    fuse_from_all_sides(rig, kSphere);
    const Mesh mesh = extract(rig);
    expect_sound(mesh);
    expect_close_to(mesh, kSphere);
    const reference::MeshFacts facts = reference::mesh_facts(mesh.positions_m, mesh.triangles);
    EXPECT_TRUE(facts.closed());
    EXPECT_EQ(facts.euler_number, 2);
    const double area_m2 = 4 * M_PI * kRadiusM * kRadiusM;
    EXPECT_NEAR(facts.area_m2, area_m2, 0.01 * area_m2);
    EXPECT_NEAR(facts.volume_m3, area_m2 * kRadiusM / 3, 0.01 * area_m2 * kRadiusM / 3);
}

TEST_F(ExtractSurfaceTest, BoxIsClosedWithEulerNumberTwo) {
    const glm::dvec3 half_m(0.1, 0.15, 0.2);
    const reference::DistanceField box = reference::box({0.013, -0.007, 0.021}, half_m);
    FusionRig rig(device(), runner());
    fuse_from_all_sides(rig, box);
    const Mesh mesh = extract(rig);
    expect_sound(mesh);
    expect_close_to(mesh, box);
    // Behind the edges the views contradict each other, which can leave crumbs inside the box.
    const auto largest = reference::largest_component(mesh.triangles);
    EXPECT_GT(largest.size() + 20, mesh.triangles.size());
    const reference::MeshFacts facts = reference::mesh_facts(mesh.positions_m, largest);
    EXPECT_TRUE(facts.closed());
    EXPECT_EQ(facts.euler_number, 2);
    const double volume_m3 = 8 * half_m.x * half_m.y * half_m.z;
    EXPECT_NEAR(facts.volume_m3, volume_m3, 0.01 * volume_m3);
}

TEST_F(ExtractSurfaceTest, VerticesCarryTheColorOfTheirPlace) {
    const glm::vec3 left(0.8f, 0.1f, 0.05f), right(0.1f, 0.4f, 1.5f);
    FusionRig rig(device(), runner());
    fuse_from_all_sides(rig, kSphere, [&](glm::dvec3 point_m) { return point_m.x < 0 ? left : right; });
    const Mesh mesh = extract(rig);
    const float mixed_m = 2 * rig.map().settings().voxel_m;
    size_t left_count = 0, right_count = 0, wrong = 0;
    for (size_t i = 0; i < mesh.positions_m.size(); ++i) {
        const float x = mesh.positions_m[i].x;
        if (std::abs(x) < mixed_m) continue;
        ++(x < 0 ? left_count : right_count);
        wrong += glm::length(mesh.colors[i] - (x < 0 ? left : right)) > 0.01f;
    }
    EXPECT_GT(left_count, mesh.positions_m.size() / 3);
    EXPECT_GT(right_count, mesh.positions_m.size() / 3);
    // Where views graze the sphere, voxels beside the surface take the colour from some voxels further.
    EXPECT_LT(wrong, mesh.positions_m.size() / 25);
}

TEST_F(ExtractSurfaceTest, WithoutColorVerticesAreBlack) {
    FusionRig rig(device(), runner());
    fuse_from_all_sides(rig, kSphere, nullptr, 3);
    const Mesh mesh = extract(rig);
    ASSERT_FALSE(mesh.colors.empty());
    for (const glm::vec3& color : mesh.colors) ASSERT_EQ(color, glm::vec3(0));
}

TEST_F(ExtractSurfaceTest, SameBytesFromTwoMapsOnEveryPathAndInSmallBatches) {
    const Paint paint = [](glm::dvec3 point_m) { return glm::vec3(point_m) + 0.5f; };
    FusionRig rig(device(), runner()), again(device(), runner());
    fuse_from_all_sides(rig, kSphere, paint, 12);
    fuse_from_all_sides(again, kSphere, paint, 12);
    const Mesh mesh = extract(rig, {{}, MapAccess::kStorage});
    EXPECT_GT(mesh.triangles.size(), 10000u);
    EXPECT_TRUE(same_bytes(mesh, extract(again, {{}, MapAccess::kStorage})));
    EXPECT_TRUE(same_bytes(mesh, extract(again)));
    EXPECT_TRUE(same_bytes(mesh, extract(rig, {kMaxBlockElements, {}})));
}

TEST_F(ExtractSurfaceTest, ABatchMustHoldABlock) {
    FusionRig rig(device(), runner());
    EXPECT_THROW(extract(rig, {kMaxBlockElements - 1, {}}), Error);
}

/// The cubes of `edge` blocks around a ball.
std::vector<SurfacePart> cubes(int edge) {
    std::vector<SurfacePart> parts;
    const int reach = 8 / edge + 1;
    for (int z = -reach; z < reach; ++z) {
        for (int y = -reach; y < reach; ++y) {
            for (int x = -reach; x < reach; ++x) {
                const glm::ivec3 low = glm::ivec3(x, y, z) * edge;
                parts.push_back({low, low + edge - 1});
            }
        }
    }
    return parts;
}

TEST_F(ExtractSurfaceTest, PartsAreTogetherTheWholeByteByByte) {
    const Paint paint = [](glm::dvec3 point_m) { return glm::vec3(point_m) + 0.5f; };
    FusionRig rig(device(), runner());
    fuse_from_all_sides(rig, kSphere, paint, 12);
    const Mesh whole = extract(rig);
    ASSERT_GT(whole.triangles.size(), 10000u);
    const gpu::VoxelGrid grid = rig.map().grid();
    for (const int edge : {5, 40}) {
        std::vector<SurfaceElements> blocks;
        for (const SurfacePart& part : cubes(edge)) {
            const auto counted = count_surface(runner(), rig.map(), part);
            blocks.insert(blocks.end(), counted.begin(), counted.end());
        }
        number_surface(blocks);
        size_t vertices = 0, triangles = 0;
        for (const SurfacePart& part : cubes(edge)) {
            const Mesh mesh = extract_surface_part(runner(), rig.map(), part, blocks);
            gpu::BlockElements at{};
            for (const SurfaceElements& block : blocks) {
                if (!part.holds(block_of_key(grid, block.key))) continue;
                for (uint32_t i = 0; i < block.own.vertices; ++i) {
                    ASSERT_EQ(mesh.positions_m[at.vertices + i], whole.positions_m[block.before.vertices + i]);
                    ASSERT_EQ(mesh.normals[at.vertices + i], whole.normals[block.before.vertices + i]);
                    ASSERT_EQ(mesh.colors[at.vertices + i], whole.colors[block.before.vertices + i]);
                }
                for (uint32_t i = 0; i < block.own.triangles; ++i)
                    ASSERT_EQ(mesh.triangles[at.triangles + i], whole.triangles[block.before.triangles + i]);
                at = {at.vertices + block.own.vertices, at.triangles + block.own.triangles};
            }
            EXPECT_EQ(mesh.positions_m.size(), at.vertices);
            EXPECT_EQ(mesh.triangles.size(), at.triangles);
            vertices += at.vertices;
            triangles += at.triangles;
        }
        EXPECT_EQ(vertices, whole.positions_m.size());
        EXPECT_EQ(triangles, whole.triangles.size());
    }
}

/// Blocks of a map in the order of their ids.
struct BlockList {
    std::vector<uint32_t> keys;
    gpu::VoxelGrid grid{};

    /// The voxel in a block's corner.
    std::array<int, 3> corner_of(size_t block) const {
        const uint32_t key = keys[block];
        return {8 * (static_cast<int>(key & 0x7ff) - 1024 + grid.origin_block.x),
                8 * (static_cast<int>(key >> 11 & 0x3ff) - 512 + grid.origin_block.y),
                8 * (static_cast<int>(key >> 21) - 1024 + grid.origin_block.z)};
    }

    /// Calls visit(block, voxel within it, its coordinates) for all voxels.
    template <class Visit>
    void for_each_voxel(const Visit& visit) const {
        for (size_t block = 0; block < keys.size(); ++block) {
            if (keys[block] == gpu::kEmptyKey) continue;
            const auto [x, y, z] = corner_of(block);
            for (int i = 0; i < 512; ++i) visit(block, i, std::array{x + (i & 7), y + (i >> 3 & 7), z + (i >> 6)});
        }
    }
};

BlockList list_blocks(FusionRig& rig) {
    graph::FrameGraph frame = rig.runner().begin();
    const graph::Readback keys = frame.read_back(rig.map().import(frame).block_keys);
    rig.runner().submit(std::move(frame));
    rig.runner().wait();
    return {keys.as<uint32_t>(), rig.map().grid()};
}

/// Replaces all distances of a map with one chunk, and returns those with a weight.
template <class VoxelAt>
reference::Lattice write_voxels(FusionRig& rig, const VoxelAt& voxel_at) {
    const BlockList blocks = list_blocks(rig);
    std::vector<uint32_t> voxels(blocks.keys.size() * gpu::kBlockVoxels);
    reference::Lattice lattice;
    blocks.for_each_voxel([&](size_t block, int i, std::array<int, 3> at) {
        const uint32_t voxel = voxel_at(at);
        voxels[block * gpu::kBlockVoxels + static_cast<size_t>(i)] = voxel;
        if (voxel >> 16) lattice[at] = static_cast<int16_t>(voxel & 0xffff) / 32767.0f;
    });
    graph::FrameGraph frame = rig.runner().begin();
    VoxelMapIds ids = rig.map().import(frame);
    ids.tsdf = frame.upload_bytes(ids.tsdf, 0, std::as_bytes(std::span(voxels)), true);
    frame.keep(ids.tsdf);
    rig.runner().submit(std::move(frame));
    return lattice;
}

/// A number in [0, 2^32) for every voxel, the same in every run.
uint32_t random_at(std::array<int, 3> at) {
    std::seed_seq seed(at.begin(), at.end());
    return std::mt19937(seed)();
}

uint32_t make_voxel(int distance, uint32_t weight) { return (static_cast<uint32_t>(distance) & 0xffff) | weight << 16; }

/// By coordinates to a hundredth of a millimetre, as devices differ in the last digits. No vertex lies between two
/// steps.
void sort_points(std::vector<glm::vec3>& points) {
    constexpr float kStep_m = 1.0f / 99730;
    const auto place = [](const glm::vec3& point) {
        const glm::vec3 steps = glm::round(point / kStep_m);
        return std::tuple(steps.x, steps.y, steps.z);
    };
    std::sort(points.begin(), points.end(),
              [&](const glm::vec3& a, const glm::vec3& b) { return place(a) < place(b); });
}

TEST_F(ExtractSurfaceTest, RandomDistancesWithHolesGiveTheVerticesOfTheDefinition) {
    // Distances that differ by quarters, so that zeros and ties are common; a voxel in sixteen was not seen.
    const auto voxel_at = [](std::array<int, 3> at) {
        const uint32_t random = random_at(at);
        return make_voxel((static_cast<int>(random & 7) - 4) * 8000, random >> 8 & 15);
    };
    FusionRig rig(device(), runner(), {0.02f, 256});
    fuse_from_all_sides(rig, kSphere, nullptr, 6);
    const reference::Lattice lattice = write_voxels(rig, voxel_at);
    const Mesh mesh = extract(rig);
    expect_sound(mesh);

    std::vector<glm::vec3> expected = reference::surface_vertices(lattice);
    for (glm::vec3& point : expected) point = (point + 0.5f) * 0.02f;
    std::vector<glm::vec3> got = mesh.positions_m;
    sort_points(expected);
    sort_points(got);
    ASSERT_EQ(got.size(), expected.size());
    for (size_t i = 0; i < got.size(); ++i) ASSERT_LT(glm::length(got[i] - expected[i]), 1e-5f) << "vertex " << i;
}

TEST_F(ExtractSurfaceTest, BlocksWithoutASurfaceGiveNone) {
    FusionRig rig(device(), runner(), {0.02f, 256});
    fuse_from_all_sides(rig, kSphere, nullptr, 1);
    for (const int distance : {-1, 1}) {
        write_voxels(rig, [&](std::array<int, 3>) { return make_voxel(distance, 1); });
        EXPECT_TRUE(extract(rig).positions_m.empty());
    }
    write_voxels(rig, [&](std::array<int, 3> at) { return make_voxel((at[0] & 1) * 2 - 1, 0); });
    EXPECT_TRUE(extract(rig).positions_m.empty());
}

TEST_F(ExtractSurfaceTest, RandomDistancesWithinFreeSpaceGiveAClosedSurface) {
    FusionRig rig(device(), runner(), {0.02f, 256});
    fuse_from_all_sides(rig, kSphere, nullptr, 6);
    const reference::Lattice seen = write_voxels(rig, [](std::array<int, 3>) { return make_voxel(1, 1); });
    const auto surrounded = [&](std::array<int, 3> at) {
        for (int i = 0; i < 27; ++i) {
            if (!seen.contains({at[0] + i % 3 - 1, at[1] + i / 3 % 3 - 1, at[2] + i / 9 - 1})) return false;
        }
        return true;
    };
    write_voxels(rig, [&](std::array<int, 3> at) {
        const int distance = static_cast<int>(random_at(at) % 20001) - 10000;
        return make_voxel(surrounded(at) ? distance : 10000, 1);
    });
    const Mesh mesh = extract(rig);
    EXPECT_GT(mesh.triangles.size(), 50000u);  // about two a cell, all cases many times
    expect_sound(mesh);
    EXPECT_TRUE(reference::mesh_facts(mesh.positions_m, mesh.triangles).closed());
}

TEST_F(ExtractSurfaceTest, SameBytesWhereverInTheChunksTheBlocksLie) {
    const Paint paint = [](glm::dvec3 point_m) { return glm::vec3(point_m) + 0.5f; };
    FusionRig small(device(), runner());
    fuse_from_all_sides(small, kSphere, paint, 6);

    // On devices with the smallest storage range, two chunks.
    FusionRig large(device(), runner(), {0.005f, 66000});
    std::vector<uint32_t> stack(large.map().capacity());
    std::iota(stack.begin(), stack.end(), 0u);  // popped from the end: the last id first, which lies in the last chunk
    gpu::MapCounters counters{};
    counters.free_blocks = counters.high_water = large.map().capacity();
    graph::FrameGraph frame = runner().begin();
    VoxelMapIds ids = large.map().import(frame);
    ids.free_list = frame.upload_bytes(ids.free_list, 0, std::as_bytes(std::span(stack)), true);
    ids.counters = frame.upload_bytes(ids.counters, 0, std::as_bytes(std::span(&counters, 1)), true);
    VoxelMap::keep(frame, ids);
    runner().submit(std::move(frame));
    fuse_from_all_sides(large, kSphere, paint, 6);

    const Mesh mesh = extract(small);
    EXPECT_GT(mesh.triangles.size(), 10000u);
    for (const MapAccess access : {MapAccess::kStorage, preferred_map_access(device().caps(), large.map())}) {
        EXPECT_TRUE(same_bytes(mesh, extract(large, {{}, access})));
    }
}

}  // namespace
}  // namespace patina::extract_surface_test
