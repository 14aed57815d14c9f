#include "export/write_glb.h"

#include <cstring>
#include <limits>

#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <tiny_gltf.h>

#include "export/glb_file.h"
#include "tests/export/temporary_folder.h"
#include "tests/export/test_meshes.h"
#include "tests/export/throws.h"
#include "tests/support/file_size_limit.h"

namespace patina::write_glb_test {
namespace {

using test::bytes_of;
using test::TemporaryFolder;
using test::throws_error_with;
using test::wavy_sheet;
using testing::ElementsAre;

const GlbInfo kInfo{.version = "1.2.3", .name = "kitchen"};

/// A written and re-read scene.
struct Scene {
    GlbSummary summary;
    tinygltf::Model model;
};

Scene written_and_read(const Mesh& mesh, const GlbInfo& info = kInfo) {
    const TemporaryFolder folder;
    Scene scene;
    scene.summary = write_glb(folder / "a.glb", GlbScene{mesh}, info);
    std::string error, warning;
    EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&scene.model, &error, &warning, folder / "a.glb")) << error;
    EXPECT_EQ(error + warning, "");
    return scene;
}

/// The elements of an accessor; checks that its format is the expected one.
template <class Element>
std::vector<Element> read(const tinygltf::Model& model, int index, int component, int type) {
    const tinygltf::Accessor& accessor = model.accessors.at(static_cast<size_t>(index));
    const tinygltf::BufferView& view = model.bufferViews.at(static_cast<size_t>(accessor.bufferView));
    EXPECT_EQ(accessor.componentType, component);
    EXPECT_EQ(accessor.type, type);
    EXPECT_EQ(view.byteOffset % 4, 0u);
    EXPECT_EQ(view.byteLength, accessor.count * sizeof(Element));
    std::vector<Element> elements(accessor.count);
    std::memcpy(static_cast<void*>(elements.data()), model.buffers.at(0).data.data() + view.byteOffset,
                view.byteLength);
    return elements;
}

const tinygltf::Primitive& primitive(const tinygltf::Model& model) { return model.meshes.at(0).primitives.at(0); }

std::vector<glm::vec3> read_vectors(const tinygltf::Model& model, const char* attribute) {
    return read<glm::vec3>(model, primitive(model).attributes.at(attribute), TINYGLTF_COMPONENT_TYPE_FLOAT,
                           TINYGLTF_TYPE_VEC3);
}

using Color = std::array<uint16_t, 4>;
std::vector<Color> read_colors(const tinygltf::Model& model) {
    return read<Color>(model, primitive(model).attributes.at("COLOR_0"), TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                       TINYGLTF_TYPE_VEC4);
}

template <class Index>
std::vector<Index> flat_triangles(const Mesh& mesh) {
    std::vector<Index> indices;
    for (const auto& triangle : mesh.triangles) {
        for (uint32_t vertex : triangle) indices.push_back(static_cast<Index>(vertex));
    }
    return indices;
}

TEST(WriteGlb, GeometryReadsBackExactly) {
    const Mesh mesh = wavy_sheet(5, 4);
    const Scene scene = written_and_read(mesh);
    EXPECT_EQ(read_vectors(scene.model, "POSITION"), mesh.positions_m);
    const std::vector<glm::vec3> normals = read_vectors(scene.model, "NORMAL");
    ASSERT_EQ(normals.size(), mesh.normals.size());
    for (size_t i = 0; i < normals.size(); ++i) EXPECT_LT(glm::distance(normals[i], mesh.normals[i]), 1e-6f);
    EXPECT_EQ(read<uint16_t>(scene.model, primitive(scene.model).indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                             TINYGLTF_TYPE_SCALAR),
              flat_triangles<uint16_t>(mesh));
    EXPECT_EQ(scene.summary.vertices, 20u);
    EXPECT_EQ(scene.summary.triangles, 24u);
    EXPECT_EQ(scene.summary.degenerate_triangles, 0u);
}

TEST(WriteGlb, BoundsAreExactlyTheStoredFloats) {
    Mesh mesh = wavy_sheet(3, 3);
    mesh.positions_m[4] = {-0.1f, 1.0f / 3.0f, 1e-7f};
    const Scene scene = written_and_read(mesh);
    const tinygltf::Accessor& accessor =
        scene.model.accessors.at(static_cast<size_t>(primitive(scene.model).attributes.at("POSITION")));
    glm::vec3 low = mesh.positions_m[0], high = low;
    for (const glm::vec3& p : mesh.positions_m) low = glm::min(low, p), high = glm::max(high, p);
    EXPECT_THAT(accessor.minValues, ElementsAre(low.x, low.y, low.z));
    EXPECT_THAT(accessor.maxValues, ElementsAre(high.x, high.y, high.z));
}

TEST(WriteGlb, ColoursAreLinearSixteenBitAndClampedOnesAreCounted) {
    Mesh mesh = wavy_sheet(2, 2);
    mesh.colors = {{0, 0.5f, 1}, {1.5f, -0.1f, 0.25f}, {0, 0, 0}, {1, 1, 1}};
    const Scene scene = written_and_read(mesh);
    EXPECT_THAT(read_colors(scene.model), ElementsAre(Color{0, 32768, 65535, 65535}, Color{65535, 0, 16384, 65535},
                                                      Color{0, 0, 0, 65535}, Color{65535, 65535, 65535, 65535}));
    EXPECT_EQ(scene.summary.clamped_colors, 1u);
    EXPECT_TRUE(
        scene.model.accessors.at(static_cast<size_t>(primitive(scene.model).attributes.at("COLOR_0"))).normalized);
}

TEST(WriteGlb, IndicesBecomeWideBeyond65535Vertices) {
    const auto sheet_of = [](uint32_t vertices) { return wavy_sheet(vertices / 3, 3); };
    const Mesh largest_short = sheet_of(65535), smallest_wide = sheet_of(65538);
    const Scene narrow = written_and_read(largest_short), wide = written_and_read(smallest_wide);
    EXPECT_EQ(read<uint16_t>(narrow.model, primitive(narrow.model).indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                             TINYGLTF_TYPE_SCALAR),
              flat_triangles<uint16_t>(largest_short));
    EXPECT_EQ(read<uint32_t>(wide.model, primitive(wide.model).indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                             TINYGLTF_TYPE_SCALAR),
              flat_triangles<uint32_t>(smallest_wide));
}

TEST(WriteGlb, SceneSaysWhatItIs) {
    const Scene scene = written_and_read(wavy_sheet(2, 2));
    const tinygltf::Model& model = scene.model;
    EXPECT_EQ(model.asset.generator, "Patina 1.2.3");
    EXPECT_EQ(model.asset.version, "2.0");
    EXPECT_THAT(model.scenes.at(0).nodes, ElementsAre(0));
    EXPECT_EQ(model.nodes.at(0).name, "kitchen");
    EXPECT_THAT(model.nodes.at(0).children, ElementsAre(1));
    EXPECT_EQ(model.nodes.at(1).name, "surface");
    EXPECT_EQ(model.meshes.at(0).name, "surface");
    EXPECT_EQ(model.materials.at(0).pbrMetallicRoughness.metallicFactor, 0);
    EXPECT_EQ(model.materials.at(0).pbrMetallicRoughness.roughnessFactor, 1);
    EXPECT_THAT(model.extensionsRequired, ElementsAre());
}

glm::dvec3 turned_by_root(const tinygltf::Model& model, glm::dvec3 world) {
    const std::vector<double>& q = model.nodes.at(0).rotation;
    return glm::dquat(q.at(3), q.at(0), q.at(1), q.at(2)) * world;
}

TEST(WriteGlb, RootNodeTurnsTheWorldUpright) {
    const tinygltf::Model camera_world = written_and_read(wavy_sheet(2, 2)).model;
    EXPECT_LT(glm::distance(turned_by_root(camera_world, {0, -1, 0}), glm::dvec3(0, 1, 0)), 1e-12);
    EXPECT_LT(glm::distance(turned_by_root(camera_world, {1, 0, 0}), glm::dvec3(1, 0, 0)), 1e-12);
    EXPECT_LT(glm::distance(turned_by_root(camera_world, {0, 0, 1}), glm::dvec3(0, 0, -1)), 1e-12);

    GlbInfo z_up = kInfo;
    z_up.upright = {UpSource::kOption, glm::angleAxis(glm::radians(-90.0), glm::dvec3(1, 0, 0)), 1.5};
    const tinygltf::Model other = written_and_read(wavy_sheet(2, 2), z_up).model;
    EXPECT_LT(glm::distance(turned_by_root(other, {0, 0, 1}), glm::dvec3(0, 1, 0)), 1e-12);
    EXPECT_THAT(other.nodes.at(0).translation, ElementsAre(0, -1.5, 0)) << "the floor comes to height 0";
    EXPECT_TRUE(camera_world.nodes.at(0).translation.empty());
}

TEST(WriteGlb, DegenerateTrianglesAreLeftOut) {
    Mesh mesh = wavy_sheet(3, 2);
    const std::vector<uint16_t> kept = flat_triangles<uint16_t>(mesh);
    mesh.positions_m.push_back(mesh.positions_m[0]);  // vertex 6 coincides with vertex 0
    mesh.normals.push_back({0, 0, 1});
    mesh.colors.push_back({});
    mesh.positions_m[5] = mesh.positions_m[3] + 2.0f * (mesh.positions_m[4] - mesh.positions_m[3]);
    mesh.triangles.push_back({1, 1, 2});  // a repeated vertex
    mesh.triangles.push_back({0, 6, 4});  // two corners at one point
    mesh.triangles.push_back({3, 4, 5});  // three in a line
    const Scene scene = written_and_read(mesh);
    EXPECT_EQ(scene.summary.degenerate_triangles, 3u);
    EXPECT_EQ(scene.summary.triangles, mesh.triangles.size() - 3);
    EXPECT_EQ(read<uint16_t>(scene.model, primitive(scene.model).indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                             TINYGLTF_TYPE_SCALAR),
              kept);
}

TEST(WriteGlb, NormalsBecomeUnitLengthAndMissingOnesAreReplaced) {
    Mesh mesh = wavy_sheet(2, 2);
    for (glm::vec3& position : mesh.positions_m) position.z = 0;
    mesh.positions_m.emplace_back(9, 9, 9);  // of no triangle
    mesh.colors.push_back({});
    mesh.normals = {{0, 0, 1.01f}, {0.3f, 0, 0.3f}, {0, 0, 0}, {0, 1e-20f, 0}, {0, 0, 0}};
    const std::vector<glm::vec3> normals = read_vectors(written_and_read(mesh).model, "NORMAL");
    const float diagonal = std::sqrt(0.5f);
    const std::vector<glm::vec3> expected = {{0, 0, 1}, {diagonal, 0, diagonal}, {0, 0, 1}, {0, 1, 0}, {0, 0, 1}};
    ASSERT_EQ(normals.size(), expected.size());
    for (size_t i = 0; i < normals.size(); ++i) EXPECT_LT(glm::distance(normals[i], expected[i]), 1e-6f) << i;
}

TEST(WriteGlb, WithoutATriangleTheSurfaceNodeHasNoMesh) {
    Mesh only_degenerate = wavy_sheet(2, 2);
    only_degenerate.triangles = {{0, 0, 1}};
    for (const Mesh& mesh : {Mesh{}, only_degenerate}) {
        const Scene scene = written_and_read(mesh);
        EXPECT_EQ(scene.model.nodes.at(1).mesh, -1);
        EXPECT_TRUE(scene.model.meshes.empty() && scene.model.buffers.empty() && scene.model.materials.empty());
        EXPECT_EQ(scene.summary.vertices + scene.summary.triangles, 0u);
        EXPECT_EQ(scene.summary.degenerate_triangles, mesh.triangles.size());
    }
}

TEST(WriteGlb, TheSameMeshGivesTheSameBytes) {
    const TemporaryFolder folder;
    write_glb(folder / "a.glb", GlbScene{wavy_sheet(40, 30)}, kInfo);
    write_glb(folder / "b.glb", GlbScene{wavy_sheet(40, 30)}, kInfo);
    const std::string bytes = bytes_of(folder / "a.glb");
    EXPECT_EQ(bytes, bytes_of(folder / "b.glb"));
    EXPECT_EQ(bytes.size() % 4, 0u);
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
}

TEST(WriteGlb, RefusesWhatIsNotFinite) {
    const TemporaryFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    Mesh mesh = wavy_sheet(2, 2);
    mesh.positions_m[3].y = nan;
    EXPECT_THAT([&] { write_glb(folder / "a.glb", GlbScene{mesh}, kInfo); },
                throws_error_with("position of vertex 3 of 4 is not finite"));
    mesh = wavy_sheet(2, 2);
    mesh.normals[1].x = infinity;
    EXPECT_THAT([&] { write_glb(folder / "a.glb", GlbScene{mesh}, kInfo); },
                throws_error_with("normal of vertex 1 of 4 is not finite"));
    mesh = wavy_sheet(2, 2);
    mesh.colors[0].z = nan;
    EXPECT_THAT([&] { write_glb(folder / "a.glb", GlbScene{mesh}, kInfo); },
                throws_error_with("colour of vertex 0 of 4 is not finite"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.glb"));
}

TEST(WriteGlb, RefusesIndicesBeyondTheVertices) {
    const TemporaryFolder folder;
    Mesh mesh = wavy_sheet(2, 2);
    mesh.triangles.push_back({0, 1, 4});
    EXPECT_THAT([&] { write_glb(folder / "a.glb", GlbScene{mesh}, kInfo); },
                throws_error_with("a triangle names vertex 4 of 4"));
}

TEST(WriteGlb, RefusesMoreThanAGlbCanHold) {
    const TemporaryFolder folder;
    const std::vector<std::byte> bytes(1000);
    tinygltf::Model model;
    model.asset.version = "2.0";
    {
        GlbFile file(folder / "a.glb", 2100);
        EXPECT_EQ(file.append(std::span(bytes).first(998)), 0u);
        EXPECT_EQ(file.append(bytes), 1000u) << "arrays begin at multiples of four";
        EXPECT_THAT([&] { file.append(std::span(bytes).first(80)); },
                    throws_error_with("holds at most 2100 bytes, but the scene needs 2108 or more"));
        file.finish(model);
    }
    EXPECT_EQ(bytes_of(folder / "a.glb").size() % 4, 0u);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.glb.buffer"));
    {
        GlbFile file(folder / "b.glb", 1060);
        file.append(bytes);
        EXPECT_THAT([&] { file.finish(model); }, throws_error_with("a GLB file holds at most 1060 bytes"))
            << "the JSON counts";
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "b.glb") || std::filesystem::exists(folder / "b.glb.buffer"));
}

TEST(WriteGlb, SaysThatTheDiskRefused) {
    const TemporaryFolder folder;
    {
        const test::FileSizeLimit limit(1000);
        EXPECT_THAT([&] { write_glb(folder / "a.glb", GlbScene{wavy_sheet(9, 9)}, kInfo); },
                    throws_error_with("a.glb.buffer cannot be written"));
    }
    {
        const test::FileSizeLimit limit(3500);
        EXPECT_THAT([&] { write_glb(folder / "a.glb", GlbScene{wavy_sheet(9, 9)}, kInfo); },
                    throws_error_with("a.glb cannot be written"))
            << "there was room for the buffer, of 81 vertices and 128 triangles, and none for the JSON besides";
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "a.glb.buffer"));
    EXPECT_THAT([] { write_glb("/proc/a.glb", GlbScene{Mesh{}}, kInfo); },
                throws_error_with("/proc/a.glb.buffer cannot be written"));
}

}  // namespace
}  // namespace patina::write_glb_test
