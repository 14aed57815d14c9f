#include "export/scene_files.h"

#include <algorithm>
#include <utility>

#include "engine/core/version.h"
#include "export/drawable_mesh.h"
#include "export/materials.h"
#include "export/photometric.h"
#include "export/segment_names.h"
#include "export/trajectory.h"
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
    }
    return lighting;
}

Lighting in_recorded_world(const Scene& scene) {
    Lighting lighting = rounded(scene.lighting);
    for (Light& light : lighting.lights) light.position_m += scene.world_offset_m;
    return lighting;
}

GlbInfo glb_info(const Scene& scene, const SurfaceSurvey& survey, const SceneFileOptions& options,
                 const std::string& version) {
    UpHints hints{options.up, scene.gravity, {}};
    for (const TimedPose& pose : scene.trajectory) hints.cameras.push_back(pose.world_from_camera);
    const std::vector<Light> lights = rounded(scene.lighting).lights;
    const Upright upright = find_upright(hints, survey.patches());
    return {
        .version = version,
        .name = scene.name,
        .upright = upright,
        .world_offset_m = scene.world_offset_m,
        .segment_names = names_of_segments(scene.reflectance.segments, scene.segment_names, survey.patches(), upright),
        .lights = lights,
        .candela_per_intensity = candela_per_intensity(lights, survey.patches())};
}

WrittenGlb write_scene_glb(const std::filesystem::path& file, const Scene& scene, const GivePieces& pieces,
                           const SceneFileOptions& options, const std::string& version) {
    GlbWriter writer(file, options.glb);
    SurfaceSurvey survey;
    WrittenGlb written;
    const auto write = [&](const TidyPiece& piece) { writer.add(piece.mesh, &piece.reflectance); };
    std::vector<TidyPiece> held;
    uint64_t triangles = 0, loose = 0, collapsed = 0;
    pieces([&](const Mesh& mesh, const MeshReflectance& reflectance) {
        check_mesh(file, mesh);
        if (!reflectance.kd.empty()) check_reflectance(file, mesh, reflectance);
        survey.add(mesh, reflectance.labels);
        TidyPiece piece = tidied(mesh, reflectance, options.tidy);
        loose += piece.loose_triangles;
        collapsed += piece.collapsed_triangles;
        triangles += piece.mesh.triangles.size();
        if (options.tidy.most_triangles == 0) return write(piece);
        held.push_back(std::move(piece));
    });
    const double part =
        static_cast<double>(options.tidy.most_triangles) / static_cast<double>(std::max<uint64_t>(triangles, 1));
    for (TidyPiece& piece : held) {
        if (part >= 1) {
            write(piece);
            continue;
        }
        const TidyPiece fewer = reduced(piece.mesh, piece.reflectance, part);
        collapsed += fewer.collapsed_triangles;
        write(fewer);
        piece = {};
    }
    written.info = glb_info(scene, survey, options, version);
    written.summary = writer.finish(written.info);
    written.summary.loose_triangles = loose;
    written.summary.collapsed_triangles = collapsed;
    return written;
}

void Scene::save_glb(const std::filesystem::path& file) const {
    const auto whole = [this](const TakePiece& take) { take(mesh, reflectance); };
    put(file, [&](const auto& partial) { write_scene_glb(partial, *this, whole, {}, kVersion); });
}

void Scene::save(const std::filesystem::path& folder) const {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) throw Error("the folder '", folder.string(), "' cannot be made: ", failure.message());
    save_glb(folder / "scene.glb");
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
