#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scenes/files/mesh_file.h"
#include "tests/reference/surface/mesh_facts.h"
#include "tools/figure/distance.h"
#include "tools/figure/hare.h"
#include "tools/figure/polygonise.h"
#include "tools/figure/write_ply.h"

namespace patina::figure::figure_test {
namespace {

const std::filesystem::path kShipped = PATINA_SOURCE_DIR "/assets/scenes/figure.ply";

reference::MeshFacts facts_of(const scenes::TriangleMesh& mesh) {
    std::vector<std::array<uint32_t, 3>> triangles;
    for (const glm::uvec3& t : mesh.triangles) triangles.push_back({t.x, t.y, t.z});
    return reference::mesh_facts(mesh.positions_m, triangles);
}

const scenes::TriangleMesh& made() {
    static const scenes::TriangleMesh mesh = make_hare();
    return mesh;
}

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Polygonise, AnEllipsoidIsASolidOfItsVolumeWithNormalsOutwards) {
    const auto egg = [](glm::dvec3 p) { return ellipsoid(p, {0.1, 0.2, 0.3}, {0.5, 0.7, 0.4}); };
    const scenes::TriangleMesh mesh = polygonise(egg, {-0.6, -0.7, -0.3}, {0.8, 1.1, 0.9}, 0.05);
    const reference::MeshFacts facts = facts_of(mesh);
    EXPECT_TRUE(facts.closed());
    EXPECT_EQ(facts.euler_number, 2);
    EXPECT_NEAR(facts.volume_m3, 4.18879 * 0.5 * 0.7 * 0.4, 0.005);  // inscribed: a little less
    for (size_t i = 0; i < mesh.positions_m.size(); ++i) {
        const glm::vec3 p = mesh.positions_m[i] - glm::vec3(0.1f, 0.2f, 0.3f);
        const glm::vec3 radii(0.5f, 0.7f, 0.4f);
        EXPECT_NEAR(glm::length(p / radii), 1, 1e-5);
        EXPECT_GT(glm::dot(glm::normalize(p / radii / radii), mesh.normals[i]), 0.99999f);
    }
}

TEST(Distance, JoinedSolidsHoldBothAndCarvedOnesLoseTheOther) {
    const double a = sphere({0, 0, 0}, {0, 0, 0}, 1), b = sphere({0, 0, 0}, {5, 0, 0}, 1);
    EXPECT_EQ(join(a, b, 0.1), a);                 // far apart: nothing is filled
    EXPECT_DOUBLE_EQ(join(0.2, 0.2, 0.1), 0.175);  // a quarter of the blend where both are as near
    EXPECT_EQ(carve(-0.5, -0.2, 0.1), 0.2);
    EXPECT_DOUBLE_EQ(torus({0, 0.1, 2}, {0, 0, 0}, {0, 1, 0}, 2, 0.3), 0.1 - 0.3);
    EXPECT_NEAR(rod({0.5, 1, 0}, {0, 0, 0}, {1, 0, 0}, 0.1, 0.3), 1 - 0.2, 1e-12);
}

TEST(Figure, IsOneClosedSolidWithoutSlivers) {
    const reference::MeshFacts facts = facts_of(made());
    EXPECT_TRUE(facts.closed()) << facts.open_edges << " open, " << facts.crowded_edges << " crowded";
    EXPECT_EQ(facts.unused_vertices, 0u);
    EXPECT_GT(facts.volume_m3, 0.1);
    EXPECT_GE(made().triangles.size(), 15000u);
    EXPECT_LE(made().triangles.size(), 25000u);
    for (const glm::uvec3& t : made().triangles) {
        const glm::vec3 a = made().positions_m[t.x], b = made().positions_m[t.y], c = made().positions_m[t.z];
        const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
        EXPECT_GT(glm::length(glm::cross(b - a, c - a)), 0.15f * longest * longest);
    }
}

TEST(Figure, VerticesLieOnTheSurfaceWithItsNormals) {
    for (size_t i = 0; i < made().positions_m.size(); ++i) {
        EXPECT_LT(std::abs(hare(glm::dvec3(made().positions_m[i]))), 1e-5) << "vertex " << i;
        EXPECT_NEAR(glm::length(made().normals[i]), 1, 1e-5);
    }
    for (const glm::uvec3& t : made().triangles) {  // no triangle faces inwards
        const glm::vec3 a = made().positions_m[t.x], b = made().positions_m[t.y], c = made().positions_m[t.z];
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), made().normals[t.x] + made().normals[t.y] + made().normals[t.z]),
                  0);
    }
}

TEST(Figure, StandsOnItsOriginAbout1Point5High) {
    const auto [low, high] = std::minmax_element(made().positions_m.begin(), made().positions_m.end(),
                                                 [](glm::vec3 a, glm::vec3 b) { return a.y < b.y; });
    EXPECT_NEAR(low->y, 0, 0.01);
    EXPECT_NEAR(high->y, 1.55, 0.05);
}

TEST(Figure, TheShippedFileIsWhatTheProgramMakes) {
    const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "patina_figure.ply";
    write_ply(file, made());
    const std::string made_bytes = bytes_of(file), shipped_bytes = bytes_of(kShipped);
    EXPECT_EQ(made_bytes.size(), shipped_bytes.size());
    EXPECT_LT(shipped_bytes.size(), 700'000u);
    scenes::MeshSettings as_it_is;
    as_it_is.up = scenes::MeshUp::kMinusY;
    const scenes::TriangleMesh written = scenes::read_mesh(file, as_it_is);
    const scenes::TriangleMesh shipped = scenes::read_mesh(kShipped, as_it_is);
    std::filesystem::remove(file);
    EXPECT_EQ(shipped.triangles, written.triangles);
    ASSERT_EQ(shipped.positions_m.size(), written.positions_m.size());
    ASSERT_EQ(shipped.positions_m.size(), made().positions_m.size());
    for (size_t i = 0; i < shipped.positions_m.size(); ++i) {  // another compiler may round otherwise
        EXPECT_LT(glm::distance(shipped.positions_m[i], written.positions_m[i]), 1e-5f);
        EXPECT_LT(glm::distance(shipped.normals[i], written.normals[i]), 1e-3f);
    }
}

TEST(Figure, IsTheSameEachTime) {
    const scenes::TriangleMesh again = make_hare();
    EXPECT_EQ(again.positions_m, made().positions_m);
    EXPECT_EQ(again.normals, made().normals);
    EXPECT_EQ(again.triangles, made().triangles);
}

}  // namespace
}  // namespace patina::figure::figure_test
