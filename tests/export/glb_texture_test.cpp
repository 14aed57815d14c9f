// A surface that lies in a texture, in a scene.glb.

#include <cstring>

#include <gmock/gmock.h>
#include <tiny_gltf.h>

#include "engine/core/srgb.h"
#include "export/gltf_material.h"
#include "export/page_picture.h"
#include "export/write_glb.h"
#include "tests/export/temporary_folder.h"
#include "tests/export/textured_scene.h"

namespace patina::glb_texture_test {
namespace {

using test::painted;
using test::TemporaryFolder;
using test::three_quads;

struct Written {
    GlbSummary summary;
    tinygltf::Model model;
};

Written written_and_read(const TextureLayout& layout, const std::vector<TexturePage>& pages) {
    const TemporaryFolder folder;
    Written written;
    GlbWriter writer(folder / "a.glb");
    writer.add_textured(layout, pages);
    written.summary = writer.finish({.version = "1.2.3", .name = "kitchen"});
    std::string error, warning;
    EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&written.model, &error, &warning, folder / "a.glb")) << error;
    EXPECT_EQ(error + warning, "");
    return written;
}

const tinygltf::Mesh& mesh_of(const tinygltf::Model& model, const std::string& name) {
    for (const tinygltf::Mesh& mesh : model.meshes)
        if (mesh.name == name) return mesh;
    throw std::runtime_error("there is no mesh " + name);
}

const tinygltf::Material& material_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
    return model.materials.at(static_cast<size_t>(primitive.material));
}

const tinygltf::Image& image_of(const tinygltf::Model& model, const tinygltf::Material& material) {
    const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
    return model.images.at(static_cast<size_t>(model.textures.at(static_cast<size_t>(texture)).source));
}

TEST(GlbTexture, EachSegmentShowsItsPage) {
    const TextureLayout layout = three_quads();
    const Written written = written_and_read(layout, painted(layout, glm::vec3(0.2f, 0.4f, 0.1f)));
    EXPECT_EQ(written.summary.triangles, 6u);
    EXPECT_EQ(written.summary.texture_pages, 2u);
    EXPECT_EQ(written.summary.texel_m, 0.002);
    EXPECT_EQ(written.summary.seen_texels, 2u * 6 * 8);
    EXPECT_EQ(written.summary.filled_texels, 2u * 2 * 8);
    const tinygltf::Primitive& first = mesh_of(written.model, "object 1").primitives.at(0);
    EXPECT_TRUE(first.attributes.contains("TEXCOORD_0"));
    EXPECT_FALSE(first.attributes.contains("COLOR_0"));
    const tinygltf::Image& page = image_of(written.model, material_of(written.model, first));
    EXPECT_EQ(page.width, 64);
    EXPECT_EQ(page.height, 32);
    EXPECT_NEAR(page.extras.Get("seen").GetNumberAsDouble(), 0.75, 1e-9);
    EXPECT_EQ(page.extras.Get("texel_m").GetNumberAsDouble(), 0.002);
    // What is filled: texels 10 and 11 of rows 4 to 11.
    const int mask = page.extras.Get("seen_image").GetNumberAsInt();
    EXPECT_EQ(mask, 2) << "after the pages with colours";
    const tinygltf::Image& seen = written.model.images.at(static_cast<size_t>(mask));
    ASSERT_EQ(std::pair(seen.width, seen.height), std::pair(16, 8));
    for (size_t i = 0; i < 16 * 8; ++i) {
        const bool filled = i % 16 == 2 && (i / 16 == 1 || i / 16 == 2);
        EXPECT_EQ(seen.image.at(i * static_cast<size_t>(seen.component)), filled ? 0 : 255) << i;
    }
    const tinygltf::Primitive& second = mesh_of(written.model, "object 2").primitives.at(0);
    EXPECT_EQ(image_of(written.model, material_of(written.model, second)).width, 16);
}

TEST(GlbTexture, PlacesAreSharesOfThePage) {
    const TextureLayout layout = three_quads();
    const Written written = written_and_read(layout, painted(layout, glm::vec3(0.2f)));
    const tinygltf::Primitive& primitive = mesh_of(written.model, "object 1").primitives.at(0);
    const tinygltf::Accessor& accessor =
        written.model.accessors.at(static_cast<size_t>(primitive.attributes.at("TEXCOORD_0")));
    const tinygltf::BufferView& view = written.model.bufferViews.at(static_cast<size_t>(accessor.bufferView));
    std::vector<glm::vec2> places(accessor.count);
    std::memcpy(static_cast<void*>(places.data()), written.model.buffers.at(0).data.data() + view.byteOffset,
                view.byteLength);
    EXPECT_EQ(places.at(0), glm::vec2(4.0f / 64, 4.0f / 32));
    EXPECT_EQ(places.at(3), glm::vec2(12.0f / 64, 12.0f / 32));
}

TEST(GlbTexture, TexelsAreTheBaseColourOfTheirSegment) {
    const TextureLayout layout = three_quads();
    const glm::vec3 kd(0.2f, 0.4f, 0.1f);
    const Written written = written_and_read(layout, painted(layout, kd));
    for (const uint32_t label : {1u, 2u}) {
        const SegmentReflectance& segment = layout.pieces[0].reflectance.segments[label];
        const tinygltf::Primitive& primitive =
            mesh_of(written.model, "object " + std::to_string(label)).primitives.at(0);
        const tinygltf::Image& page = image_of(written.model, material_of(written.model, primitive));
        const GltfMaterial look = gltf_material(segment.gloss.value_or(WardGloss{}), *segment.kd);
        const glm::vec3 base = base_color_of(look, kd);
        const size_t texel = (size_t{8} * static_cast<size_t>(page.width) + 8) * static_cast<size_t>(page.component);
        for (size_t channel = 0; channel < 3; ++channel) {
            const double expected = 255 * srgb_encoded(double{base[static_cast<glm::length_t>(channel)]});
            EXPECT_NEAR(page.image.at(texel + channel), expected, 0.51) << "PNG keeps it";
        }
    }
}

TEST(GlbTexture, AMetalHasOneColourAndNoPage) {
    const TextureLayout layout = three_quads();
    const Written written = written_and_read(layout, painted(layout, glm::vec3(0.2f)));
    const tinygltf::Primitive& metal = mesh_of(written.model, "object 3").primitives.at(0);
    EXPECT_FALSE(metal.attributes.contains("TEXCOORD_0"));
    EXPECT_EQ(material_of(written.model, metal).pbrMetallicRoughness.baseColorTexture.index, -1);
    EXPECT_EQ(material_of(written.model, metal).pbrMetallicRoughness.metallicFactor, 1);
}

TEST(GlbTexture, DetailOfPagesIsANormalMap) {
    TextureLayout layout = three_quads();
    layout.pieces[0].tangents.resize(layout.pieces[0].place_px.size(), glm::vec4(0, 1, 0, -1));
    std::vector<TexturePage> pages = painted(layout, glm::vec3(0.2f));
    pages[0].detail = Image<glm::vec3>({32, 16}, glm::vec3(0.28f, -0.6f, 0.75f));
    pages[1].detail = Image<glm::vec3>({8, 8});
    const Written written = written_and_read(layout, pages);
    EXPECT_EQ(written.summary.texture_pages, 2u);
    EXPECT_EQ(written.summary.detail_pages, 2u);
    const auto shown = [&](const char* name) {
        const tinygltf::Primitive& primitive = mesh_of(written.model, name).primitives.at(0);
        const int texture = material_of(written.model, primitive).normalTexture.index;
        return written.model.images.at(
            static_cast<size_t>(written.model.textures.at(static_cast<size_t>(texture)).source));
    };
    const tinygltf::Image first = shown("object 1"), second = shown("object 2");
    EXPECT_EQ(first.width, 32);
    EXPECT_THAT(std::vector(first.image.begin(), first.image.begin() + 3), testing::ElementsAre(163, 51, 223));
    EXPECT_THAT(std::vector(second.image.begin(), second.image.begin() + 3), testing::ElementsAre(128, 128, 255))
        << "what is not known is flat";
    EXPECT_TRUE(mesh_of(written.model, "object 1").primitives.at(0).attributes.contains("TANGENT"));
    const tinygltf::Primitive& metal = mesh_of(written.model, "object 3").primitives.at(0);
    EXPECT_EQ(material_of(written.model, metal).normalTexture.index, -1);
    EXPECT_FALSE(metal.attributes.contains("TANGENT"));
}

TEST(GlbTexture, WithoutDetailThereIsNoNormalMap) {
    const TextureLayout layout = three_quads();
    const Written written = written_and_read(layout, painted(layout, glm::vec3(0.2f)));
    EXPECT_EQ(written.summary.detail_pages, 0u);
    const tinygltf::Primitive& primitive = mesh_of(written.model, "object 1").primitives.at(0);
    EXPECT_FALSE(primitive.attributes.contains("TANGENT"));
    EXPECT_EQ(material_of(written.model, primitive).normalTexture.index, -1);
}

TEST(GlbTexture, ASurfaceWithColoursAloneShowsThem) {
    TextureLayout layout = three_quads();
    layout.pieces[0].reflectance = {};
    for (TextureBox& box : layout.boxes) box.label = 0;
    const Written written = written_and_read(layout, painted(layout, glm::vec3(0.5f)));
    const tinygltf::Mesh& mesh = mesh_of(written.model, "surface");
    ASSERT_EQ(mesh.primitives.size(), 2u) << "one for each page";
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
        EXPECT_TRUE(primitive.attributes.contains("TEXCOORD_0"));
        EXPECT_FALSE(primitive.attributes.contains("COLOR_0"));
    }
}

TEST(PagePicture, WhatShowsNoSurfaceHasTheColoursAroundIt) {
    TexturePage page{Image<glm::vec3>({16, 3}), Image<TexelState>({16, 3}, TexelState::kEmpty)};
    page.kd.at(0, 1) = glm::vec3(0.2f);
    page.kd.at(15, 1) = glm::vec3(0.6f);
    page.states.at(0, 1) = TexelState::kSeen;
    page.states.at(15, 1) = TexelState::kFilled;
    const Image<SrgbPixel> picture =
        page_picture(page, {{0, {0, 0}, {16, 3}, 0}}, 0, [](uint32_t) { return 1.0f; }).picture;
    for (const uint32_t x : {0u, 1u, 5u}) EXPECT_NEAR(linear_color(picture.at(x, 0)).r, 0.2f, 0.003f) << x;
    for (const uint32_t x : {9u, 13u, 15u}) EXPECT_NEAR(linear_color(picture.at(x, 2)).r, 0.6f, 0.004f) << x;
}

TEST(PagePicture, ASegmentsFactorStaysInItsBoxAndWhatItClampsIsCounted) {
    TexturePage page{Image<glm::vec3>({4, 1}, glm::vec3(0.2f)), Image<TexelState>({4, 1}, TexelState::kSeen)};
    page.kd.at(2, 0) = glm::vec3(0.2f, 0.6f, 0.2f);
    const PagePicture page_shown = page_picture(page, {{0, {0, 0}, {2, 1}, 1}, {0, {2, 0}, {4, 1}, 2}}, 0,
                                                [](uint32_t label) { return label == 1 ? 1.0f : 2.0f; });
    EXPECT_NEAR(linear_color(page_shown.picture.at(1, 0)).r, 0.2f, 0.003f);
    EXPECT_NEAR(linear_color(page_shown.picture.at(2, 0)).r, 0.4f, 0.004f);
    EXPECT_EQ(page_shown.picture.at(2, 0).g, 255);
    EXPECT_EQ(page_shown.clamped, 1u);
}

TEST(GlbTexture, ClampedTexelsAreCounted) {
    const TextureLayout layout = three_quads();
    EXPECT_EQ(written_and_read(layout, painted(layout, glm::vec3(0.2f))).summary.clamped_texels, 0u);
    EXPECT_EQ(written_and_read(layout, painted(layout, glm::vec3(0.2f, 1.2f, 0.2f))).summary.clamped_texels, 128u)
        << "two pages of 64";
}

}  // namespace
}  // namespace patina::glb_texture_test
