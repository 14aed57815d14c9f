#include "export/write_tiles.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include <gmock/gmock.h>
#include <tiny_gltf.h>

#include "export/coarser_mesh.h"
#include "tests/export/temporary_folder.h"
#include "tests/export/test_meshes.h"

namespace patina::write_tiles_test {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::TemporaryFolder;
using test::wavy_sheet;
using testing::ElementsAre;

struct Less {
    bool operator()(glm::vec3 a, glm::vec3 b) const { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }
};
using Points = std::set<glm::vec3, Less>;

TEST(CoarserMesh, HasFewerTrianglesAndTheBordersOfBefore) {
    const Mesh fine = wavy_sheet(60, 50);
    const CoarserMesh coarse = coarser(fine, std::vector<float>(fine.positions_m.size(), 0.3f), {.part = 0.125});
    const size_t borders = 2 * (59 + 49);
    EXPECT_LT(coarse.mesh.triangles.size(), fine.triangles.size() / 8 + borders);
    EXPECT_GT(coarse.mesh.triangles.size(), borders);
    EXPECT_GT(coarse.error_m, 0);
    EXPECT_LT(coarse.error_m, 0.05) << "the waves are 0.1 m high";
    ASSERT_EQ(coarse.vertices.size(), coarse.mesh.positions_m.size());
    for (size_t i = 0; i < coarse.vertices.size(); ++i) {
        EXPECT_EQ(coarse.mesh.positions_m[i], fine.positions_m[coarse.vertices[i]]);
        EXPECT_EQ(coarse.mesh.normals[i], fine.normals[coarse.vertices[i]]);
        EXPECT_EQ(coarse.mesh.colors[i], fine.colors[coarse.vertices[i]]);
    }
    const Points kept(coarse.mesh.positions_m.begin(), coarse.mesh.positions_m.end());
    for (uint32_t i = 0; i < fine.positions_m.size(); ++i) {
        const bool at_border = i % 60 == 0 || i % 60 == 59 || i / 60 == 0 || i / 60 == 49;
        EXPECT_TRUE(!at_border || kept.contains(fine.positions_m[i]));
    }
    std::set<uint32_t> used;
    for (const auto& triangle : coarse.mesh.triangles) used.insert(triangle.begin(), triangle.end());
    EXPECT_EQ(used.size(), coarse.vertices.size());
}

TEST(CoarserMesh, OfNothingIsNothing) {
    EXPECT_TRUE(coarser(Mesh{}, {}, {.part = 0.5}).mesh.positions_m.empty());
    const Mesh one = wavy_sheet(2, 2);
    EXPECT_EQ(coarser(one, std::vector<float>(4), {.part = 0.01}).mesh.triangles.size(), 2u) << "all is border";
}

/// A flat sheet with a pattern has no shape to keep but that of its shades.
TEST(CoarserMesh, KeepsShadesAsShape) {
    Mesh flat = wavy_sheet(60, 60);
    std::vector<float> plain(flat.positions_m.size(), 0.5f), checked;
    for (size_t i = 0; i < flat.positions_m.size(); ++i) {
        flat.positions_m[i].z = 0;
        flat.normals[i] = {0, 0, 1};
        checked.push_back((i % 60 / 15 + i / 60 / 15) % 2 == 0 ? 0.1f : 0.9f);
    }
    EXPECT_LT(coarser(flat, plain, {.part = 1.0 / 64}).error_m, 1e-6);
    EXPECT_GT(coarser(flat, checked, {.part = 1.0 / 64}).error_m, 0.001);
    const CoarserMesh coarse = coarser(flat, checked, {.part = 1.0 / 8});
    // Triangles that mix the shades are few: those along the edges of the pattern.
    size_t mixed = 0;
    float mixed_m2 = 0, all_m2 = 0;
    for (const auto& [a, b, c] : coarse.mesh.triangles) {
        const auto at = [&](uint32_t v) { return coarse.mesh.positions_m[v]; };
        const float area = glm::length(glm::cross(at(b) - at(a), at(c) - at(a))) / 2;
        const auto shade = [&](uint32_t v) { return checked[coarse.vertices[v]]; };
        all_m2 += area;
        if (shade(a) == shade(b) && shade(b) == shade(c)) continue;
        ++mixed;
        mixed_m2 += area;
    }
    EXPECT_GT(mixed, 0u);
    EXPECT_LT(mixed_m2, 0.25f * all_m2);
}

/// Two halves of one sheet, each made coarser by itself.
TEST(CoarserMesh, MeshesThatMeetStillDo) {
    const Mesh whole = wavy_sheet(41, 40);
    const auto border_of = [&](uint32_t first, uint32_t last) {
        Mesh half = whole;
        std::erase_if(half.triangles, [&](const auto& t) {
            return std::ranges::any_of(t, [&](uint32_t v) { return v % 41 < first || v % 41 > last; });
        });
        std::vector<float> shades;
        for (const glm::vec3& color : half.colors) shades.push_back(color.r);
        Points border;
        for (const glm::vec3& position : coarser(half, shades, {.part = 1.0 / 64}).mesh.positions_m) {
            if (position.x == whole.positions_m[20].x) border.insert(position);
        }
        return border;
    };
    const Points left = border_of(0, 20), right = border_of(20, 40);
    EXPECT_EQ(left, right);
    EXPECT_EQ(left.size(), 40u);
}

/// What was written, by name.
struct Tiles {
    TemporaryFolder folder;
    std::set<std::string> names;

    TileWriter::Write write() {
        return [this](const std::string& name, const auto& write_to) {
            std::filesystem::create_directories((folder / name.c_str()).parent_path());
            write_to(folder / name.c_str());
            EXPECT_TRUE(names.insert(name).second) << name << " was written twice";
        };
    }
    json tileset() const { return json::parse(bytes_of(folder / "tileset.json")); }
    tinygltf::Model read(const std::string& name) const {
        tinygltf::Model model;
        std::string error, warning;
        EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, folder / name.c_str())) << error;
        return model;
    }
};

/// Two segments, the one with a gloss.
MeshReflectance halves(const Mesh& mesh) {
    MeshReflectance reflectance;
    for (size_t i = 0; i < mesh.positions_m.size(); ++i) {
        reflectance.kd.emplace_back(0.5f, 0.25f, 0.125f, 1);
        reflectance.labels.push_back(i < mesh.positions_m.size() / 2 ? 1 : 2);
    }
    reflectance.segments.resize(3);
    reflectance.segments[1].gloss = WardGloss{glm::vec3(0.1f), 0.2f};
    return reflectance;
}

size_t triangles_in(const tinygltf::Model& model) {
    size_t indices = 0;
    for (const auto& mesh : model.meshes) {
        for (const auto& primitive : mesh.primitives)
            indices += model.accessors.at(static_cast<size_t>(primitive.indices)).count;
    }
    return indices / 3;
}

TEST(WriteTiles, EachCellHasLevelsOfDetail) {
    Tiles tiles;
    TileWriter writer(tiles.write(), {.version = "1.2.3",
                                      .lights = {{{0, 0, 1}, {1, 1, 1}, 0.05}},
                                      .windows = {{{0, 0, 2}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}, false}}});
    const Mesh first = wavy_sheet(60, 50);
    Mesh second = first;
    for (glm::vec3& position : second.positions_m) position += glm::vec3(1, 2, 3);
    writer.add(first, halves(first));
    writer.add(Mesh{}, MeshReflectance{});  // has no tile
    writer.add(second, halves(second));
    const GlbSummary summary = writer.finish();
    EXPECT_EQ(summary.triangles, first.triangles.size() + second.triangles.size());
    EXPECT_THAT(tiles.names, ElementsAre("0/000000.glb", "0/000001.glb", "1/000000.glb", "1/000001.glb", "2/000000.glb",
                                         "2/000001.glb", "tileset.json"));

    const json set = tiles.tileset();
    EXPECT_EQ(set["asset"]["version"], "1.1");
    const json& root = set["root"];
    EXPECT_EQ(root["refine"], "REPLACE");
    ASSERT_EQ(root["children"].size(), 2u);
    for (size_t cell = 0; cell < 2; ++cell) {
        json tile = root["children"][cell];
        EXPECT_GE(root["geometricError"], tile["geometricError"]);
        size_t triangles = 0;
        for (int level = 2; level >= 0; --level) {
            const std::string name = std::to_string(level) + "/00000" + std::to_string(cell) + ".glb";
            EXPECT_EQ(tile["content"]["uri"], name);
            const tinygltf::Model model = tiles.read(name);
            EXPECT_GT(triangles_in(model), triangles);
            triangles = triangles_in(model);
            EXPECT_TRUE(model.lights.empty());
            EXPECT_FALSE(model.scenes.at(0).extras.Has("windows"));
            ASSERT_EQ(model.materials.size(), 2u);
            EXPECT_TRUE(model.materials[0].extras.Has("ward"));
            if (level == 0) {
                EXPECT_EQ(tile["geometricError"], 0);
                EXPECT_FALSE(tile.contains("children"));
                break;
            }
            ASSERT_EQ(tile["children"].size(), 1u);
            const json finer = tile["children"][0];
            EXPECT_GE(tile["geometricError"], finer["geometricError"]);
            EXPECT_GT(tile["geometricError"], 0);
            tile = finer;
        }
        EXPECT_EQ(triangles, first.triangles.size());
    }
}

/// A world's y points down, its z forward; in the tileset z is up, and y forward.
TEST(WriteTiles, VolumesHoldTheirTilesWithZUp) {
    Tiles tiles;
    TileWriter writer(tiles.write(), {.version = "1.2.3"});
    Mesh mesh = wavy_sheet(2, 2);
    mesh.positions_m = {{1, 2, 3}, {5, 2, 3}, {1, 2, 11}, {1, 8, 3}};
    writer.add(mesh, {});
    for (glm::vec3& position : mesh.positions_m) position.x += 10;
    writer.add(mesh, {});
    writer.finish();
    const json root = tiles.tileset()["root"];
    EXPECT_EQ(root["children"][0]["boundingVolume"]["box"], json({3, 7, -5, 2, 0, 0, 0, 4, 0, 0, 0, 3}));
    EXPECT_EQ(root["children"][1]["boundingVolume"]["box"], json({13, 7, -5, 2, 0, 0, 0, 4, 0, 0, 0, 3}));
    EXPECT_EQ(root["boundingVolume"]["box"], json({8, 7, -5, 7, 0, 0, 0, 4, 0, 0, 0, 3}));
}

TEST(WriteTiles, StandOnTheFloor) {
    Tiles tiles;
    TileWriter writer(tiles.write(), {.version = "1.2.3", .upright = {UpSource::kFloor, kYDownToYUp, -8}},
                      {.raw_attributes = true});
    Mesh mesh = wavy_sheet(2, 2);
    mesh.positions_m = {{1, 2, 3}, {5, 2, 3}, {1, 2, 11}, {1, 8, 3}};
    writer.add(mesh, halves(mesh));
    writer.finish();
    EXPECT_EQ(tiles.tileset()["root"]["boundingVolume"]["box"], json({3, 7, 3, 2, 0, 0, 0, 4, 0, 0, 0, 3}));
    const tinygltf::Model model = tiles.read("0/000000.glb");
    EXPECT_THAT(model.nodes.at(0).translation, ElementsAre(0, 8, 0));
    EXPECT_TRUE(model.meshes.at(0).primitives.at(0).attributes.contains("_KD"));
}

TEST(WriteTiles, WithoutTrianglesThereIsATilesetAlone) {
    Tiles tiles;
    TileWriter writer(tiles.write(), {.version = "1.2.3"});
    writer.finish();
    EXPECT_THAT(tiles.names, ElementsAre("tileset.json"));
    EXPECT_FALSE(tiles.tileset()["root"].contains("children"));
}

}  // namespace
}  // namespace patina::write_tiles_test
