#include "passes/texture/detail_normals.h"

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "reconstruction/texture/texture_triangles.h"
#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/texture/detail.h"

namespace patina::detail_normals_test {
namespace {

using reference::PlacedTriangle;

constexpr Extent2D kPage{75, 53};  // no multiple of a tile
constexpr double kTexel_m = 0.002, kWall_m = 0.5;
constexpr double kHeight_m = 0.004, kPerM = 2 * std::numbers::pi / 0.08;  // of waves along x
const Intrinsics kCamera{{320, 240}, 300, 300, 159.5, 119.5, {}};

/// A flat quad across the view, whose places go right and down with x and y.
TextureLayout flat_page(glm::vec3 normal) {
    TextureLayout layout{kTexel_m, {kPage}, {}, {}};
    TexturedSurface& piece = layout.pieces.emplace_back();
    for (const glm::vec2 place : {glm::vec2(4, 4), glm::vec2(70, 4), glm::vec2(4, 48), glm::vec2(70, 48)}) {
        piece.mesh.positions_m.emplace_back(
            glm::dvec3(kTexel_m * (glm::dvec2(place) - glm::dvec2(37.5, 26.5)), kWall_m));
        piece.mesh.normals.push_back(normal);
        piece.mesh.colors.emplace_back(0.5f);
        piece.place_px.push_back(place);
        piece.pages.push_back(0);
        piece.tangents.emplace_back(1, 0, 0, 1);
    }
    piece.mesh.triangles = {{0, 2, 1}, {1, 2, 3}};
    return layout;
}

double waves(glm::dvec3 p) {
    return (kWall_m + kHeight_m * std::sin(kPerM * p.x) - p.z) / std::hypot(1, kHeight_m * kPerM);
}

class DetailNormalsTest : public GpuTest {
  protected:
    std::vector<uint32_t> detail_of(FusionRig& rig, const TextureLayout& layout) {
        const TextureTriangles triangles = texture_triangles(layout);
        const TileLists lists = list_tiles(triangles, 0, 0, kPage);
        graph::FrameGraph frame = runner().begin();
        PlaceTexelsInputs inputs;
        inputs.vertices = frame.upload("vertices", std::span(triangles.vertices));
        inputs.triangles = frame.upload("triangles", std::span(triangles.indices));
        inputs.tiles = frame.upload("tiles", std::span(lists.tiles));
        inputs.lists = frame.upload("lists", std::span(lists.lists));
        const graph::BufferId tangents = frame.upload("tangents", std::span(triangles.tangents));
        const graph::Readback read =
            frame.read_back(add_detail_normals(frame, rig.map(), rig.map().import(frame), inputs, tangents, kPage));
        run(std::move(frame));
        return read.as<uint32_t>();
    }
};

std::vector<PlacedTriangle> reference_triangles(const TextureLayout& layout) {
    std::vector<PlacedTriangle> triangles;
    const TexturedSurface& piece = layout.pieces.front();
    for (const auto& indices : piece.mesh.triangles) {
        PlacedTriangle& triangle = triangles.emplace_back();
        for (size_t i = 0; i < 3; ++i) {
            triangle.positions_m[i] = piece.mesh.positions_m[indices[i]];
            triangle.normals[i] = piece.mesh.normals[indices[i]];
            triangle.places_px[i] = piece.place_px[indices[i]];
        }
    }
    return triangles;
}

/// What a flat mesh has lost of a wavy wall: x is the slope of the waves, y nothing.
TEST_F(DetailNormalsTest, AFlatMeshGetsTheSlopesOfAWavyWall) {
    FusionRig rig(device(), runner());
    rig.fuse(kCamera, RigidTransform(1), reference::render_depth(waves, kCamera, RigidTransform(1), 2));
    const TextureLayout layout = flat_page({0, 0, -1});
    const std::vector<uint32_t> words = detail_of(rig, layout);
    const std::vector<PlacedTriangle> triangles = reference_triangles(layout);
    const reference::Volume volume = rig.volume();
    double largest = 0;
    for (uint32_t row = 0; row < kPage.height; ++row) {
        for (uint32_t column = 0; column < kPage.width; ++column) {
            const uint32_t word = words[size_t{row} * kPage.width + column];
            const auto texel = reference::place_texel(triangles, column, row);
            ASSERT_EQ(word != gpu::kNoSurface, texel.has_value()) << column << ", " << row;
            if (!texel) continue;
            const glm::vec3 got = unpack_detail(word);
            const glm::dvec3 expected = reference::detail_normal(volume, *texel, {1, 0, 0, 1});
            // Floats of positions of half a metre, in voxels of 5 mm, and 16 bits of a word.
            EXPECT_LT(glm::distance(glm::dvec3(got), expected), 2e-3) << column << ", " << row;
            const double slope = kHeight_m * kPerM * std::cos(kPerM * texel->position_m.x);
            // Differences over two voxels of 5 mm flatten waves of 8 cm by some percent.
            EXPECT_NEAR(got.x, slope / std::hypot(1, slope), 0.06) << column << ", " << row;
            EXPECT_NEAR(got.y, 0, 0.03);
            largest = std::max(largest, double{got.x});
        }
    }
    EXPECT_GT(largest, 0.25) << "of 0.30";
}

TEST_F(DetailNormalsTest, WhatIsNotKnownIsFlat) {
    FusionRig rig(device(), runner());
    for (const uint32_t word : detail_of(rig, flat_page({0, 0, -1}))) EXPECT_TRUE(word == 0 || word == gpu::kNoSurface);
    rig.fuse(kCamera, RigidTransform(1), reference::render_depth(waves, kCamera, RigidTransform(1), 2));
    for (const uint32_t word : detail_of(rig, flat_page({0, 0, 1})))
        EXPECT_TRUE(word == 0 || word == gpu::kNoSurface) << "the mesh is the back of something";
}

}  // namespace
}  // namespace patina::detail_normals_test
