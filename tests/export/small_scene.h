#pragma once

#include <filesystem>

#include "export/scene_parts.h"
#include "export/write_glb.h"
#include "tests/export/temporary_folder.h"

namespace patina::test {

inline Upright lifted() {
    Upright upright;
    upright.floor_m = -1;
    return upright;
}

inline constexpr double kCandela = 100;
inline const Light kSmallLamp{{0.5, -2, 1}, {3, 6, 3}, 0.05};
inline const AreaLight kSmallWindow{{0.5, 0, 2}, {-0.4, 0, 0}, {0, -0.3, 0}, {2, 4, 1}, true};

/// Writes a scene.glb of two segments: 1 is a unit square at z = 1 in the corner of a page whose texels are `texel`, of
/// gloss that was observed; 2 is a triangle at z = 2, of gloss that was not. A normal map of half the page's size. The
/// world has y down, its floor at y = 1. One lamp and one window.
inline void write_small_glb(const std::filesystem::path& file, glm::vec3 texel = glm::vec3(0.25f, 0.5f, 0.125f),
                            const Light& light = kSmallLamp) {
    TextureLayout layout{0.002, {{64, 64}}, {}, {{0, {0, 0}, {64, 64}, 1}}};
    TexturedSurface& piece = layout.pieces.emplace_back();
    std::vector<SegmentReflectance>& segments = piece.reflectance.segments;
    segments.resize(3);
    segments[1] = {.kd = texel, .gloss = WardGloss{glm::vec3(0.2f, 0.2f, 0.1f), 0.25f, 0.9f}, .voxels = 9};
    segments[2] = {.kd = glm::vec3(0.5f), .gloss = WardGloss{glm::vec3(0.04f), 0.3f, 0.1f}, .voxels = 9};
    const auto add = [&](glm::vec3 at, glm::vec2 place, uint32_t label) {
        piece.mesh.positions_m.push_back(at);
        piece.mesh.normals.emplace_back(0, 0, -1);
        piece.mesh.colors.emplace_back(0.5f);
        piece.reflectance.kd.emplace_back(texel, 1.0f);
        piece.reflectance.labels.push_back(label);
        piece.place_px.push_back(place);
        piece.pages.push_back(0);
        piece.tangents.emplace_back(1, 0, 0, 1);
    };
    for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(1, 1)})
        add(glm::vec3(at, 1), 8.0f + 40.0f * at, 1);
    for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)})
        add(glm::vec3(at, 2), 50.0f + 6.0f * at, 2);
    piece.mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 6, 5}};
    TexturePage page{Image<glm::vec3>({64, 64}, texel), Image<TexelState>({64, 64}, TexelState::kSeen),
                     Image<glm::vec3>({32, 32}, glm::vec3(0.28f, 0, 0.96f))};
    GlbWriter writer(file);
    writer.add_textured(layout, {page});
    writer.finish({.version = "1.2.3",
                   .name = "small",
                   .upright = lifted(),
                   .segment_names = {"", "wall 1", "object \"2\""},
                   .lights = {light},
                   .windows = {kSmallWindow},
                   .candela_per_intensity = kCandela});
}

/// The same, read back.
inline SceneParts small_scene(const Light& light = kSmallLamp) {
    const TemporaryFolder folder;
    write_small_glb(folder / "scene.glb", glm::vec3(0.25f, 0.5f, 0.125f), light);
    return read_scene_parts(folder / "scene.glb");
}

}  // namespace patina::test
