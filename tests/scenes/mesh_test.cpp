#include "scenes/description/mesh.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/error.h"

namespace patina::scenes::mesh_test {
namespace {

using ::testing::HasSubstr;

/// A roof: two rectangles of two triangles each that meet along the z axis at right angles; up is -y.
TriangleMesh roof() {
    TriangleMesh mesh;
    mesh.positions_m = {{-1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {-1, 1, 2}, {0, 0, 2}, {1, 1, 2}};
    mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    return mesh;
}

std::string error_of(const TriangleMesh& mesh) {
    try {
        check_triangles(mesh);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(CheckTriangles, NamesTheFirstDegenerateOneAndItsArea) {
    TriangleMesh mesh = roof();
    EXPECT_EQ(error_of(mesh), "no error");
    mesh.triangles[2] = {1, 1, 5};
    EXPECT_THAT(error_of(mesh), HasSubstr("triangle 2 is degenerate: its area is 0 m^2"));
    mesh = roof();
    mesh.positions_m[2] = {-0.5f, 0.0f, 1e-9f};
    mesh.triangles[2] = {1, 2, 0};
    mesh.positions_m[0] = {-1, 0, 0};
    EXPECT_THAT(error_of(mesh), HasSubstr("triangle 2 is degenerate: its area is 5e-10 m^2, its longest edge 1 m"));
    mesh = roof();
    mesh.positions_m[3].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(error_of(mesh), HasSubstr("triangle 1 is degenerate: its area is nan m^2"));
    EXPECT_EQ(error_of({}), "there are no triangles");
}

TEST(SmoothNormals, AreWeightedByAngleAndSharedByPosition) {
    const TriangleMesh smooth = with_smooth_normals(roof());
    const float half = std::sqrt(0.5f);
    // Each side of the ridge has a right angle there, whatever its number of triangles: the mean points straight up.
    for (const size_t ridge : {1, 4}) EXPECT_LT(glm::distance(smooth.normals[ridge], glm::vec3(0, -1, 0)), 1e-6f);
    for (const size_t left : {0, 3}) EXPECT_LT(glm::distance(smooth.normals[left], glm::vec3(-half, -half, 0)), 1e-6f);
    for (const size_t right : {2, 5}) EXPECT_LT(glm::distance(smooth.normals[right], glm::vec3(half, -half, 0)), 1e-6f);
    EXPECT_EQ(smooth.positions_m, roof().positions_m);

    TriangleMesh seam = roof();  // the ridge's vertices twice
    seam.positions_m.push_back(seam.positions_m[1]);
    seam.positions_m.push_back(seam.positions_m[4]);
    seam.triangles[2].x = seam.triangles[3].x = 6;
    seam.triangles[3].z = 7;
    seam = with_smooth_normals(std::move(seam));
    for (const size_t ridge : {1, 4, 6, 7}) EXPECT_LT(glm::distance(seam.normals[ridge], glm::vec3(0, -1, 0)), 1e-6f);
}

TEST(SmoothNormals, WhereTrianglesCancelOneOfThemDecides) {
    TriangleMesh mesh;
    mesh.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
    for (const glm::vec3 normal : with_smooth_normals(mesh).normals) EXPECT_EQ(std::abs(normal.z), 1);
}

TEST(Standing, PutsTheLowestPointOnTheOriginAndCentresTheRest) {
    TriangleMesh mesh = roof();
    for (glm::vec3& p : mesh.positions_m) p = 3.0f * p + glm::vec3(7, 11, 13);
    mesh = standing(std::move(mesh), 0.5);
    EXPECT_EQ(mesh.positions_m[0], glm::vec3(-0.5f, 0, -0.5f));
    EXPECT_EQ(mesh.positions_m[4], glm::vec3(0, -0.5f, 0.5f));
    EXPECT_EQ(mesh.positions_m[5], glm::vec3(0.5f, 0, 0.5f));
    for (glm::vec3& p : mesh.positions_m) p.y = 2;
    EXPECT_THROW(standing(mesh, 1), Error);
}

TEST(Joined, SharesWhatIsEqualAndNothingElse) {
    TriangleMesh soup;
    soup.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1e-6f, 0}};
    soup.triangles = {{0, 1, 2}, {3, 4, 5}};
    const TriangleMesh mesh = joined(soup);
    EXPECT_EQ(mesh.positions_m.size(), 4u);
    EXPECT_EQ(mesh.triangles[1], glm::uvec3(1, 2, 3));
    soup.texture_coordinates = {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {0, 0.5}, {1, 1}};
    EXPECT_EQ(joined(soup).positions_m.size(), 5u);
    soup.normals.assign(6, glm::vec3(0, 0, 1));
    soup.normals[3] = {0, 1, 0};
    EXPECT_EQ(joined(soup).positions_m.size(), 6u);
}

}  // namespace
}  // namespace patina::scenes::mesh_test
