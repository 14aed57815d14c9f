#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "scenes/files/mesh_file.h"
#include "tests/sensor/sequences.h"

namespace patina::scenes::mesh_readers_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sensor::testing::TemporaryFolder;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class MeshReader : public ::testing::Test {
  protected:
    /// Reads a file of this name and content, as it is.
    TriangleMesh read(const std::string& name, const std::string& content) {
        write_text(folder_ / name, content);
        return read_mesh(folder_ / name, {.up = MeshUp::kMinusY});
    }

    /// The error of reading it, without the file's name.
    std::string error(const std::string& name, const std::string& content) {
        const std::string file = (folder_ / name).string();
        const std::string message = sensor::testing::error_of([&] { read(name, content); });
        EXPECT_THAT(message, StartsWith(file + ": "));
        return message.substr(std::min(message.size(), file.size() + 2));
    }

    const TemporaryFolder folder_;
};

double area_of(const TriangleMesh& mesh) {
    double area = 0;
    for (const glm::uvec3 t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions_m[t.x]), b(mesh.positions_m[t.y]), c(mesh.positions_m[t.z]);
        area += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    return area;
}

// ---- PLY ------------------------------------------------------------------------------------------------------------

template <class Number>
std::string raw(Number number, std::endian order) {
    std::string bytes(sizeof(number), '\0');
    std::memcpy(bytes.data(), &number, sizeof(number));
    if (order == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

TEST_F(MeshReader, BinaryPlyOfBothByteOrders) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        std::string ply = std::string("ply\r\nformat binary_") + (order == std::endian::big ? "big" : "little") +
                          "_endian 1.0\r\ncomment made by hand\nelement vertex 4\nproperty double x\nproperty float y\n"
                          "property short z\nproperty uchar red\nproperty float nx\nproperty float ny\n"
                          "property float nz\nproperty float s\nproperty float t\nelement camera 1\n"
                          "property list ushort double k\nelement face 2\nproperty uchar flags\n"
                          "property list int ushort vertex_index\nend_header\n";
        for (int i = 0; i < 4; ++i) {
            ply +=
                raw(double(i % 2), order) + raw(float(i / 2), order) + raw(int16_t(-i), order) + raw(uint8_t(7), order);
            for (const float n : {0.f, 0.f, 2.f}) ply += raw(n, order);
            ply += raw(0.25f * float(i), order) + raw(0.75f, order);
        }
        ply += raw(uint16_t(2), order) + raw(1.0, order) + raw(2.0, order);
        for (const std::vector<uint16_t>& face : {std::vector<uint16_t>{0, 1, 2}, {1, 3, 2}}) {
            ply += raw(uint8_t(1), order) + raw(int32_t(3), order);
            for (const uint16_t index : face) ply += raw(index, order);
        }
        const TriangleMesh mesh = read("a.ply", ply);
        EXPECT_THAT(mesh.positions_m,
                    ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, -1), glm::vec3(0, 1, -2), glm::vec3(1, 1, -3)));
        EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(1, 3, 2)));
        EXPECT_THAT(mesh.normals, ::testing::Each(glm::vec3(0, 0, 1)));
        EXPECT_EQ(mesh.texture_coordinates[3], glm::vec2(0.75f, 0.25f)) << "the file's bottom left is (0, 0)";
        for (size_t left = ply.size(); left-- > 0;) {  // every cut
            ASSERT_THAT(error("a.ply", ply.substr(0, left)), ::testing::Not(::testing::IsEmpty()));
        }
    }
}

const std::string kSquare =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST_F(MeshReader, PlyFacesMayHaveTextureCoordinatesOfTheirOwn) {
    const TriangleMesh mesh = read(
        "a.ply", replaced(kSquare, "int vertex_indices\n", "int vertex_indices\nproperty list uchar float texcoord\n") +
                     "4 0 1 2 3 8 0 0 1 0 1 1 0 1");
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_THAT(mesh.texture_coordinates,
                ::testing::UnorderedElementsAre(glm::vec2(0, 1), glm::vec2(1, 1), glm::vec2(1, 0), glm::vec2(0, 0)));
}

TEST_F(MeshReader, PlyThatContradictsItselfIsRefused) {
    EXPECT_THAT(error("a.ply", "ply\nformat ascii 1.0\n"),
                StartsWith("its header has no end_header within its first 21"));
    EXPECT_THAT(error("a.ply", "plx\n"), StartsWith("it does not begin with 'ply'"));
    EXPECT_THAT(error("a.ply", replaced(kSquare, "1.0", "2147483648")), StartsWith("line 2 of its header is 'format"));
    EXPECT_THAT(error("a.ply", replaced(kSquare, "float x", "flout x")), HasSubstr("of type 'flout'"));
    EXPECT_THAT(error("a.ply", replaced(kSquare, "vertex 4", "vertex -4")), HasSubstr("line 3 of its header"));
    EXPECT_THAT(error("a.ply", replaced(kSquare, "property float z\n", "")), HasSubstr("no x, y and z"));
    EXPECT_THAT(error("a.ply", replaced(kSquare, "float z", "float x")), HasSubstr("x a second time"));
    EXPECT_THAT(error("a.ply", replaced(kSquare, "vertex 4", "vertex 18446744073709551615")),
                StartsWith("its header has 18446744073709551615 of element vertex, at most 33554432 are read"));
    EXPECT_THAT(error("a.ply", replaced(kSquare, "vertex 4", "vertex 33554432") + "4 0 1 2 3"),
                StartsWith("it is truncated: element vertex of 33554432 takes at least 6 bytes for each"));
    EXPECT_THAT(error("a.ply", kSquare + "-3 0 1 2"), StartsWith("a list vertex_indices has a length of -3"));
    EXPECT_THAT(error("a.ply", kSquare + "4000000000 0 1 2"), StartsWith("it is truncated: a list vertex_indices of"));
    EXPECT_THAT(error("a.ply", kSquare + "3 0 1 18446744073709551615"), HasSubstr("'18446744073709551615' at byte"));
    EXPECT_EQ(error("a.ply", kSquare + "3 0 1 -1"), "face 0 has a corner at vertex -1, but there are 4");
    EXPECT_THAT(error("a.ply", replaced(kSquare, "0 1 0\n", "0 nan 0\n") + "4 0 1 2 3"),
                HasSubstr("a coordinate of nan"));
    EXPECT_EQ(error("a.ply", replaced(kSquare, "element face 1", "element edge 1") + "3 0 1 2"),
              "it has no element face, and only a mesh's faces are read");
    EXPECT_THAT(error("a.ply", "ply\nformat ascii 1.0\nelement nothing 99999999\nend_header\n"),
                StartsWith("its header has 99999999 of element nothing"));
}

// ---- OBJ ------------------------------------------------------------------------------------------------------------

TEST_F(MeshReader, ObjIndicesCountFromBothEndsAndLinesGoOn) {
    const TriangleMesh mesh =
        read("a.obj",
             "# C:\\models\\\nv 0 0 0 0.5 0.5 0.5\nv +1 0 0\nv 1 1e0 0\nvn 0 0 1\n"
             "f -3//1 -2//-1 \\\n 3//1\nv 0 1 0\nf 1//1 3//1 -1//1 # the other half\nl 1 2\nf 1 2\n");
    EXPECT_THAT(mesh.positions_m,
                ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0), glm::vec3(0, 1, 0)));
    EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)));
}

TEST_F(MeshReader, ObjThatContradictsItselfIsRefusedWithItsLine) {
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_EQ(error("a.obj", triangle + "f 1 2 4\n"), "line 4: a corner's v is 4, but there are 3");
    EXPECT_EQ(error("a.obj", triangle + "f 1 2 0\n"), "line 4: a corner's v is 0, but there are 3");
    EXPECT_EQ(error("a.obj", triangle + "f 1 2 -4"), "line 4: a corner's v is -4, but there are 3");
    EXPECT_EQ(error("a.obj", triangle + "f 1/1 2/1 3/1\n"), "line 4: a corner's vt is 1, but there are 0");
    EXPECT_EQ(error("a.obj", triangle + "f 1 2 99999999999999999999\n"), "line 4: '99999999999999999999' is no index");
    EXPECT_EQ(error("a.obj", triangle + "f 1 2 /3\n"), "line 4: '/3' is no corner");
    EXPECT_EQ(error("a.obj", "v 0 0\n"), "line 1: it has 2 numbers, must have at least 3");
    EXPECT_EQ(error("a.obj", "v 0 0 1e999\n"), "line 1: '1e999' is no number");
    EXPECT_EQ(error("a.obj", "v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3"),
              "line 4: a vertex has a coordinate of inf, which is no finite float");
    EXPECT_EQ(error("a.obj", ""), "there are no triangles");
}

TEST_F(MeshReader, FacesThatAreNotConvexAreCoveredOnce) {
    // An L, an arrow, and a square with a corner on its edge, each in the plane x = 1 and turned both ways.
    const std::vector<std::pair<std::vector<glm::ivec2>, double>> shapes{
        {{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 4},
        {{{0, 0}, {3, 1}, {0, 2}, {1, 1}}, 2},
        {{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}, 4},
    };
    for (const auto& [corners, area] : shapes) {
        for (size_t first = 0; first < corners.size(); ++first) {
            for (const bool reversed : {false, true}) {
                std::string obj, face = "f";
                for (size_t i = 0; i < corners.size(); ++i) {
                    const glm::ivec2 p = corners[(first + i) % corners.size()];
                    obj += text("v 1 ", p.x, " ", p.y, "\n");
                    face += text(" ", reversed ? corners.size() - i : i + 1);
                }
                const TriangleMesh mesh = read("a.obj", obj + face);
                EXPECT_EQ(mesh.triangles.size(), corners.size() - 2);
                EXPECT_DOUBLE_EQ(area_of(mesh), area);
                for (const glm::uvec3 t : mesh.triangles) {
                    const glm::vec3 a = mesh.positions_m[t.x];
                    const float facing = glm::cross(mesh.positions_m[t.y] - a, mesh.positions_m[t.z] - a).x;
                    EXPECT_EQ(facing < 0, reversed);
                }
            }
        }
    }
}

TEST_F(MeshReader, AFaceWithManyCornersIsSplitOnlyWhereThatIsEasy) {
    std::string circle, star, face = "f";
    for (int i = 0; i < 2000; ++i) {
        const double angle = i * 2 * 3.14159265358979 / 2000, radius = i % 2 == 0 ? 1 : 0.9;
        circle += text("v ", std::cos(angle), " ", std::sin(angle), " 0\n");
        star += text("v ", radius * std::cos(angle), " ", radius * std::sin(angle), " 0\n");
        face += text(" ", i + 1);
    }
    EXPECT_EQ(error("a.obj", star + face),
              "line 2001: a face that is not convex has 2000 corners, at most 256 are split");
    EXPECT_EQ(read("a.obj", "v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3 4\n").triangles.size(), 2u);
}

TEST_F(MeshReader, AFaceWithMoreCornersThanAnyMeshHasIsRefused) {
    constexpr size_t kCorners = (size_t{1} << 20) + 1;
    std::string obj = "v 0 0 0\nf";
    for (size_t i = 0; i < kCorners; ++i) obj += " 1";
    EXPECT_EQ(error("a.obj", obj), "line 2: a face has more than 1048576 corners, the most that are read");
    const std::string ply =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty char x\nproperty char y\nproperty char z\n"
        "element face 1\nproperty list uint uchar vertex_indices\nend_header\n";
    EXPECT_EQ(error("a.ply", ply + std::string(3, '\0') + raw(uint32_t(kCorners), std::endian::little) +
                                 std::string(kCorners, '\0')),
              "a face has 1048577 vertex_indices, at most 1048576 are read");
}

// ---- glTF -----------------------------------------------------------------------------------------------------------

/// A glTF file with one triangle and its buffer in the file itself.
json triangle() {
    // (0, 0, 0), (1, 0, 0), (0, 1, 0) as floats
    const std::string data = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    return {{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0}}}}},
            {"nodes", {{{"mesh", 0}}}},
            {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
            {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
            {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
            {"buffers", {{{"byteLength", 36}, {"uri", "data:application/octet-stream;base64," + data}}}}};
}

class GltfReader : public MeshReader {
  protected:
    /// The error once `value` stands at a place, as "/accessors/0/count".
    std::string error_with(const std::string& place, const json& value) {
        json file = triangle();
        file[json::json_pointer(place)] = value;
        return error("a.gltf", file.dump());
    }
};

TEST_F(GltfReader, TheBufferMayLieInTheFileOrBesideIt) {
    const std::vector<glm::vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(read("a.gltf", triangle().dump()).positions_m, positions);
    std::string bytes(36, '\0');
    std::memcpy(bytes.data(), positions.data(), bytes.size());
    fs::create_directories(folder_ / "in/buffers");
    write_text(folder_ / "in/buffers/b.bin", bytes);
    write_text(folder_ / "outside.bin", bytes);
    json file = triangle();
    file["buffers"][0]["uri"] = "buffers/b.bin";
    EXPECT_EQ(read("in/a.gltf", file.dump()).positions_m, positions);
    fs::create_symlink("../outside.bin", folder_ / "in/link.bin");
    for (const std::string uri :
         {"../outside.bin", "buffers/../../outside.bin", "%2e%2e/outside.bin", "link.bin", "none.bin"}) {
        file["buffers"][0]["uri"] = uri;
        EXPECT_THAT(error("in/a.gltf", file.dump()), StartsWith("it cannot be read: ")) << uri;
    }
    file["buffers"][0]["uri"] = (folder_ / "outside.bin").string();
    EXPECT_THAT(error("in/a.gltf", file.dump()), StartsWith("it cannot be read: "));
}

TEST_F(GltfReader, StripsAndFansAreTriangles) {
    json file = triangle();
    file["meshes"][0]["primitives"][0]["mode"] = 5;
    EXPECT_EQ(read("a.gltf", file.dump()).triangles.size(), 1u);
    file["meshes"][0]["primitives"][0]["mode"] = 6;
    EXPECT_EQ(read("a.gltf", file.dump()).triangles.size(), 1u);
    file["meshes"][0]["primitives"][0]["mode"] = 1;
    EXPECT_EQ(error("a.gltf", file.dump()), "there are no triangles");
}

TEST_F(GltfReader, NumbersThatDoNotFitAreErrors) {
    EXPECT_EQ(error_with("/accessors/0/count", 4), "accessor 0 needs 48 bytes from byte 0 on, but there are 36");
    EXPECT_THAT(error_with("/accessors/0/count", uint64_t{1} << 60), HasSubstr("accessor 0 has 1152921504606846976"));
    EXPECT_THAT(error_with("/accessors/0/byteOffset", 4), HasSubstr("accessor 0 needs 36 bytes from byte 4 on"));
    EXPECT_THAT(error_with("/accessors/0/bufferView", 7), HasSubstr("it uses bufferView 7, but there are 1"));
    EXPECT_THAT(error_with("/accessors/0/type", "VEC2"), HasSubstr("accessor 0 has 2 numbers an element, must have 3"));
    EXPECT_THAT(error_with("/accessors/0/componentType", 5125),
                HasSubstr("components of type 5125, which no vertex has"));
    EXPECT_THAT(error_with("/bufferViews/0/byteLength", 4000000000u), HasSubstr("accessor 0 needs 4000000000 bytes"));
    EXPECT_THAT(error_with("/bufferViews/0/buffer", 3), HasSubstr("it uses buffer 3, but there are 1"));
    EXPECT_THAT(error_with("/nodes/0/mesh", 3), HasSubstr("it uses mesh 3, but there are 1"));
    EXPECT_THAT(error_with("/scenes/0/nodes", {5}), HasSubstr("it uses node 5, but there are 1"));
    EXPECT_THAT(error_with("/scene", 2), HasSubstr("it uses scene 2, but there are 1"));
    EXPECT_THAT(error_with("/nodes/0/children", {0}), HasSubstr("its node 0 has two parents"));
    EXPECT_THAT(error_with("/extensionsRequired", {"KHR_draco_mesh_compression"}), HasSubstr("compressed meshes are"));
    EXPECT_THAT(error_with("/accessors/0/sparse", {{"count", 1},
                                                   {"indices", {{"bufferView", 0}, {"componentType", 5123}}},
                                                   {"values", {{"bufferView", 0}}}}),
                HasSubstr("accessor 0 is sparse, which is not read"));
}

TEST_F(GltfReader, MeshesThatArePlacedWithoutEndAreRefused) {
    json file = triangle();
    for (int i = 1; i < 2100; ++i) {
        file["meshes"][0]["primitives"].push_back({{"attributes", json::object()}});
        file["scenes"][0]["nodes"].push_back(i);
        file["nodes"].push_back({{"mesh", 0}});
    }
    EXPECT_EQ(error("a.gltf", file.dump()), "its nodes place more than 4194304 primitives, the most that are read");
    std::string zeros(size_t{1} << 25, '0');
    for (size_t i = 1; i < zeros.size(); i += 2) zeros[i] = ',';
    EXPECT_EQ(error("a.gltf", "{\"extras\": [" + zeros + "0]}"),
              "its JSON has 16777216 commas, at most 8388608 are read");
}

TEST_F(GltfReader, ManyNodesInARowAndDeepJsonOverflowNothing) {
    json file = triangle();
    file["nodes"] = json::array();
    for (int i = 0; i < 50000; ++i) file["nodes"].push_back({{"children", {i + 1}}});
    file["nodes"].push_back({{"mesh", 0}});
    EXPECT_EQ(read("a.gltf", file.dump()).triangles.size(), 1u);
    EXPECT_THAT(error("a.gltf", "{\"extras\": " + std::string(100000, '[')), HasSubstr("nests deeper than 64 levels"));
    EXPECT_THAT(error("a.glb", "glTF"), HasSubstr("it is truncated"));
    const uint32_t header[5] = {0x46546c67, 2, 30, 4000000000u, 0x4e4f534a};
    EXPECT_THAT(error("a.glb", std::string(reinterpret_cast<const char*>(header), sizeof(header)) + "{}"),
                HasSubstr("its JSON has 4000000000 bytes, but 2 follow"));
}

}  // namespace
}  // namespace patina::scenes::mesh_readers_test
