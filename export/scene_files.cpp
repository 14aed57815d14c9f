#include "export/scene_files.h"

#include <algorithm>
#include <utility>

#include "engine/core/version.h"
#include "export/atlas/level_seams.h"
#include "export/drawable_mesh.h"
#include "export/fill_unseen.h"
#include "export/materials.h"
#include "export/photometric.h"
#include "export/segment_names.h"
#include "export/trajectory.h"
#include "sensor/files/exr_file.h"
#include "sensor/files/text_file.h"
#include "sensor/output/output_file.h"

namespace patina {

namespace {

glm::dvec3 rounded(glm::dvec3 v) { return glm::round(v * 1e6) / 1e6; }

/// Whole or not at all.
template <class Write>
void put(const std::filesystem::path& file, Write&& write) {
    sensor::OutputFile out(file);
    write(out.partial_path());
    out.finish();
}

}  // namespace

Lighting rounded(Lighting lighting) {
    lighting.ambient = rounded(lighting.ambient);
    for (Light& light : lighting.lights) {
        light.position_m = rounded(light.position_m);
        light.intensity = rounded(light.intensity);
        light.radius_m = rounded(glm::dvec3(light.radius_m)).x;
        light.axis = rounded(light.axis);
    }
    for (AreaLight& window : lighting.windows) {
        window.center_m = rounded(window.center_m);
        window.half_u_m = rounded(window.half_u_m);
        window.half_v_m = rounded(window.half_v_m);
        window.radiance = rounded(window.radiance);
    }
    return lighting;
}

Lighting in_recorded_world(const Scene& scene) {
    Lighting lighting = rounded(scene.lighting);
    for (Light& light : lighting.lights) light.position_m += scene.world_offset_m;
    for (AreaLight& window : lighting.windows) window.center_m += scene.world_offset_m;
    return lighting;
}

GlbInfo glb_info(const Scene& scene, const SurfaceSurvey& survey, const SceneFileOptions& options,
                 const std::string& version) {
    UpHints hints{options.up, scene.gravity, {}};
    for (const TimedPose& pose : scene.trajectory) hints.cameras.push_back(pose.world_from_camera);
    std::vector<Light> lights = rounded(scene.lighting).lights;
    const auto suns = std::stable_partition(lights.begin(), lights.end(), [](const Light& l) { return !is_sun(l); });
    const std::vector<Light> from_afar(suns, lights.end());
    lights.erase(suns, lights.end());
    const Upright upright = find_upright(hints, survey.patches());
    return {
        .version = version,
        .name = scene.name,
        .upright = upright,
        .world_offset_m = scene.world_offset_m,
        .segment_names = names_of_segments(scene.reflectance.segments, scene.segment_names, survey.patches(), upright),
        .lights = lights,
        .suns = from_afar,
        .windows = rounded(scene.lighting).windows,
        .candela_per_intensity = candela_per_intensity(lights, survey.patches())};
}

namespace {

/// Takes a surface piece by piece, tidied, and writes each at once, where nothing is asked for that needs all of it.
class TidiedSurface {
  public:
    TidiedSurface(std::filesystem::path file, GlbWriter& writer, const TidyOptions& options, bool hold)
        : file_(std::move(file)), writer_(writer), options_(options), hold_(hold || most_triangles() > 0) {}

    void add(const Mesh& mesh, const MeshReflectance& reflectance) {
        check_mesh(file_, mesh);
        if (!reflectance.kd.empty()) check_reflectance(file_, mesh, reflectance);
        const auto filled = filled_unseen(mesh, reflectance);
        if (!filled) return tidy(mesh, reflectance);
        unseen_ += filled->vertices;
        tidy(filled->mesh, filled->reflectance);
    }

    /// Brings what is held to the number of triangles that is asked for, and leaves out what that cut off.
    void reduce() {
        const uint64_t most = most_triangles();
        const double part = static_cast<double>(most) / static_cast<double>(std::max<uint64_t>(triangles_, 1));
        options_.in_pieces = held.size() > 1;
        for (TidyPiece& piece : held) {
            piece.loose_triangles = 0;
            if (most > 0 && part < 1) {
                const double most_error_m = options_.most_triangles ? kAnyError_m : kMostError_m;
                piece = reduced(piece, part, options_, most_error_m);
                collapsed_ += piece.collapsed_triangles;
            }
            leave_out_stray_parts(piece, options_);
            loose_ += piece.loose_triangles;
        }
    }

    uint64_t triangles_held() const {
        uint64_t triangles = 0;
        for (const TidyPiece& piece : held) triangles += piece.mesh.triangles.size();
        return triangles;
    }

    void count(GlbSummary& summary) const {
        summary.loose_triangles = loose_;
        summary.collapsed_triangles = collapsed_;
        summary.closed_holes = holes_;
        summary.unseen_vertices = unseen_;
    }

    SurfaceSurvey survey;
    std::vector<TidyPiece> held;

  private:
    static constexpr uint64_t kMostTriangles = 100'000;
    static constexpr double kMostError_m = 1e-2, kAnyError_m = 1e9;

    void tidy(const Mesh& mesh, const MeshReflectance& reflectance) {
        survey.add(mesh, reflectance.labels);
        TidyPiece piece = tidied(mesh, reflectance, options_);
        loose_ += piece.loose_triangles;
        collapsed_ += piece.collapsed_triangles;
        holes_ += piece.closed_holes;
        triangles_ += piece.mesh.triangles.size();
        if (hold_) {
            held.push_back(std::move(piece));
        } else {
            writer_.add(piece.mesh, &piece.reflectance, piece.filled);
        }
    }

    uint64_t most_triangles() const {
        return options_.most_triangles.value_or(options_.error_m > 0 ? kMostTriangles : 0);
    }

    std::filesystem::path file_;
    GlbWriter& writer_;
    TidyOptions options_;
    bool hold_;
    uint64_t triangles_ = 0, loose_ = 0, collapsed_ = 0, holes_ = 0, unseen_ = 0;
};

/// On the lamps' photometric scale; without lamps on one of its own.
void add_environment(const Scene& scene, const std::string& file, WrittenGlb& written) {
    GlbInfo& info = written.info;
    written.environment = environment_of(scene, info.upright.y_up_from_world);
    if (written.environment.empty()) return;
    const double scale =
        info.lights.empty() ? luminance_per_pixel_value(written.environment) : info.candela_per_intensity;
    for (glm::vec3& radiance : written.environment.pixels()) radiance *= static_cast<float>(scale);
    info.environment = GlbEnvironment{file, scale, info.upright.y_up_from_world};
}

}  // namespace

WrittenGlb write_scene_glb(const std::filesystem::path& file, const Scene& scene, const GivePieces& pieces,
                           const SceneFileOptions& options, const std::string& version, const BakeTexture& bake) {
    GlbWriter writer(file, options.glb);
    const bool textured = options.texture && bake;
    TidyOptions tidy = options.tidy;
    if (textured) tidy.white_m = 0;
    TidiedSurface surface(file, writer, tidy, textured);
    pieces([&](const Mesh& mesh, const MeshReflectance& reflectance) { surface.add(mesh, reflectance); });
    surface.reduce();
    uint64_t without_area = 0;  // has no place in a texture
    if (textured) {
        without_area = surface.triangles_held();
        const TextureLayout layout = lay_out_texture(std::move(surface.held), *options.texture);
        for (const TexturedSurface& piece : layout.pieces) without_area -= piece.mesh.triangles.size();
        std::vector<TexturePage> pages = bake(layout);
        level_seams(layout, pages);
        writer.add_textured(layout, pages);
    } else {
        for (TidyPiece& piece : surface.held) {
            writer.add(piece.mesh, &piece.reflectance, piece.filled);
            piece = {};
        }
    }
    WrittenGlb written;
    written.info = glb_info(scene, surface.survey, options, version);
    if (!options.environment.empty()) add_environment(scene, options.environment, written);
    written.summary = writer.finish(written.info);
    surface.count(written.summary);
    written.summary.degenerate_triangles += without_area;
    return written;
}

namespace {

/// scene.glb, in one piece.
WrittenGlb put_scene(const Scene& scene, const std::filesystem::path& file, const SceneFileOptions& options) {
    const auto whole = [&](const TakePiece& take) { take(scene.mesh, scene.reflectance); };
    WrittenGlb written;
    put(file, [&](const auto& partial) { written = write_scene_glb(partial, scene, whole, options, kVersion); });
    return written;
}

}  // namespace

void Scene::save_glb(const std::filesystem::path& file) const { put_scene(*this, file, {}); }

void Scene::save(const std::filesystem::path& folder) const {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) throw Error("the folder '", folder.string(), "' cannot be made: ", failure.message());
    const WrittenGlb written = put_scene(*this, folder / "scene.glb", {.environment = kEnvironmentFile});
    if (!written.environment.empty()) {
        put(folder / kEnvironmentFile,
            [&](const auto& partial) { sensor::write_exr_color(partial, written.environment); });
    }
    std::vector<TimedPose> poses = trajectory;
    for (TimedPose& pose : poses) pose.world_from_camera[3] += glm::dvec4(world_offset_m, 0);
    put(folder / "trajectory.txt", [&](const auto& partial) { sensor::write_bytes(partial, trajectory_text(poses)); });
    if (!reflectance.segments.empty()) {
        put(folder / "materials.json", [this](const auto& partial) {
            sensor::write_bytes(partial, materials_json(reflectance.segments, segment_names));
        });
    }
    if (!lighting.empty())
        put(folder / "lights.json", [this](const auto& partial) { write_lighting(partial, in_recorded_world(*this)); });
}

}  // namespace patina
