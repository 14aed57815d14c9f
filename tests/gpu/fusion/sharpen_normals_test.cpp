// Normals that the volume has blurred over an edge become those of the faces again; those of curved faces stay.

#include "passes/fusion/sharpen_normals.h"

#include <functional>
#include <random>

#include <glm/gtc/packing.hpp>

#include "tests/gpu/gpu_test.h"
#include "tests/reference/fusion/sharpen_normals.h"

namespace patina::sharpen_normals_test {
namespace {

using reference::SeenSurface;

constexpr double kFocalPx = 400, kVoxelM = 0.005;
constexpr Extent2D kExtent{61, 47};

/// A surface z(x, y) of small slope about 2 m before an orthographic stand-in for the camera: a pixel is 5 mm.
SeenSurface surface(Extent2D extent, const std::function<double(double, double)>& z_m,
                    const std::function<glm::dvec3(double, double)>& normal) {
    SeenSurface seen{Image<glm::dvec4>(extent), Image<glm::dvec3>(extent)};
    for (uint32_t row = 0; row < extent.height; ++row) {
        for (uint32_t column = 0; column < extent.width; ++column) {
            const double x = 0.005 * (column - 0.5 * extent.width), y = 0.005 * (row - 0.5 * extent.height);
            seen.position_m.at(column, row) = {x, y, z_m(x, y), z_m(x, y)};
            seen.normal.at(column, row) = normal(x, y);
        }
    }
    return seen;
}

glm::dvec3 face_normal(double x) { return glm::normalize(glm::dvec3(x < 0 ? -1 : 1, 0, -1)); }

/// The edge of a cube towards the camera at x = 0, with normals blurred over `blur_m` on both sides.
SeenSurface blurred_edge(Extent2D extent, double blur_m) {
    return surface(
        extent, [](double x, double) { return 2 + std::abs(x); },
        [&](double x, double) {
            return std::abs(x) < blur_m ? glm::normalize(glm::dvec3(x / blur_m, 0, -1)) : face_normal(x);
        });
}

class SharpenNormals : public GpuTest {
  protected:
    Image<glm::dvec3> sharpen(const SeenSurface& seen) {
        graph::FrameGraph frame = runner().begin();
        const std::vector<glm::vec4> positions(seen.position_m.pixels().begin(), seen.position_m.pixels().end());
        std::vector<uint64_t> normals;
        for (const glm::dvec3& n : seen.normal.pixels()) normals.push_back(glm::packHalf4x16(glm::vec4(n, 0)));
        const Extent2D extent = seen.position_m.extent();
        const RaycastImages model{
            frame.upload("position_m", {extent, vulkan::Format::kRgba32f}, std::as_bytes(std::span(positions))),
            frame.upload("normal", {extent, vulkan::Format::kRgba16f}, std::as_bytes(std::span(normals)))};
        const graph::Readback read = frame.read_back(
            add_sharpen_normals(frame, model, static_cast<float>(kFocalPx), static_cast<float>(kVoxelM)).normal);
        run(std::move(frame));
        const Image<uint64_t> words = read.image<uint64_t>();
        Image<glm::dvec3> sharp(extent);
        for (size_t i = 0; i < extent.area(); ++i)
            sharp.pixels()[i] = glm::dvec3(glm::unpackHalf4x16(words.pixels()[i]));
        return sharp;
    }
};

double degrees_between(glm::dvec3 a, glm::dvec3 b) {
    return glm::degrees(std::acos(glm::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)));
}

TEST_F(SharpenNormals, EachSideOfAnEdgeHasItsOwnFacesNormal) {
    const SeenSurface seen = blurred_edge(kExtent, 0.005);
    ASSERT_GT(degrees_between(seen.normal.at(31, 20), face_normal(1)), 15) << "the edge is blurred";
    const Image<glm::dvec3> sharp = sharpen(seen);
    for (uint32_t y = 2; y + 2 < kExtent.height; ++y) {
        for (uint32_t x = 2; x + 2 < kExtent.width; ++x) {
            ASSERT_LT(degrees_between(sharp.at(x, y), face_normal(seen.position_m.at(x, y).x)), 3) << x << ' ' << y;
        }
    }
}

TEST_F(SharpenNormals, AFlatFaceKeepsItsNormalUpToItsEdge) {
    // Normals bent by up to 30 degrees within 8 mm of the edge: too little to be another face's.
    const double bent_m = 0.008;
    const SeenSurface seen = surface(
        kExtent, [](double x, double) { return 2 + std::abs(x); },
        [&](double x, double) {
            const double bend = glm::radians(30.0) * std::max(1 - std::abs(x) / bent_m, 0.0);
            const double angle = glm::radians(45.0) - bend;
            return glm::dvec3((x < 0 ? -1 : 1) * std::sin(angle), 0, -std::cos(angle));
        });
    ASSERT_GT(degrees_between(seen.normal.at(30, 20), face_normal(-1)), 20) << "bent beside the edge";
    const Image<glm::dvec3> sharp = sharpen(seen);
    for (uint32_t y = 6; y + 6 < kExtent.height; ++y) {
        for (uint32_t x = 6; x + 6 < kExtent.width; ++x) {
            ASSERT_LT(degrees_between(sharp.at(x, y), face_normal(seen.position_m.at(x, y).x)), 2.5) << x << ' ' << y;
        }
    }
}

TEST_F(SharpenNormals, CurvedFacesStayAsTheyAre) {
    constexpr double kRadiusM = 0.06;
    const auto height = [&](double x, double y) {
        return std::sqrt(std::max(kRadiusM * kRadiusM - x * x - y * y, 0.0));
    };
    const SeenSurface seen = surface(
        kExtent, [&](double x, double y) { return 2 - height(x, y); },
        [&](double x, double y) { return glm::normalize(glm::dvec3(x, y, -height(x, y) - 1e-9)); });
    const Image<glm::dvec3> sharp = sharpen(seen);
    size_t compared = 0;
    for (size_t i = 0; i < kExtent.area(); ++i) {
        const glm::dvec3 normal = seen.normal.pixels()[i];
        if (-normal.z < 0.6) continue;  // towards the rim a pixel is no longer small
        ASSERT_LT(degrees_between(sharp.pixels()[i], normal), 1) << i % kExtent.width << ' ' << i / kExtent.width;
        ++compared;
    }
    EXPECT_GT(compared, 250u);
}

TEST_F(SharpenNormals, RoughSurfaceBecomesSmoother) {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 1);
    const glm::dvec3 facing(0, 0, -1);
    const SeenSurface seen = surface(
        kExtent, [&](double, double) { return 2 + 1e-3 * noise(random); },
        [&](double, double) { return glm::normalize(facing + 0.4 * glm::dvec3(noise(random), noise(random), 0)); });
    const Image<glm::dvec3> sharp = sharpen(seen);
    double before = 0, after = 0;
    for (size_t i = 0; i < kExtent.area(); ++i) {
        before += degrees_between(seen.normal.pixels()[i], facing);
        after += degrees_between(sharp.pixels()[i], facing);
    }
    EXPECT_LT(after, 0.5 * before);
}

TEST_F(SharpenNormals, WhatIsNotKnownIsTakenFromItsPlane) {
    SeenSurface seen = blurred_edge(kExtent, 1e-9);
    seen.normal.at(20, 20) = glm::dvec3(0);
    seen.position_m.at(10, 10) = glm::dvec4(0);
    seen.normal.at(10, 10) = glm::dvec3(0);
    const Image<glm::dvec3> sharp = sharpen(seen);
    EXPECT_LT(degrees_between(sharp.at(20, 20), face_normal(-1)), 0.1);
    EXPECT_EQ(sharp.at(10, 10), glm::dvec3(0)) << "nothing was hit there";
}

TEST_F(SharpenNormals, MatchesTheReferenceOnWholeGroupsAndTails) {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 1);
    for (const Extent2D extent : {Extent2D{1, 1}, {8, 8}, {13, 7}, {65, 33}}) {
        SeenSurface seen = blurred_edge(extent, 0.008);
        const bool rough = extent.width == 65;
        for (size_t i = 0; i < extent.area(); ++i) {
            seen.position_m.pixels()[i].z += 3e-4 * noise(random);
            const glm::dvec3 tilt(noise(random), noise(random), noise(random));
            const glm::dvec3 normal = glm::normalize(seen.normal.pixels()[i] + (rough ? 0.3 : 0.03) * tilt);
            // As the pass reads it.
            seen.normal.pixels()[i] =
                i % 17 == 5 ? glm::dvec3(0) : glm::dvec3(glm::unpackHalf4x16(glm::packHalf4x16(glm::vec4(normal, 0))));
            if (i % 23 == 7) seen.position_m.pixels()[i] = glm::dvec4(0);
        }
        const Image<glm::dvec3> got = sharpen(seen);
        const Image<glm::dvec3> expected = reference::sharpen_normals(seen, kFocalPx, kVoxelM);
        size_t off = 0;
        for (size_t i = 0; i < extent.area(); ++i) {
            if (glm::distance(got.pixels()[i], expected.pixels()[i]) > 2e-3) ++off;
        }
        // Where two faces have equally many points, rounding decides.
        EXPECT_LE(off, extent.area() / 500) << extent.width << " x " << extent.height;
    }
}

}  // namespace
}  // namespace patina::sharpen_normals_test
