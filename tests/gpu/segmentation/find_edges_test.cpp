#include "passes/segmentation/find_edges.h"

#include <cmath>

#include "engine/core/shader_camera.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/reference/scenes/analytic_scene.h"
#include "tests/reference/segmentation/frame_segments.h"

namespace patina::find_edges_test {
namespace {

const RigidTransform kHere(1.0);

/// The inverse of shaders/lib/math/octahedral.glsl, 16 bits a coordinate.
glm::dvec3 unpacked(uint32_t bits) {
    if (bits == 0) return glm::dvec3(0);
    const glm::dvec2 p = (glm::dvec2(bits & 0xffff, bits >> 16) - 32768.0) / 32767.0;
    glm::dvec3 n(p, 1 - std::abs(p.x) - std::abs(p.y));
    const double folded = std::max(-n.z, 0.0);
    n.x -= p.x >= 0 ? folded : -folded;
    n.y -= p.y >= 0 ? folded : -folded;
    return glm::normalize(n);
}

class FindEdges : public GpuTest {
  protected:
    struct Result {
        Image<glm::dvec3> normal;
        Image<float> inner_depth_m;
    };

    Result find(const Image<float>& depth_m, const EdgeSettings& settings = {}) {
        return find(depth_m, Image<uint32_t>(depth_m.extent()), settings);
    }

    /// `chroma` as shaders/lib/color/chroma.glsl packs it.
    Result find(const Image<float>& depth_m, const Image<uint32_t>& chroma, const EdgeSettings& settings = {}) {
        const Intrinsics camera = pinhole_camera(depth_m.extent());
        graph::FrameGraph frame = runner().begin();
        const auto depth = frame.upload("depth_m", {depth_m.extent(), vulkan::Format::kR32f},
                                        std::as_bytes(std::span(depth_m.pixels())));
        const auto colors =
            frame.upload("chroma", {chroma.extent(), vulkan::Format::kR32u}, std::as_bytes(std::span(chroma.pixels())));
        const auto params = make_surface_params(make_camera(camera, kHere), settings, 60);
        const graph::ImageId normal = add_fit_normals(frame, depth, params);
        const graph::Readback normals = frame.read_back(normal);
        const graph::Readback inner = frame.read_back(add_find_edges(frame, {depth, colors}, normal, params));
        run(std::move(frame));
        Image<glm::dvec3> unpacked_normals(depth_m.extent());
        const auto bits = normals.as<uint32_t>();
        for (size_t i = 0; i < bits.size(); ++i) unpacked_normals.pixels()[i] = unpacked(bits[i]);
        return {unpacked_normals, inner.image<float>()};
    }
};

/// 16 bits a coordinate, and single precision of inverse depths around 1 / m over spans of a few pixels.
constexpr double kNormalTolerance = 4e-4;

TEST_F(FindEdges, APlaneHasItsNormalUpToTheBorderAndNoEdges) {
    const Intrinsics camera = pinhole_camera({65, 33});
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2, -0.15, -1));
    const Image<float> depth_m =
        reference::render_depth(reference::half_space(normal, glm::dot(normal, {0, 0, 1.5})), camera, kHere, 6);
    const Result got = find(depth_m);
    for (size_t i = 0; i < depth_m.pixels().size(); ++i) {
        EXPECT_LT(glm::distance(got.normal.pixels()[i], normal), kNormalTolerance) << i;
        EXPECT_EQ(got.inner_depth_m.pixels()[i], depth_m.pixels()[i]) << i;
    }
}

/// Two planes that meet in the picture's middle column, one to each side, each turned by half the angle.
Image<float> crease(double turn_degrees, Extent2D extent) {
    const double half = glm::radians(turn_degrees / 2);
    Image<float> depth_m(extent);
    const Intrinsics camera = pinhole_camera(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const double u = (x - camera.cx) / camera.fx;
            // z = 1.2 - tan(half) |X|: positive angles are concave.
            depth_m.at(x, y) = static_cast<float>(1.2 / (1 + std::tan(half) * std::abs(u)));
        }
    }
    return depth_m;
}

TEST_F(FindEdges, ConcaveCreasesAreEdgesAndConvexOnesAreNot) {
    const Extent2D extent{320, 20};
    for (const auto& [turn, expected] : {std::pair(60.0, true), {30.0, true}, {10.0, false}, {-60.0, false}}) {
        EdgeSettings settings;
        settings.noise = {0, 0};
        const Result got = find(crease(turn, extent), settings);
        for (uint32_t y = 0; y < extent.height; ++y) {
            EXPECT_EQ(got.inner_depth_m.at(156, y) < 0, expected) << turn;  // the camera's centre is at 156.8
            for (const uint32_t x : {0u, 100u, 149u, 164u, 319u}) EXPECT_GT(got.inner_depth_m.at(x, y), 0) << turn;
        }
    }
}

TEST_F(FindEdges, NoiseWidensTheAngle) {
    EdgeSettings noisy;
    noisy.noise = {0.1f, 0};
    EXPECT_LT(find(crease(60, {320, 20})).inner_depth_m.at(156, 10), 0);
    EXPECT_GT(find(crease(60, {320, 20}), noisy).inner_depth_m.at(156, 10), 0);
}

/// A picture of two halves.
template <class Pixel>
Image<Pixel> halves(Extent2D extent, Pixel left, Pixel right) {
    Image<Pixel> image(extent, left);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = extent.width / 2; x < extent.width; ++x) image.at(x, y) = right;
    }
    return image;
}

TEST_F(FindEdges, AStepBetweenParallelSurfacesIsAnEdge) {
    for (const auto& [height_m, expected] : {std::pair(0.012f, true), {0.002f, false}}) {
        const Result got = find(halves({320, 20}, 1.2f, 1.2f - height_m));
        for (uint32_t y = 0; y < 20; ++y) {
            EXPECT_EQ(got.inner_depth_m.at(159, y) < 0 || got.inner_depth_m.at(160, y) < 0, expected) << height_m;
            for (const uint32_t x : {0u, 148u, 171u, 319u}) EXPECT_GT(got.inner_depth_m.at(x, y), 0) << height_m;
        }
    }
}

uint32_t packed_chroma(double r, double g, uint32_t light) {
    return static_cast<uint32_t>(r * 4095) | static_cast<uint32_t>(g * 4095) << 12 | light << 24;
}

TEST_F(FindEdges, AChangeOfColourIsAnEdgeWhereThereIsLightEnoughToTell) {
    const Image<float> depth_m({320, 20}, 1.2f);
    for (const auto& [change, light, expected] :
         {std::tuple(0.15, 128u, true), {0.03, 128u, false}, {0.15, 30u, false}, {0.15, 0u, false}}) {
        const uint32_t left = packed_chroma(0.5, 0.3, light), right = packed_chroma(0.5 - change, 0.3, light);
        const Result got = find(depth_m, halves(depth_m.extent(), left, right));
        for (uint32_t x = 0; x < 320; ++x)
            EXPECT_EQ(got.inner_depth_m.at(x, 9) < 0, expected && x >= 158 && x < 162) << change << ' ' << light;
    }
}

TEST_F(FindEdges, OverAConvexFoldOnlyAnotherHueIsAnEdge) {
    const Extent2D extent{320, 20};
    const uint32_t strong = packed_chroma(0.6, 0.2, 128), pale = packed_chroma(0.48, 0.26, 128),
                   other = packed_chroma(0.45, 0.4, 128);
    for (const auto& [turn, right, expected] :
         {std::tuple(0.0, pale, true), {-60.0, pale, false}, {-60.0, other, true}}) {
        const Result got = find(crease(turn, extent), halves(extent, strong, right));
        EXPECT_EQ(got.inner_depth_m.at(159, 9) < 0, expected) << turn;
    }
}

TEST_F(FindEdges, NormalsDoNotReachAcrossAJump) {
    Image<float> depth_m = halves({40, 20}, 1.0f, 3.0f);
    depth_m.at(5, 5) = 0;
    const Result got = find(depth_m);
    for (size_t i = 0; i < depth_m.pixels().size(); ++i) {
        const bool known = depth_m.pixels()[i] > 0;
        EXPECT_LT(glm::distance(got.normal.pixels()[i], known ? glm::dvec3(0, 0, -1) : glm::dvec3(0)),
                  kNormalTolerance);
        EXPECT_EQ(got.inner_depth_m.pixels()[i], depth_m.pixels()[i]);
    }
}

TEST_F(FindEdges, AgreeWithTheReference) {
    for (const Extent2D extent : kPictureExtents) {
        const Image<float> depth_m = random_depth(extent, 21);
        const Intrinsics camera = pinhole_camera(extent);
        const Result got = find(depth_m);
        const auto normal = reference::fit_normals(depth_m, camera);
        const auto edge = reference::find_edges(depth_m, normal, camera);
        size_t different = 0, edges = 0;
        for (size_t i = 0; i < extent.area(); ++i) {
            ASSERT_LT(glm::distance(got.normal.pixels()[i], normal.pixels()[i]), 2e-3) << extent << ' ' << i;
            ASSERT_EQ(std::abs(got.inner_depth_m.pixels()[i]), depth_m.pixels()[i]);
            different += (got.inner_depth_m.pixels()[i] < 0) != (edge.pixels()[i] != 0);
            edges += edge.pixels()[i];
        }
        // Single precision decides otherwise at a limit.
        EXPECT_LE(different, extent.area() / 500);
        if (extent.area() > 100000) {
            EXPECT_GT(edges, extent.area() / 100);
        }
    }
}

}  // namespace
}  // namespace patina::find_edges_test
