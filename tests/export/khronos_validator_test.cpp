#include <array>
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "export/write_glb.h"
#include "tests/export/temporary_folder.h"
#include "tests/export/test_meshes.h"
#include "tests/export/textured_scene.h"

namespace patina::khronos_validator_test {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using test::wavy_sheet;

const fs::path kSource = PATINA_SOURCE_DIR;

/// What a shell command printed, and its exit status.
struct Outcome {
    std::string output;
    int status;
};

Outcome run(const std::string& command) {
    Outcome outcome{{}, -1};
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    if (!pipe) return outcome;
    std::array<char, 4096> chunk;
    for (size_t got; (got = fread(chunk.data(), 1, chunk.size(), pipe)) > 0;) outcome.output.append(chunk.data(), got);
    outcome.status = WEXITSTATUS(pclose(pipe));
    return outcome;
}

Outcome validate(const fs::path& file) {
    return run("node '" + (kSource / "tools/validate_gltf.mjs").string() + "' '" + file.string() + "'");
}

class KhronosValidator : public testing::Test {
  protected:
    void SetUp() override {
        if (run("node --version").status != 0) GTEST_SKIP() << "node is not installed";
        if (!fs::exists(kSource / "node_modules/gltf-validator")) {
            GTEST_SKIP() << "node_modules/gltf-validator is missing: run npm ci in " << kSource;
        }
    }

    void expect_valid(const Mesh& mesh) { expect_valid(GlbScene{mesh}); }
    void expect_valid(const GlbScene& scene) {
        write_glb(file_, scene, {.version = "0.0"});
        expect_valid_file();
    }
    void expect_valid_file() {
        const Outcome outcome = validate(file_);
        EXPECT_EQ(outcome.status, 0) << outcome.output;
        EXPECT_NE(outcome.output.find(" 0 errors, 0 warnings,"), std::string::npos) << outcome.output;
    }

    const TemporaryFolder folder_;
    const fs::path file_ = folder_ / "scene.glb";
};

TEST_F(KhronosValidator, AcceptsASmallScene) { expect_valid(wavy_sheet(3, 3)); }

TEST_F(KhronosValidator, AcceptsAnOddNumberOfShortIndices) {
    Mesh mesh = wavy_sheet(2, 2);
    mesh.triangles.pop_back();
    expect_valid(mesh);
}

TEST_F(KhronosValidator, AcceptsTheMostVerticesOfShortIndices) { expect_valid(wavy_sheet(21845, 3)); }

TEST_F(KhronosValidator, AcceptsWideIndices) { expect_valid(wavy_sheet(300, 300)); }

TEST_F(KhronosValidator, AcceptsAnEmptyScene) { expect_valid({}); }

TEST_F(KhronosValidator, AcceptsDegenerateInput) {
    Mesh mesh = wavy_sheet(3, 3);
    mesh.triangles.push_back({0, 0, 1});
    mesh.normals.assign(9, glm::vec3(0));
    expect_valid(mesh);
}

TEST_F(KhronosValidator, AcceptsSegmentsMaterialsAndLights) {
    const Mesh mesh = wavy_sheet(7, 9);
    MeshReflectance reflectance;
    for (uint32_t i = 0; i < 63; ++i) {
        reflectance.kd.emplace_back(0.01f * static_cast<float>(i), 0.5f, 0.9f, i % 7 == 0 ? 0 : 1);
        reflectance.labels.push_back(i / 16);
    }
    reflectance.segments.resize(4);
    reflectance.segments[1].gloss = WardGloss{glm::vec3(0.2f, 0.1f, 0.05f), 0.1f};
    reflectance.segments[2] = {glm::vec3(0.01f), WardGloss{glm::vec3(0.8f), 0.2f}, 1, 1, 1};  // a metal
    const GlbInfo info{.version = "0.0",
                       .upright = {UpSource::kFloor, y_up_from({0.1, 0.2, 0.9}), 1.25},
                       .segment_names = {"", "glossy", "metal", "diffuse \"one\""},
                       .lights = {{{1, 2, 3}, {4, 5, 6}, 0.1}, {{0, 0, 0}, {0, 0, 0}}},
                       .candela_per_intensity = 42};
    for (const GltfFresnel fresnel : {GltfFresnel::kIor, GltfFresnel::kConstant}) {
        GlbWriter writer(file_, {.fresnel = fresnel, .raw_attributes = fresnel == GltfFresnel::kConstant});
        for (int piece = 0; piece < 3; ++piece) writer.add(mesh, &reflectance);
        writer.finish(info);
        expect_valid_file();
    }
}

TEST_F(KhronosValidator, AcceptsPagesNormalMapsAndASun) {
    TextureLayout layout = test::three_quads();  // the third is a metal
    layout.pieces[0].tangents.resize(layout.pieces[0].place_px.size(), glm::vec4(0, 1, 0, -1));
    std::vector<TexturePage> pages = test::painted(layout, glm::vec3(0.2f, 1.2f, 0.1f));
    for (const bool detailed : {false, true}) {
        if (detailed)
            for (TexturePage& page : pages)
                page.detail = Image<glm::vec3>({page.kd.extent().width / 2, page.kd.extent().height / 2},
                                               glm::vec3(0.28f, -0.6f, 0.75f));
        GlbWriter writer(file_);
        writer.add_textured(layout, pages);
        writer.finish({.version = "0.0",
                       .lights = {{{1, 2, 3}, {4, 5, 6}, 0.1}},
                       .suns = {{{0, 0, 10'000}, {4e8, 5e8, 6e8}, 46}},
                       .windows = {{{1, 2, 3}, {1, 0, 0}, {0, 1, 0}, {4, 5, 6}, false}},
                       .candela_per_intensity = 42});
        expect_valid_file();
        EXPECT_EQ(test::bytes_of(file_).find("\"normalTexture\"") != std::string::npos, detailed);
        EXPECT_NE(test::bytes_of(file_).find("\"suns\""), std::string::npos);
    }
}

TEST_F(KhronosValidator, RejectsADamagedScene) {
    const fs::path file = folder_ / "scene.glb";
    write_glb(file, GlbScene{wavy_sheet(3, 3)}, {.version = "0.0"});
    std::string bytes = test::bytes_of(file);
    const size_t at = bytes.find("\"max\":[");
    ASSERT_NE(at, std::string::npos);
    bytes[at + 7] = '7';
    std::ofstream(file, std::ios::binary) << bytes;
    const Outcome outcome = validate(file);
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("ACCESSOR_MAX_MISMATCH"), std::string::npos) << outcome.output;
    EXPECT_EQ(validate(folder_ / "missing.glb").status, 2);
}

}  // namespace
}  // namespace patina::khronos_validator_test
