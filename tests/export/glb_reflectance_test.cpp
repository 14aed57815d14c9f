#include <cstring>

#include <gmock/gmock.h>
#include <tiny_gltf.h>

#include "export/gltf_material.h"
#include "export/write_glb.h"
#include "tests/export/temporary_folder.h"
#include "tests/export/test_meshes.h"
#include "tests/export/throws.h"

namespace patina::glb_reflectance_test {
namespace {

using test::TemporaryFolder;
using test::wavy_sheet;
using testing::DoubleNear;
using testing::ElementsAre;

const GlbInfo kInfo{.version = "1.2.3", .name = "kitchen"};

struct Scene {
    GlbSummary summary;
    tinygltf::Model model;
};

/// Of pieces, one or more.
Scene written_and_read(const std::vector<GlbScene>& pieces, const GlbInfo& info = kInfo,
                       const GlbOptions& options = {}) {
    const TemporaryFolder folder;
    Scene result;
    GlbWriter writer(folder / "a.glb", options);
    for (const GlbScene& piece : pieces) writer.add(piece.mesh, piece.reflectance);
    result.summary = writer.finish(info);
    std::string error, warning;
    EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&result.model, &error, &warning, folder / "a.glb")) << error;
    EXPECT_EQ(error + warning, "");
    return result;
}

template <class Element>
std::vector<Element> read(const tinygltf::Model& model, int index) {
    const tinygltf::Accessor& accessor = model.accessors.at(static_cast<size_t>(index));
    const tinygltf::BufferView& view = model.bufferViews.at(static_cast<size_t>(accessor.bufferView));
    EXPECT_EQ(view.byteOffset % 4, 0u);
    EXPECT_EQ(view.byteLength, accessor.count * sizeof(Element));
    std::vector<Element> elements(accessor.count);
    std::memcpy(static_cast<void*>(elements.data()), model.buffers.at(0).data.data() + view.byteOffset,
                view.byteLength);
    return elements;
}

/// A node's one primitive.
const tinygltf::Primitive& primitive(const tinygltf::Model& model, const std::string& node) {
    for (const tinygltf::Node& each : model.nodes) {
        if (each.name == node && each.mesh >= 0)
            return model.meshes.at(static_cast<size_t>(each.mesh)).primitives.at(0);
    }
    throw std::runtime_error("there is no node " + node);
}

template <class Element>
std::vector<Element> read(const tinygltf::Model& model, const std::string& node, const char* attribute) {
    return read<Element>(model, primitive(model, node).attributes.at(attribute));
}

const tinygltf::Material& material(const tinygltf::Model& model, const std::string& node) {
    return model.materials.at(static_cast<size_t>(primitive(model, node).material));
}

/// What a reader makes of the material in the file.
GltfMaterial material_of(const tinygltf::Material& material) {
    GltfMaterial result;
    result.metal = material.pbrMetallicRoughness.metallicFactor == 1;
    result.roughness = static_cast<float>(material.pbrMetallicRoughness.roughnessFactor);
    const auto vector_of = [](const auto& number) {
        return glm::vec3(static_cast<float>(number(0)), static_cast<float>(number(1)), static_cast<float>(number(2)));
    };
    result.base_color = vector_of([&](size_t c) { return material.pbrMetallicRoughness.baseColorFactor.at(c); });
    if (result.metal) return result;
    result.specular = 1;
    if (const auto found = material.extensions.find("KHR_materials_specular"); found != material.extensions.end()) {
        const tinygltf::Value &specular = found->second, &color = specular.Get("specularColorFactor");
        result.specular = static_cast<float>(specular.Get("specularFactor").GetNumberAsDouble());
        result.specular_color = vector_of([&](size_t c) { return color.Get(c).GetNumberAsDouble(); });
    }
    if (const auto ior = material.extensions.find("KHR_materials_ior"); ior != material.extensions.end())
        result.ior = static_cast<float>(ior->second.Get("ior").GetNumberAsDouble());
    return result;
}

/// A sheet whose lower half is segment 1 (glossy), the rest segment 2 (diffuse), with a kd that varies.
struct Sheet {
    Mesh mesh = wavy_sheet(6, 8);
    MeshReflectance reflectance;
    GlbInfo info = kInfo;

    Sheet() {
        info.segment_names = {"", "floor"};
        const size_t count = mesh.positions_m.size();
        for (size_t i = 0; i < count; ++i) {
            const float share = static_cast<float>(i) / static_cast<float>(count);
            reflectance.kd.emplace_back(0.8f * share, 0.3f, 0.5f - 0.4f * share, 1);
            reflectance.labels.push_back(i < count / 2 ? 1 : 2);
        }
        reflectance.segments.resize(3);
        reflectance.segments[1] = {glm::vec3(0.4f), WardGloss{{0.1f, 0.08f, 0.05f}, 0.3f}, 10, 100, 1};
        reflectance.segments[2].voxels = 10;
    }
    Scene write(const GlbOptions& options = {}) { return written_and_read({{mesh, &reflectance}}, info, options); }
};

TEST(GlbReflectance, EachSegmentHasItsNodeMeshAndMaterial) {
    const Scene scene = Sheet().write();
    ASSERT_EQ(scene.model.nodes.size(), 3u);
    EXPECT_THAT(scene.model.nodes[0].children, ElementsAre(1, 2));
    EXPECT_EQ(scene.model.nodes[1].name, "floor");
    EXPECT_EQ(scene.model.nodes[2].name, "object 2");
    EXPECT_EQ(scene.model.meshes.size(), 2u);
    EXPECT_EQ(material(scene.model, "floor").name, "floor");
    EXPECT_EQ(material(scene.model, "object 2").name, "object 2");
    EXPECT_EQ(scene.model.nodes[1].extras.Get("segment").GetNumberAsInt(), 1);
    EXPECT_EQ(scene.model.nodes[2].extras.Get("segment").GetNumberAsInt(), 2);
    EXPECT_THAT(scene.model.extensionsUsed, ElementsAre("KHR_materials_specular", "KHR_materials_ior"));
    EXPECT_EQ(scene.summary.triangles, 70u);
    EXPECT_EQ(scene.summary.vertices, 48u + 2 * 5u) << "vertices of triangles in between are both segments'";
    EXPECT_EQ(scene.summary.unknown_albedo, 0u);
}

TEST(GlbReflectance, KdKsAndAlphaConvertBackFromWhatAnyViewerReads) {
    const Sheet sheet;
    const Scene scene = Sheet(sheet).write({.raw_attributes = true});
    for (const std::string node : {"floor", "object 2"}) {
        const GltfMaterial shown = material_of(material(scene.model, node));
        const auto kd = read<glm::vec3>(scene.model, node, "_KD");
        const auto colors = read<std::array<uint16_t, 4>>(scene.model, node, "COLOR_0");
        ASSERT_EQ(kd.size(), colors.size());
        for (size_t i = 0; i < kd.size(); ++i) {
            const glm::vec3 base = glm::vec3(colors[i][0], colors[i][1], colors[i][2]) / 65535.0f;
            EXPECT_LT(glm::distance(kd_of(shown, base), kd[i]), 1.0f / 65535) << node << i;
        }
    }
    const WardGloss back = ward_of(material_of(material(scene.model, "floor")));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.ks[c], sheet.reflectance.segments[1].gloss->ks[c], 0.02f * back.ks[c]);
    EXPECT_NEAR(back.alpha, 0.3f, 0.02f * 0.3f);
    EXPECT_EQ(ward_of(material_of(material(scene.model, "object 2"))).ks, glm::vec3(0));
}

TEST(GlbReflectance, WithoutGlossThereIsNoHighlight) {
    const Scene scene = Sheet().write();
    const tinygltf::Material& diffuse = material(scene.model, "object 2");
    EXPECT_EQ(material_of(diffuse).ior, 1);
    EXPECT_EQ(diffuse.pbrMetallicRoughness.roughnessFactor, 1);
    EXPECT_FALSE(diffuse.extensions.contains("KHR_materials_specular"));
    EXPECT_FALSE(diffuse.extras.Get("ward").Get("observed").Get<bool>());
    EXPECT_FALSE(diffuse.extras.Get("ward").Has("ks"));
}

TEST(GlbReflectance, GlossThatWasNotObservedIsMarked) {
    Sheet sheet;
    sheet.reflectance.segments[1].gloss->confidence = 0.1f;
    const Scene guessed = sheet.write();
    const tinygltf::Material& floor = material(guessed.model, "floor");
    EXPECT_FALSE(floor.extras.Get("ward").Get("observed").Get<bool>());
    EXPECT_FLOAT_EQ(static_cast<float>(floor.extras.Get("ward").Get("guess").Get("ks").Get(0).GetNumberAsDouble()),
                    0.1f)
        << "the guess is told";
    EXPECT_FALSE(floor.extensions.contains("KHR_materials_specular")) << "Blender makes an image for each that has it";
    EXPECT_NEAR(material_of(floor).ior, 1.5f, 1e-6f)
        << "no more than glass, and said all the same: colours alone have none";
}

TEST(GlbReflectance, WithConstantFresnelTheSpecularColourHasTheStrength) {
    const Scene scene = Sheet().write({.fresnel = GltfFresnel::kConstant});
    EXPECT_THAT(scene.model.extensionsUsed, ElementsAre("KHR_materials_specular"));
    const GltfMaterial floor = material_of(material(scene.model, "floor"));
    EXPECT_NEAR(floor.specular_color.r, 25, 1e-4f);
    EXPECT_NEAR(ward_of(floor).ks.r, 0.1f, 1e-5f);
}

TEST(GlbReflectance, BaseColoursAbove1AreClampedAndCounted) {
    Sheet sheet;
    for (glm::vec4& kd : sheet.reflectance.kd) kd = {0.95f, 0.2f, 0.2f, 1};
    const Scene scene = sheet.write();
    const auto colors = read<std::array<uint16_t, 4>>(scene.model, "floor", "COLOR_0");
    EXPECT_EQ(colors.at(0)[0], 65535);
    EXPECT_EQ(scene.summary.clamped_colors, colors.size())
        << "0.95 / (1 - 0.08) is above 1; the other segment's is not";
}

TEST(GlbReflectance, ExactValuesAreInAttributesOnRequestAndInExtras) {
    const Sheet sheet;
    const Scene without = Sheet(sheet).write();
    for (const auto& [name, accessor] : primitive(without.model, "floor").attributes)
        EXPECT_NE(name.front(), '_') << name;
    const Scene scene = Sheet(sheet).write({.raw_attributes = true});
    const auto positions = read<glm::vec3>(scene.model, "floor", "POSITION");
    const auto kd = read<glm::vec3>(scene.model, "floor", "_KD"), ks = read<glm::vec3>(scene.model, "floor", "_KS");
    const auto alpha = read<float>(scene.model, "floor", "_WARD_ALPHA");
    ASSERT_TRUE(positions.size() == kd.size() && kd.size() == ks.size() && ks.size() == alpha.size());
    for (size_t i = 0; i < kd.size(); ++i) {
        const auto at = std::ranges::find(sheet.mesh.positions_m, positions[i]) - sheet.mesh.positions_m.begin();
        EXPECT_EQ(kd[i], glm::vec3(sheet.reflectance.kd[static_cast<size_t>(at)]));
        EXPECT_EQ(ks[i], sheet.reflectance.segments[1].gloss->ks);
        EXPECT_EQ(alpha[i], 0.3f);
    }
    const tinygltf::Value& ward = material(scene.model, "floor").extras.Get("ward");
    EXPECT_EQ(ward.Get("variant").Get<std::string>(), "ward");
    EXPECT_TRUE(ward.Get("observed").Get<bool>());
    EXPECT_FLOAT_EQ(static_cast<float>(ward.Get("alpha").GetNumberAsDouble()), 0.3f);
    EXPECT_FLOAT_EQ(static_cast<float>(ward.Get("ks").Get(2).GetNumberAsDouble()), 0.05f);
    EXPECT_FALSE(primitive(scene.model, "object 2").attributes.contains("_KS"));
    EXPECT_FALSE(primitive(scene.model, "object 2").attributes.contains("_WARD_ALPHA"));
}

TEST(GlbReflectance, AnUnknownKdIsTheSegmentsElseTheColour) {
    Sheet sheet;
    for (glm::vec4& kd : sheet.reflectance.kd) kd = glm::vec4(0);
    for (glm::vec3& color : sheet.mesh.colors) color = {0.5f, 1.5f, 0.25f};
    const Scene scene = sheet.write({.raw_attributes = true});
    for (const glm::vec3 kd : read<glm::vec3>(scene.model, "floor", "_KD")) EXPECT_EQ(kd, glm::vec3(0.4f));
    for (const glm::vec3 kd : read<glm::vec3>(scene.model, "object 2", "_KD")) EXPECT_EQ(kd, glm::vec3(0.5f, 1, 0.25f));
    EXPECT_EQ(scene.summary.unknown_albedo, read<glm::vec3>(scene.model, "object 2", "_KD").size());
}

TEST(GlbReflectance, AMetalHasABaseColourInsteadOfVertexColours) {
    Sheet sheet;
    sheet.reflectance.segments[1].kd = glm::vec3(0.01f);
    sheet.reflectance.segments[1].gloss = WardGloss{{0.9f, 0.6f, 0.3f}, 0.2f};
    const Scene scene = sheet.write();
    EXPECT_EQ(material(scene.model, "floor").pbrMetallicRoughness.metallicFactor, 1);
    EXPECT_TRUE(material(scene.model, "floor").extensions.empty());
    EXPECT_FALSE(primitive(scene.model, "floor").attributes.contains("COLOR_0"));
    EXPECT_NEAR(ward_of(material_of(material(scene.model, "floor"))).ks.g, 0.6f, 1e-4f);
}

TEST(GlbReflectance, WithoutLabelsAllIsTheSurface) {
    Sheet sheet;
    sheet.reflectance.labels.assign(sheet.mesh.positions_m.size(), 0);
    const Scene scene = sheet.write();
    ASSERT_EQ(scene.model.nodes.size(), 2u);
    EXPECT_EQ(scene.model.nodes[1].name, "surface");
    EXPECT_EQ(scene.summary.vertices, sheet.mesh.positions_m.size());
}

TEST(GlbReflectance, OfPiecesASegmentHasAPrimitiveEach) {
    const Sheet sheet;
    Sheet above;
    for (glm::vec3& position : above.mesh.positions_m) position.z += 1;
    Sheet of_one;  // of the second segment alone
    of_one.reflectance.labels.assign(of_one.mesh.positions_m.size(), 2);
    const Scene alone = Sheet().write();
    const Scene scene = written_and_read(
        {{sheet.mesh, &sheet.reflectance}, {above.mesh, &above.reflectance}, {of_one.mesh, &of_one.reflectance}},
        sheet.info);
    ASSERT_EQ(scene.model.nodes.size(), 3u);
    EXPECT_EQ(scene.model.materials.size(), 2u);
    ASSERT_EQ(scene.model.meshes.size(), 2u);
    EXPECT_EQ(scene.model.meshes[0].primitives.size(), 2u);
    EXPECT_EQ(scene.model.meshes[1].primitives.size(), 3u);
    EXPECT_EQ(scene.summary.vertices, 2 * alone.summary.vertices + of_one.mesh.positions_m.size());
    EXPECT_EQ(scene.summary.triangles, 3 * 70u);
    for (size_t mesh = 0; mesh < 2; ++mesh) {
        const auto& primitives = scene.model.meshes[mesh].primitives;
        for (const auto& primitive : primitives) EXPECT_EQ(primitive.material, static_cast<int>(mesh));
        const auto first = read<glm::vec3>(scene.model, primitives[0].attributes.at("POSITION"));
        EXPECT_EQ(first,
                  read<glm::vec3>(alone.model, alone.model.meshes[mesh].primitives[0].attributes.at("POSITION")));
        const auto second = read<glm::vec3>(scene.model, primitives[1].attributes.at("POSITION"));
        ASSERT_EQ(first.size(), second.size());
        for (size_t i = 0; i < first.size(); ++i) EXPECT_EQ(second[i], first[i] + glm::vec3(0, 0, 1));
    }
}

TEST(GlbReflectance, SunsAreToldAndLightNothing) {
    GlbInfo info = kInfo;
    info.suns = {{{0, -6000, 8000}, {2e8, 4e8, 1e8}}};
    const Scene scene = written_and_read({{wavy_sheet(2, 2)}}, info);
    EXPECT_TRUE(scene.model.lights.empty());
    const tinygltf::Value& extras = scene.model.scenes.at(0).extras;
    EXPECT_FALSE(extras.Has("photometric"));
    const tinygltf::Value& sun = extras.Get("suns").Get(0);
    const double direction[] = {0, -0.6, 0.8}, irradiance[] = {2, 4, 1};
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(sun.Get("direction").Get(i).GetNumberAsDouble(), direction[i], 1e-9);
        EXPECT_NEAR(sun.Get("irradiance").Get(i).GetNumberAsDouble(), irradiance[i], 1e-9);
    }
}

TEST(GlbReflectance, LightsAreNodesBelowTheRoot) {
    const Mesh mesh = wavy_sheet(2, 2);
    GlbInfo info = kInfo;
    info.lights = {{{1, -2, 3}, {2, 4, 1}, 0.05}, {{0, 0, 0}, {0, 0, 0}}};
    info.candela_per_intensity = 25;
    const Scene scene = written_and_read({{mesh}}, info);
    ASSERT_EQ(scene.model.lights.size(), 2u);
    EXPECT_EQ(scene.model.lights[0].type, "point");
    EXPECT_EQ(scene.model.lights[0].intensity, 100);
    const tinygltf::Value& photometric = scene.model.scenes.at(0).extras.Get("photometric");
    EXPECT_EQ(photometric.Get("candela_per_intensity").GetNumberAsDouble(), 25);
    EXPECT_THAT(photometric.Get("meaning").Get<std::string>(), testing::HasSubstr("500 lux"));
    EXPECT_THAT(scene.model.lights[0].color, ElementsAre(0.5, 1, 0.25));
    EXPECT_FALSE(scene.model.lights[0].extras.Get("calibrated").Get<bool>());
    EXPECT_EQ(scene.model.lights[0].extras.Get("radius_m").GetNumberAsDouble(), 0.05);
    EXPECT_EQ(scene.model.lights[1].intensity, 0);
    EXPECT_FALSE(scene.model.lights[1].extras.Has("radius_m"));
    ASSERT_EQ(scene.model.nodes.size(), 4u);
    EXPECT_EQ(scene.model.nodes[2].name, "light 1");
    EXPECT_THAT(scene.model.nodes[2].translation, ElementsAre(1, -2, 3));
    EXPECT_EQ(scene.model.nodes[3].extensions.at("KHR_lights_punctual").Get("light").GetNumberAsInt(), 1);
    EXPECT_THAT(scene.model.nodes[0].children, ElementsAre(1, 2, 3));
    EXPECT_THAT(scene.model.extensionsUsed, ElementsAre("KHR_lights_punctual"));
}

TEST(GlbReflectance, AFlatLampIsASpotOfItsPower) {
    const Mesh mesh = wavy_sheet(2, 2);
    GlbInfo info = kInfo;
    info.lights = {{{1, -2, 3}, {2, 4, 1}, 0.05, {0, 1, 0}}, {{1, -2, 3}, {2, 4, 1}, 0, {0, 0, 1}}};
    info.candela_per_intensity = 25;
    const Scene scene = written_and_read({{mesh}}, info);
    ASSERT_EQ(scene.model.lights.size(), 2u);
    const tinygltf::Light& spot = scene.model.lights[0];
    EXPECT_EQ(spot.type, "spot");
    EXPECT_EQ(spot.intensity, 100) << "along the axis";
    // Of the whole half space, times the squared share of cosines between both cones, as the extension recommends.
    const double inner = std::cos(spot.spot.innerConeAngle), outer = std::cos(spot.spot.outerConeAngle);
    double power = 0;
    for (int i = 0; i < 1000; ++i) {
        const double share = std::clamp(((i + 0.5) / 1000 - outer) / (inner - outer), 0.0, 1.0);
        power += share * share / 1000;
    }
    EXPECT_NEAR(power, 0.5, 1e-3) << "that of a cosine";
    // From -z to +y, and to +z.
    EXPECT_THAT(scene.model.nodes[2].rotation, ElementsAre(DoubleNear(std::sqrt(0.5), 1e-9), DoubleNear(0, 1e-9),
                                                           DoubleNear(0, 1e-9), DoubleNear(std::sqrt(0.5), 1e-9)));
    ASSERT_EQ(scene.model.nodes[3].rotation.size(), 4u);
    const std::vector<double>& q = scene.model.nodes[3].rotation;
    const glm::dvec3 turned = glm::dquat(q[3], q[0], q[1], q[2]) * glm::dvec3(0, 0, -1);
    EXPECT_LT(glm::distance(turned, {0, 0, 1}), 1e-9);
}

TEST(GlbReflectance, RefusesAnAlbedoThatIsNotFinite) {
    Sheet sheet;
    sheet.reflectance.kd[5].g = std::numeric_limits<float>::infinity();
    const TemporaryFolder folder;
    EXPECT_THAT(
        [&] {
            write_glb(folder / "a.glb", {sheet.mesh, &sheet.reflectance}, kInfo);
        },
        test::throws_error_with("albedo of vertex 5 of 48 is not finite"));
}

}  // namespace
}  // namespace patina::glb_reflectance_test
