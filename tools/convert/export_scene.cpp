#include "tools/convert/export_scene.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "engine/core/printable.h"
#include "export/light_map.h"
#include "export/scene_parts.h"
#include "export/viewer/write_viewer.h"
#include "export/write_exr.h"
#include "export/write_obj.h"
#include "export/write_ply.h"
#include "export/write_usdz.h"
#include "sensor/files/text_file.h"
#include "sensor/output/output_file.h"
#include "sensor/truth.h"
#include "tools/program/interrupt.h"
#include "tools/program/standard_streams.h"

namespace patina::tools {

namespace {

namespace fs = std::filesystem;

constexpr Extent2D kLightMap{2048, 1024};

/// Writes a file whole or not at all.
template <class Write>
void put(const fs::path& file, const fs::path& source, Write&& write) {
    sensor::OutputFile out(file, {source});
    write(out.partial_path());
    out.finish();
}

void put_bytes(const fs::path& file, const fs::path& source, std::string_view bytes) {
    put(file, source, [&](const fs::path& place) { sensor::write_bytes(place, bytes); });
}

void put_glb(const fs::path& file, const fs::path& scene) {
    const std::vector<uint8_t> bytes = read_file(scene, UINT32_MAX);
    put_bytes(file, scene, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void put_lods(const fs::path& file, const fs::path& scene, bool quiet) {
    const uint64_t triangles = triangles_in(scene);
    for (uint32_t level = 1; level <= kLods; ++level) {
        const fs::path coarse = lod_file(file, level);
        const GlbChanges changes{.triangles = triangles >> (2 * level), .halvings = level};
        uint64_t left = 0;
        put(coarse, scene, [&](const fs::path& place) {
            rewrite_glb(scene, place, changes);
            left = triangles_in(place);
        });
        if (!quiet) print_out("{}: {} triangles\n", printable(coarse.string()), left);
    }
}

void put_lights(const fs::path& file, const fs::path& source, const SceneParts& scene,
                const std::optional<glm::dvec3>& from_m) {
    if (scene.lights.empty() && scene.ambient == glm::dvec3(0) && scene.environment.empty())
        throw Error(file, " is not written: the scene in '", source.string(), "' has no lights");
    const auto [low, high] = bounds_of(scene);
    const Image<glm::vec3> map = light_map(scene, from_m.value_or(glm::dvec3(low + high) / 2.0), kLightMap);
    const float* first = &map.pixels().front().x;
    const std::vector<ExrChannel> channels{
        {"R", kLightMap, first, 3}, {"G", kLightMap, first + 1, 3}, {"B", kLightMap, first + 2, 3}};
    put(file, source, [&](const fs::path& place) { write_exr(place, channels); });
}

void put_obj(const fs::path& file, const fs::path& source, const SceneParts& scene) {
    write_obj(file.stem().string(), scene, [&](const std::string& name, std::string_view bytes) {
        put_bytes(file.parent_path() / name, source, bytes);
    });
}

void write_output(const SceneOutput& output, const fs::path& glb, const SceneParts& scene,
                  const ExportSceneOptions& options) {
    const fs::path& file = output.file;
    switch (output.format) {
        case SceneFormat::kGlb: return put_glb(file, glb);
        case SceneFormat::kPly:
        case SceneFormat::kPoints: {
            const auto content = output.format == SceneFormat::kPly ? PlyContent::kMesh : PlyContent::kPoints;
            return put(file, glb, [&](const fs::path& place) { write_ply(place, scene, content); });
        }
        case SceneFormat::kObj: return put_obj(file, glb, scene);
        case SceneFormat::kUsdz: return put(file, glb, [&](const fs::path& place) { write_usdz(place, scene); });
        case SceneFormat::kLights: return put_lights(file, glb, scene, options.from_m);
        case SceneFormat::kHtml: return put_bytes(file, glb, viewer_html(scene));
    }
}

/// For the user.
std::string content_of(SceneFormat format, const SceneParts& scene) {
    if (format == SceneFormat::kLights) {
        const bool from_afar = scene.ambient != glm::dvec3(0) || !scene.environment.empty();
        return fmt::format("{} lamps{}", scene.lights.size(), from_afar ? " and light from afar" : "");
    }
    if (format == SceneFormat::kPoints) return fmt::format("{} points", scene.vertices());
    return fmt::format("{} triangles of {} segments", scene.triangles(), scene.materials.size());
}

/// The scene's parts, with the ambient light that stands beside it, and the environment where it is `lit`.
SceneParts parts_of(const fs::path& glb, const fs::path& scene, bool lit) {
    SceneParts parts = read_scene_parts(glb);
    const fs::path lights = scene.parent_path() / "lights.json";
    if (path_exists(lights)) parts.ambient = sensor::read_ambient(lights);
    if (lit) read_environment(parts, scene.parent_path());
    return parts;
}

}  // namespace

SceneFormat format_by_ending(const fs::path& file) {
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
    if (ending == ".glb") return SceneFormat::kGlb;
    if (ending == ".ply") return SceneFormat::kPly;
    if (ending == ".obj") return SceneFormat::kObj;
    if (ending == ".usdz") return SceneFormat::kUsdz;
    if (ending == ".exr") return SceneFormat::kLights;
    if (ending == ".html") return SceneFormat::kHtml;
    throw Error("'", file.string(), "' ends in '", ending,
                "', which is no format of a scene: .glb, .ply, .obj, .usdz, .exr (lights) and .html are");
}

fs::path lod_file(const fs::path& glb, uint32_t level) {
    return glb.parent_path() / fmt::format("{}_lod{}{}", glb.stem().string(), level, glb.extension().string());
}

fs::path scene_at(const fs::path& source) {
    const fs::path scene = is_folder(source) ? source / "scene.glb" : source;
    if (!path_exists(scene)) throw Error("'", source.string(), "' is no finished scene: ", scene, " does not exist");
    return scene;
}

Outcome export_scene(const ExportSceneOptions& options) {
    const InterruptGuard interrupt;
    const fs::path scene = scene_at(options.source);
    std::optional<sensor::PartialFolder> changed;  // holds the changed scene
    fs::path glb = scene;
    if (options.changes.any()) {
        changed.emplace(options.outputs.front().file.string() + ".changed");
        glb = changed->path() / "scene.glb";
        rewrite_glb(scene, glb, options.changes);
    }
    const bool lit = std::ranges::any_of(
        options.outputs, [](const SceneOutput& output) { return output.format == SceneFormat::kLights; });
    const SceneParts parts = parts_of(glb, scene, lit);
    for (const SceneOutput& output : options.outputs) {
        if (interrupt.requested()) throw Interrupted("interrupted before '", output.file.string(), "' was written");
        write_output(output, glb, parts, options);
        if (!options.quiet) print_out("{}: {}\n", printable(output.file.string()), content_of(output.format, parts));
        if (options.lods && output.format == SceneFormat::kGlb) put_lods(output.file, glb, options.quiet);
    }
    return {};
}

}  // namespace patina::tools
