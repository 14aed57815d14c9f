#include "scenes/files/mesh_file.h"

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "tests/data_folder.h"
#include "tests/scenes/scene_json.h"
#include "tests/sensor/sequences.h"

namespace patina::scenes::mesh_file_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sensor::testing::TemporaryFolder;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr MeshSettings kAsItIs{.up = MeshUp::kMinusY};

std::string error_of(const fs::path& file, const MeshSettings& settings = {}) {
    try {
        read_mesh(file, settings);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(MeshFile, ObjPolygonsAreSplitAndVerticesJoined) {
    const TemporaryFolder folder;
    write_text(folder / "a.obj",
               "# a square and a triangle beside it\nmtllib none.mtl\no thing\n"
               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0.5 0.25\nusemtl red\nf 1 2 3 4\nusemtl blue\nf 2 5 3\n");
    const TriangleMesh mesh = read_mesh(folder / "a.obj", kAsItIs);
    EXPECT_EQ(mesh.positions_m.size(), 5u);
    EXPECT_EQ(mesh.triangles.size(), 3u);
    EXPECT_THAT(mesh.positions_m,
                ::testing::UnorderedElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0),
                                                glm::vec3(0, 1, 0), glm::vec3(2, 0.5f, 0.25f)));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.texture_coordinates.empty());
}

TEST(MeshFile, ObjNormalsAndTextureCoordinatesAreKept) {
    const TemporaryFolder folder;
    write_text(folder / "a.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 2\nvn 0.6 0 0.8\nvt 0 0\nvt 1 0\nvt 0.25 1\n"
               "f 1/1/1 2/2/2 3/3/1\n");
    const TriangleMesh mesh = read_mesh(folder / "a.obj", kAsItIs);
    ASSERT_THAT(mesh.positions_m, ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
    EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1)) << "of unit length";
    EXPECT_LT(glm::distance(mesh.normals[1], glm::vec3(0.6f, 0, 0.8f)), 1e-6f);
    // An OBJ picture's bottom left is (0, 0), ours the top left.
    EXPECT_THAT(mesh.texture_coordinates, ElementsAre(glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(0.25f, 0)));
    EXPECT_TRUE(read_mesh(folder / "a.obj", {.normals = MeshNormals::kFlat}).normals.empty());
    const TriangleMesh smooth = read_mesh(folder / "a.obj", {.up = MeshUp::kMinusY, .normals = MeshNormals::kSmooth});
    EXPECT_THAT(smooth.normals, ::testing::Each(glm::vec3(0, 0, 1)));
}

TEST(MeshFile, WhatIsUpInTheFileBecomesUpInTheWorld) {
    const TemporaryFolder folder;
    write_text(folder / "a.obj", "v 1 0 0\nv 0 2 0\nv 0 0 3\nvn 0 1 0\nf 1//1 2//1 3//1\n");
    const auto read = [&](MeshUp up) { return read_mesh(folder / "a.obj", {.up = up}); };
    EXPECT_THAT(read(MeshUp::kY).positions_m,
                ElementsAre(glm::vec3(1, 0, 0), glm::vec3(0, -2, 0), glm::vec3(0, 0, -3)));
    EXPECT_EQ(read(MeshUp::kY).normals[0], glm::vec3(0, -1, 0));
    EXPECT_THAT(read(MeshUp::kZ).positions_m, ElementsAre(glm::vec3(1, 0, 0), glm::vec3(0, 0, 2), glm::vec3(0, -3, 0)));
    EXPECT_THAT(read(MeshUp::kMinusY).positions_m,
                ElementsAre(glm::vec3(1, 0, 0), glm::vec3(0, 2, 0), glm::vec3(0, 0, 3)));
}

TEST(MeshFile, IsScaledOrStandsWithItsHeight) {
    const TemporaryFolder folder;
    write_text(folder / "a.obj", "v 1 1 0\nv 3 1 0\nv 2 5 4\nf 1 2 3\n");
    const TriangleMesh scaled = read_mesh(folder / "a.obj", {.up = MeshUp::kMinusY, .scale = 0.5});
    EXPECT_THAT(scaled.positions_m, ElementsAre(glm::vec3(0.5, 0.5, 0), glm::vec3(1.5, 0.5, 0), glm::vec3(1, 2.5, 2)));
    const TriangleMesh standing = read_mesh(folder / "a.obj", {.height_m = 2});
    EXPECT_THAT(standing.positions_m, ElementsAre(glm::vec3(-0.5, 0, 1), glm::vec3(0.5, 0, 1), glm::vec3(0, -2, -1)));
}

constexpr const char* kPlyHeader =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 2\nproperty list uchar int vertex_indices\nend_header\n";

TEST(MeshFile, PlyIsRead) {
    const TemporaryFolder folder;
    write_text(folder / "a.ply", std::string(kPlyHeader) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
    const TriangleMesh mesh = read_mesh(folder / "a.ply", kAsItIs);
    EXPECT_THAT(mesh.positions_m,
                ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0), glm::vec3(0, 1, 0)));
    EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)));
}

TEST(MeshFile, DegenerateTrianglesAreNamedWithFileIndexAndArea) {
    const TemporaryFolder folder;
    const std::string file = (folder / "a.ply").string();
    write_text(file, std::string(kPlyHeader) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 2\n");
    EXPECT_THAT(error_of(file), AllOf(StartsWith(file + ": triangle 1 is degenerate: its area is 0 m^2")));
    write_text(file, std::string(kPlyHeader) + "0 0 0\n1 0 0\n1 1 0\nnan 1 0\n3 0 1 2\n3 0 2 3\n");
    EXPECT_THAT(error_of(file), StartsWith(file + ": "));
}

TEST(MeshFile, FilesThatAreNoMeshesAreErrorsThatNameThem) {
    const TemporaryFolder folder;
    const std::string missing = (folder / "missing.obj").string(), other = (folder / "a.txt").string(),
                      damaged = (folder / "a.glb").string(), points = (folder / "points.obj").string(),
                      range = (folder / "range.ply").string();
    write_text(other, "v 0 0 0\n");
    write_text(damaged, "glTF");
    write_text(points, "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n");
    write_text(range, std::string(kPlyHeader) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 9\n");
    EXPECT_EQ(error_of(missing), missing + " does not exist");
    EXPECT_EQ(error_of(other), other + ": its name ends in '.txt', which is none of .obj, .ply, .glb, .gltf");
    EXPECT_EQ(error_of(damaged), damaged + ": it is truncated: it has 4 bytes, but 20 are its header");
    EXPECT_EQ(error_of(points), points + ": there are no triangles");
    EXPECT_EQ(error_of(range), range + ": face 1 has a corner at vertex 9, but there are 4");
}

/// A GLB file with one triangle, (0, 0, 0), (1, 0, 0), (0, 1, 0), which the nodes use.
std::string glb(const json& nodes, const json& roots) {
    const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::string binary(positions.size() * sizeof(float), '\0');
    std::memcpy(binary.data(), positions.data(), binary.size());
    const json document = {{"asset", {{"version", "2.0"}}},
                           {"scene", 0},
                           {"scenes", {{{"nodes", roots}}}},
                           {"nodes", nodes},
                           {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
                           {"accessors",
                            {{{"bufferView", 0},
                              {"componentType", 5126},
                              {"count", 3},
                              {"type", "VEC3"},
                              {"min", {0, 0, 0}},
                              {"max", {1, 1, 0}}}}},
                           {"bufferViews", {{{"buffer", 0}, {"byteLength", binary.size()}}}},
                           {"buffers", {{{"byteLength", binary.size()}}}}};
    std::string text = document.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    const auto word = [](size_t value) {
        const auto number = static_cast<uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&number), 4);
    };
    return "glTF" + word(2) + word(12 + 8 + text.size() + 8 + binary.size()) + word(text.size()) + "JSON" + text +
           word(binary.size()) + std::string("BIN\0", 4) + binary;
}

TEST(MeshFile, GlbNodesPlaceTheirMeshes) {
    const TemporaryFolder folder;
    const json nodes = {{{"translation", {10, 0, 0}}, {"children", {1}}},
                        {{"mesh", 0}, {"scale", {2, 2, 2}}},
                        {{"mesh", 0}, {"scale", {-1, 1, 1}}}};
    write_text(folder / "a.glb", glb(nodes, {0, 2}));
    const TriangleMesh mesh = read_mesh(folder / "a.glb", kAsItIs);
    // The mirrored triangle is turned round, so that its front stays in front.
    ASSERT_EQ(mesh.triangles.size(), 2u);
    const auto corner = [&](size_t triangle, int i) { return mesh.positions_m[mesh.triangles[triangle][i]]; };
    EXPECT_EQ(corner(0, 0), glm::vec3(10, 0, 0));
    EXPECT_EQ(corner(0, 1), glm::vec3(12, 0, 0));
    EXPECT_EQ(corner(0, 2), glm::vec3(10, 2, 0));
    EXPECT_EQ(corner(1, 0), glm::vec3(0, 0, 0));
    EXPECT_EQ(corner(1, 1), glm::vec3(0, 1, 0));
    EXPECT_EQ(corner(1, 2), glm::vec3(-1, 0, 0));
}

// ---- meshes of scenes -----------------------------------------------------------------------------------------------

json scene_with_meshes() {
    json scene = testing::small_scene();
    scene["objects"][1]["parts"] = json::parse(R"([{"mesh": {"file": "a.obj", "height": 1}}])");
    scene["objects"][2]["parts"] = json::parse(R"([{"mesh": {"file": "a.obj", "height": 1}},
                                                   {"mesh": {"file": "a.obj", "scale": 2, "normals": "smooth"}}])");
    return scene;
}

const TriangleMesh* mesh_of(const Part& part) { return std::get<MeshShape>(part.shape).mesh.get(); }

TEST(SceneMesh, IsReadOncePerSettingsFromBesideTheScene) {
    const TemporaryFolder folder;
    write_text(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 3 0\nf 1 2 3\n");
    const SyntheticScene scene = testing::load(folder / "a.json", scene_with_meshes());
    const Part &first = scene.objects[1].parts[0], &second = scene.objects[2].parts[0],
               &third = scene.objects[2].parts[1];
    EXPECT_EQ(mesh_of(first), mesh_of(second));
    EXPECT_NE(mesh_of(first), mesh_of(third));
    EXPECT_EQ(mesh_of(first)->positions_m[2].y, -1);
    EXPECT_EQ(mesh_of(third)->positions_m[2].y, -6);
    EXPECT_EQ(mesh_of(third)->normals.size(), 3u);
}

TEST(SceneMesh, AnotherFileTakesThePlaceOfThoseWithAHeight) {
    const TemporaryFolder folder;
    write_text(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 3 0\nf 1 2 3\n");
    write_text(folder / "b.obj", "v 0 0 0\nv 1 0 0\nv 0 3 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n");
    const SyntheticScene scene = testing::load(folder / "a.json", scene_with_meshes(), {.mesh = folder / "b.obj"});
    EXPECT_EQ(mesh_of(scene.objects[1].parts[0])->triangles.size(), 2u);
    EXPECT_EQ(mesh_of(scene.objects[2].parts[0])->triangles.size(), 2u);
    EXPECT_EQ(mesh_of(scene.objects[2].parts[1])->triangles.size(), 1u);
}

TEST(SceneMesh, ErrorsNameSceneKeyAndMesh) {
    const TemporaryFolder folder;
    const std::string scene = (folder / "a.json").string(), mesh = (folder / "a.obj").string(),
                      other = (folder / "other.ply").string();
    EXPECT_EQ(testing::load_error(scene, scene_with_meshes().dump()),
              scene + ": objects[1].parts[0].mesh.file: " + mesh + " does not exist");
    write_text(mesh, "v 0 0 0\nv 1 0 0\nv 0 3 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n");
    EXPECT_THAT(
        testing::load_error(scene, scene_with_meshes().dump()),
        StartsWith(scene + ": objects[1].parts[0].mesh.file: " + mesh + ": triangle 1 is degenerate: its area"));
    EXPECT_EQ(testing::load_error(scene, scene_with_meshes().dump(), {.mesh = other}), other + " does not exist");
}

// ---- meshes in the wild ---------------------------------------------------------------------------------------------

struct WildMesh {
    const char* file;
    size_t vertices;  ///< 0: not known
    size_t triangles;
};

class WildMeshes : public ::testing::TestWithParam<WildMesh> {};

TEST_P(WildMeshes, AreReadWhole) {
    const fs::path folder = fs::path(GetParam().file).parent_path();
    const auto data = patina::testing::data_folder(folder.begin()->string());
    if (!data) GTEST_SKIP() << patina::testing::kNoData;
    const TriangleMesh mesh = read_mesh(data->parent_path() / GetParam().file, {.height_m = 1.5});
    EXPECT_EQ(mesh.triangles.size(), GetParam().triangles);
    if (GetParam().vertices > 0) {
        EXPECT_EQ(mesh.positions_m.size(), GetParam().vertices);
    }
    float lowest = -1, highest = 1;
    for (const glm::vec3 p : mesh.positions_m) {
        lowest = std::max(lowest, p.y);
        highest = std::min(highest, p.y);
    }
    EXPECT_EQ(lowest, 0);
    EXPECT_FLOAT_EQ(highest, -1.5f);
    for (const glm::vec3 n : mesh.normals) ASSERT_NEAR(glm::length(n), 1, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(
    Each, WildMeshes,
    ::testing::Values(WildMesh{"meshes/cow.obj", 2903, 5804}, WildMesh{"meshes/fandisk.obj", 6475, 12946},
                      WildMesh{"meshes/suzanne.obj", 0, 968}, WildMesh{"meshes/spot.obj", 0, 5856},
                      WildMesh{"meshes/nefertiti.obj", 49971, 99938},
                      // 199 of 22998 normals are zero: such a vertex gets one for each of its triangles.
                      WildMesh{"meshes/dragon_vrip_res3.ply", 23054, 47794},
                      WildMesh{"gltf/ClearCoatCarPaint/ClearCoatCarPaint.glb", 0, 3072},
                      WildMesh{"gltf/SheenChair/SheenChair.gltf", 0, 39936}));

TEST(WildMesh, DegenerateTrianglesAreFound) {
    const auto data = patina::testing::data_folder("gltf");
    if (!data) GTEST_SKIP() << patina::testing::kNoData;
    EXPECT_THAT(error_of(*data / "MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb"),
                HasSubstr("is degenerate: its area is 0 m^2"));
}

}  // namespace
}  // namespace patina::scenes::mesh_file_test
