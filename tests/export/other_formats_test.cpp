// A scene in formats other than glTF, read by parsers that share no code with the writers.

#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

#include <glm/gtc/constants.hpp>
#include <gmock/gmock.h>

#include "engine/core/latitude_longitude.h"
#include "engine/core/octahedral.h"
#include "export/environment.h"
#include "export/light_map.h"
#include "export/rewrite_glb.h"
#include "export/stored_zip.h"
#include "export/upright.h"
#include "export/write_obj.h"
#include "export/write_ply.h"
#include "export/write_usdz.h"
#include "sensor/files/exr_file.h"
#include "sensor/truth.h"
#include "tests/export/small_scene.h"
#include "tests/export/temporary_folder.h"
#include "tests/export/throws.h"
#include "tests/support/file_size_limit.h"

namespace patina::other_formats_test {
namespace {

using test::bytes_of;
using test::small_scene;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

template <class Value>
Value value_at(const std::string& bytes, size_t at) {
    Value value;
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    return value;
}

constexpr size_t kPlyVertex = 6 * 4 + 3 + 4 + 7 * 4;

TEST(WritePly, ReadsBack) {
    const TemporaryFolder folder;
    const SceneParts scene = small_scene();
    write_ply(folder / "a.ply", scene, PlyContent::kMesh);
    const std::string bytes = bytes_of(folder / "a.ply");
    const size_t first = bytes.find("end_header\n") + 11;
    EXPECT_THAT(bytes.substr(0, first), HasSubstr("element vertex 7\n"));
    EXPECT_THAT(bytes.substr(0, first), HasSubstr("element face 3\n"));
    ASSERT_EQ(bytes.size(), first + 7 * kPlyVertex + 3 * 13);
    EXPECT_EQ(value_at<glm::vec3>(bytes, first + 3 * kPlyVertex), scene.parts[0].positions_m[3]);
    EXPECT_NEAR(static_cast<uint8_t>(bytes[first + 24 + 1]), 188, 2);  // green, 0.5 as sRGB
    EXPECT_EQ(value_at<uint32_t>(bytes, first + 27), 1u);
    EXPECT_NEAR(value_at<float>(bytes, first + 31 + 4), 0.5f, 5e-3f);
    EXPECT_NEAR(value_at<float>(bytes, first + 43), 0.2f, 1e-6f);
    EXPECT_NEAR(value_at<float>(bytes, first + 55), 0.25f, 1e-6f);
    // Of the second segment the gloss was not observed.
    EXPECT_EQ(value_at<uint32_t>(bytes, first + 4 * kPlyVertex + 27), 2u);
    EXPECT_TRUE(std::isnan(value_at<float>(bytes, first + 4 * kPlyVertex + 55)));
    const size_t last = first + 7 * kPlyVertex + 2 * 13;
    EXPECT_EQ(bytes[last], '\3');
    for (size_t i = 0; i < 3; ++i)
        EXPECT_EQ(value_at<uint32_t>(bytes, last + 1 + 4 * i), 4 + scene.parts[1].triangles[0][i]);
}

TEST(WritePly, PointsHaveNoTriangles) {
    const TemporaryFolder folder;
    write_ply(folder / "a.ply", small_scene(), PlyContent::kPoints);
    const std::string bytes = bytes_of(folder / "a.ply");
    EXPECT_THAT(bytes, Not(HasSubstr("element face")));
    EXPECT_EQ(bytes.size(), bytes.find("end_header\n") + 11 + 7 * kPlyVertex);
}

TEST(WritePly, AFullDiskIsReported) {
    const TemporaryFolder folder;
    const SceneParts scene = small_scene();
    const test::FileSizeLimit limit(100);
    EXPECT_THAT([&] { write_ply(folder / "a.ply", scene, PlyContent::kMesh); }, test::throws_error_with("a.ply"));
}

std::map<std::string, std::string> obj_files(const SceneParts& scene) {
    std::map<std::string, std::string> files;
    write_obj("room", scene, [&](const std::string& name, std::string_view bytes) { files[name] = bytes; });
    return files;
}

TEST(WriteObj, ReadsBack) {
    const SceneParts scene = small_scene();
    const auto files = obj_files(scene);
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(files.at("room-1.png"), std::string(scene.pages[0].bytes.begin(), scene.pages[0].bytes.end()));
    std::vector<glm::vec3> vertices;
    std::vector<glm::vec2> places;
    std::vector<std::string> faces;
    std::istringstream text(files.at("room.obj"));
    for (std::string line, word; std::getline(text, line);) {
        std::istringstream words(line);
        words >> word;
        if (word == "v") words >> vertices.emplace_back().x >> vertices.back().y >> vertices.back().z;
        if (word == "vt") words >> places.emplace_back().x >> places.back().y;
        if (word == "f") faces.push_back(line);
    }
    ASSERT_EQ(vertices.size(), 7u);
    ASSERT_EQ(places.size(), 7u);
    EXPECT_LT(glm::distance(vertices[3], scene.parts[0].positions_m[3]), 1e-5f);
    EXPECT_NEAR(places[3].y, 1 - scene.parts[0].places[3].y, 1e-6f);
    const auto& [a, b, c] = scene.parts[1].triangles[0];
    std::ostringstream last;
    last << 'f';
    for (const uint32_t vertex : {a, b, c}) last << ' ' << 5 + vertex << '/' << 5 + vertex << '/' << 5 + vertex;
    ASSERT_EQ(faces.size(), 3u);
    EXPECT_EQ(faces.back(), last.str());
}

TEST(WriteObj, MaterialsHaveGlossAndPage) {
    const std::string text = obj_files(small_scene()).at("room.mtl");
    EXPECT_THAT(text, HasSubstr("newmtl wall_1.0.page1\n"));
    EXPECT_THAT(text, HasSubstr("Ns 30.000\n"));  // 2 / 0.25^2 - 2
    EXPECT_THAT(text, HasSubstr("map_Kd room-1.png\n"));
}

struct ZipEntry {
    std::string name, bytes;
    uint16_t method = 1;
    size_t first = 0;
};

/// By the list at the end of a ZIP file, as readers go about it.
std::vector<ZipEntry> entries_of(const std::string& zip) {
    const size_t end = zip.rfind("PK\5\6");
    size_t at = value_at<uint32_t>(zip, end + 16);
    std::vector<ZipEntry> entries;
    for (uint16_t i = 0; i < value_at<uint16_t>(zip, end + 10); ++i) {
        EXPECT_EQ(zip.substr(at, 4), "PK\1\2");
        const size_t size = value_at<uint32_t>(zip, at + 24), name = value_at<uint16_t>(zip, at + 28);
        const size_t local = value_at<uint32_t>(zip, at + 42);
        EXPECT_EQ(zip.substr(local, 4), "PK\3\4");
        const size_t first = local + 30 + value_at<uint16_t>(zip, local + 26) + value_at<uint16_t>(zip, local + 28);
        entries.push_back(
            {zip.substr(at + 46, name), zip.substr(first, size), value_at<uint16_t>(zip, at + 10), first});
        at += 46 + name;
    }
    return entries;
}

TEST(StoredZip, EntriesAreStoredAndAligned) {
    const TemporaryFolder folder;
    StoredZip zip(folder / "a.zip");
    std::vector<std::string> contents;
    for (size_t i = 0; i < 70; ++i) {
        contents.emplace_back(3 * i, 'x');
        zip.add(std::string(1 + i % 5, 'n'), contents.back());
    }
    zip.add("last", "123456789");
    zip.finish();
    const std::string bytes = bytes_of(folder / "a.zip");
    const std::vector<ZipEntry> entries = entries_of(bytes);
    ASSERT_EQ(entries.size(), 71u);
    for (size_t i = 0; i < 70; ++i) {
        EXPECT_EQ(entries[i].bytes, contents[i]);
        EXPECT_EQ(entries[i].method, 0);
        EXPECT_EQ(entries[i].first % 64, 0u);
    }
    // The check value of CRC-32.
    EXPECT_EQ(value_at<uint32_t>(bytes, bytes.rfind("PK\1\2") + 16), 0xcbf43926u);
}

TEST(WriteUsdz, HoldsTextAndPages) {
    const TemporaryFolder folder;
    const SceneParts scene = small_scene();
    write_usdz(folder / "a.usdz", scene);
    const std::vector<ZipEntry> entries = entries_of(bytes_of(folder / "a.usdz"));
    ASSERT_EQ(entries.size(), 2u);
    EXPECT_EQ(entries[0].name, "scene.usda");
    EXPECT_EQ(entries[1].name, "textures/page-1.png");
    EXPECT_EQ(entries[1].bytes, std::string(scene.pages[0].bytes.begin(), scene.pages[0].bytes.end()));
    const std::string& text = entries[0].bytes;
    EXPECT_TRUE(text.starts_with("#usda 1.0\n"));
    EXPECT_EQ(std::ranges::count(text, '{'), std::ranges::count(text, '}'));
    EXPECT_EQ(std::ranges::count(text, '('), std::ranges::count(text, ')'));
    EXPECT_EQ(std::ranges::count(text, '['), std::ranges::count(text, ']'));
    EXPECT_THAT(text, HasSubstr("asset inputs:file = @textures/page-1.png@"));
    EXPECT_THAT(text, HasSubstr("float inputs:roughness = 0.5000"));
    EXPECT_THAT(text, HasSubstr("bool observed = 1\n   float3 ks = (0.2, 0.2, 0.1)\n   float alpha = 0.25\n"));
    EXPECT_THAT(text, HasSubstr("doc = \"object \\\"2\\\"\""));
    EXPECT_THAT(text, HasSubstr("rel material:binding = </scene/materials/material_1_page_1>"));
    // The lamp has 600 candela in green.
    EXPECT_THAT(text, HasSubstr("def SphereLight \"light_1\""));
    EXPECT_THAT(text, HasSubstr("float inputs:intensity = 2400"));
}

TEST(WriteUsdz, AFlatLampIsADiscThatFacesItsAxis) {
    Light flat = test::kSmallLamp;
    flat.axis = {0, 1, 0};  // down
    const std::string text = usda_text(small_scene(flat), {"page-1.png"});
    EXPECT_THAT(text, HasSubstr("def DiskLight \"light_1\""));
    EXPECT_THAT(text, HasSubstr("float inputs:intensity = 600\n"));
    EXPECT_THAT(text, HasSubstr("quatf xformOp:orient = (0.707107, -0.707107, 0, 0)\n"));
    EXPECT_THAT(text, HasSubstr("xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]"));
}

TEST(WriteUsdz, AWindowIsARectangleThatShinesIntoTheRoom) {
    SceneParts scene = small_scene();
    std::string text = usda_text(scene, {"page-1.png"});
    EXPECT_THAT(text, HasSubstr("def RectLight \"window_1\"\n{\n color3f inputs:color = (0.5, 1, 0.25)\n"
                                " float inputs:intensity = 400\n float inputs:width = 0.8000\n"
                                " float inputs:height = 0.6000\n"));
    EXPECT_THAT(text, HasSubstr("double3 xformOp:translate = (0.500000, 1.000000, -2.000000)\n"
                                " quatf xformOp:orient = (1, 0, 0, 0)\n"))
        << "it shines along -z, as one that is not turned";
    scene.windows[0].half_u_m = {0, 0, -0.4};  // now it shines along +x
    text = usda_text(scene, {"page-1.png"});
    EXPECT_THAT(text, HasSubstr("quatf xformOp:orient = (0.707107, 0, -0.707107, 0)\n"));
}

TEST(LightMap, AddsUpToWhatArrives) {
    const Extent2D extent{256, 128};
    SceneParts scene;
    scene.lights = {{{0, 2, 0}, {4, 8, 2}, 0.1}, {{3, 0, 0}, {9, 9, 9}, 0}};
    const Image<glm::vec3> map = light_map(scene, glm::dvec3(0), extent);
    glm::dvec3 sum(0);
    for (uint32_t y = 0; y < extent.height; ++y) {
        const double tilt = glm::pi<double>() * (0.5 - (y + 0.5) / extent.height);
        const double solid_angle =
            2 * glm::pi<double>() / extent.width * glm::pi<double>() / extent.height * std::cos(tilt);
        for (uint32_t x = 0; x < extent.width; ++x) sum += glm::dvec3(map.at(x, y)) * solid_angle;
    }
    EXPECT_LT(glm::distance(sum, {2, 3, 1.5}), 0.02);
    EXPECT_GT(map.at(0, 0).g, 0);     // straight up
    EXPECT_GT(map.at(128, 64).g, 0);  // +x
    EXPECT_EQ(map.at(192, 64).g, 0);  // +z
    scene.lights[0].axis = {0, -0.6, 0.8};
    scene.lights[1].axis = {1, 0, 0};
    const Image<glm::vec3> flat = light_map(scene, glm::dvec3(0), extent);
    EXPECT_NEAR(flat.at(0, 0).g, 0.6f * map.at(0, 0).g, 1e-4f * map.at(0, 0).g);
    EXPECT_EQ(flat.at(128, 64).g, 0) << "it shines away";
}

TEST(LightMap, AmbientLightIsEverywhere) {
    SceneParts scene;
    scene.ambient = {0.1, 0.2, 0.3};
    const Image<glm::vec3> map = light_map(scene, glm::dvec3(0), {8, 4});
    for (const glm::vec3 pixel : map.pixels()) EXPECT_EQ(pixel, glm::vec3(0.1f, 0.2f, 0.3f));
}

/// What arrives of a picture's light, without what every pixel has.
glm::dvec3 arriving(const Image<glm::vec3>& map, glm::dvec3 everywhere) {
    glm::dvec3 sum(0);
    for (uint32_t y = 0; y < map.extent().height; ++y)
        for (uint32_t x = 0; x < map.extent().width; ++x)
            sum += (glm::dvec3(map.at(x, y)) - everywhere) * solid_angle_of_row(y, map.extent());
    return sum;
}

constexpr Extent2D kSmall{256, 128};

TEST(LightMap, EnvironmentHasAmbientLightAndSunsButNoLamps) {
    Scene scene;
    EXPECT_TRUE(environment_of(scene, kYDownToYUp, kSmall).empty());
    scene.lighting.lights = {{{0, -2, 0}, glm::dvec3(8), 0.1}};
    EXPECT_TRUE(environment_of(scene, kYDownToYUp, kSmall).empty()) << "scene.glb has the lamp";
    scene.lighting.ambient = {0.5, 0.25, 1};
    scene.lighting.lights.push_back({{0, -1e4, 0}, {3e8, 2e8, 1e8}, 0});
    const Image<glm::vec3> map = environment_of(scene, kYDownToYUp, kSmall);
    EXPECT_LT(glm::distance(arriving(map, scene.lighting.ambient), {3, 2, 1}), 1e-3);
    EXPECT_GT(map.at(0, 0).r, 100) << "the sun, straight up";
    EXPECT_EQ(map.at(128, 120), glm::vec3(0.5f, 0.25f, 1));
}

TEST(LightMap, EnvironmentShowsTheFarFieldWhereItIsKnown) {
    const auto radiance = [](glm::dvec3 direction) { return glm::dvec3(2) + direction; };
    Scene scene;
    scene.far_field = Image<glm::vec4>({32, 32});
    for (uint32_t y = 0; y < 32; ++y) {
        for (uint32_t x = 0; x < 32; ++x) {
            const glm::dvec3 direction = direction_of_octahedral((glm::dvec2(x, y) + 0.5) / 16.0 - 1.0);
            scene.far_field.at(x, y) = glm::vec4(radiance(direction), 1);
        }
    }
    const Image<glm::vec3> map = environment_of(scene, kYDownToYUp, kSmall);
    double most = 0;
    for (uint32_t y = 0; y < kSmall.height; ++y) {
        for (uint32_t x = 0; x < kSmall.width; ++x) {
            const glm::dvec3 in_world = glm::conjugate(kYDownToYUp) * direction_of_place({x + 0.5, y + 0.5}, kSmall);
            most = std::max(most, glm::distance(glm::dvec3(map.at(x, y)), radiance(in_world)));
        }
    }
    EXPECT_LT(most, 0.037) << "0.042 where the map's borders do not go on";
    for (glm::vec4& texel : scene.far_field.pixels()) texel.a = 0;
    scene.lighting.ambient = glm::dvec3(0.5);
    EXPECT_EQ(environment_of(scene, kYDownToYUp, kSmall).at(7, 9), glm::vec3(0.5));
}

/// A triangle.
Scene small_surface() {
    Scene scene;
    scene.mesh.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.mesh.normals.assign(3, {0, 0, -1});
    scene.mesh.colors.assign(3, glm::vec3(0.5f));
    scene.mesh.triangles = {{0, 2, 1}};
    scene.far_field = Image<glm::vec4>({32, 32}, glm::vec4(0.5, 0.5, 0.5, 1));
    return scene;
}

TEST(Windows, AreSavedInTheRecordedWorldAndInTheScene) {
    const TemporaryFolder folder;
    Scene scene = small_surface();
    scene.world_offset_m = {1000, 0, -2000};
    scene.lighting.windows = {{{0, -1, 2}, {0.5, 0, 0}, {0, 0.25, 0}, {3, 4, 5}, true}};
    scene.save(folder.path());
    const std::vector<AreaLight> saved = sensor::read_windows(folder / "lights.json");
    ASSERT_EQ(saved.size(), 1u);
    EXPECT_EQ(saved[0].center_m, glm::dvec3(1000, -1, -1998));
    EXPECT_EQ(saved[0].half_v_m, scene.lighting.windows[0].half_v_m);
    EXPECT_EQ(saved[0].radiance, scene.lighting.windows[0].radiance);
    EXPECT_TRUE(saved[0].clipped);
    const std::vector<AreaLight> windows = read_scene_parts(folder / "scene.glb").windows;
    ASSERT_EQ(windows.size(), 1u);
    EXPECT_LT(glm::distance(windows[0].radiance, {3, 4, 5}), 1e-9) << "on the environment's scale and back";
    scene.save_glb(folder / "alone.glb");
    EXPECT_TRUE(read_scene_parts(folder / "alone.glb").windows.empty()) << "without lamps and environment, no scale";
}

TEST(LightMap, TheEnvironmentBesideASceneIsTurnedWithIt) {
    const TemporaryFolder folder;
    Scene scene = small_surface();
    for (uint32_t y = 0; y < 8; ++y)  // around the direction (0, -1, 0)
        for (uint32_t x = 8; x < 24; ++x) scene.far_field.at(x, y) = glm::vec4(2, 2, 2, 1);
    scene.gravity = glm::dvec3(0, 1, 0);
    scene.save(folder.path());
    const auto lights = [&](const std::filesystem::path& glb) {
        SceneParts parts = read_scene_parts(glb);
        read_environment(parts, folder.path());
        return light_map(parts, glm::dvec3(0), {64, 32});
    };
    const Image<glm::vec3> map = lights(folder / "scene.glb");
    EXPECT_NEAR(map.at(16, 31).r, 0.5, 1e-5) << "in pixel values again";
    EXPECT_NEAR(map.at(16, 0).r, 2, 1e-5) << "up";
    rewrite_glb(folder / "scene.glb", folder / "down.glb", {.up = glm::dvec3(0, 1, 0)});
    const Image<glm::vec3> turned = lights(folder / "down.glb");
    EXPECT_NEAR(turned.at(16, 31).r, 2, 1e-5);
    EXPECT_NEAR(turned.at(16, 0).r, 0.5, 1e-5);
    // A white surface under it has 500 lux on average, as it may face any way.
    const Image<glm::vec3> written = sensor::read_exr_color(folder / "environment.exr");
    EXPECT_NEAR(arriving(written, glm::dvec3(0)).g / 4, 500, 0.1);
    scene.save_glb(folder / "alone.glb");
    EXPECT_EQ(read_scene_parts(folder / "alone.glb").environment_file, "");
}

}  // namespace
}  // namespace patina::other_formats_test
