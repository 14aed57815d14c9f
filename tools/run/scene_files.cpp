#include "tools/run/scene_files.h"

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

#include "export/materials.h"
#include "export/write_tiles.h"
#include "sensor/files/exr_file.h"

namespace patina::tools {

void SceneFiles::write_lists(OutputFolder& folder) const {
    if (!scene_.reflectance.segments.empty())
        folder.write("materials.json", materials_json(scene_.reflectance.segments, scene_.segment_names));
    if (const Lighting lighting = in_recorded_world(scene_); !lighting.empty()) {
        write_lighting(folder.stage("lights.json"), lighting);
        folder.publish("lights.json");
    }
}

GlbSummary SceneFiles::write_glb(OutputFolder& folder, const GivePieces& pieces, const std::string& version,
                                 const BakeTexture& bake) {
    const WrittenGlb written = write_scene_glb(folder.stage("scene.glb"), scene_, pieces, options_, version, bake);
    folder.publish("scene.glb");
    if (!written.environment.empty()) {
        sensor::write_exr_color(folder.stage(options_.environment), written.environment);
        folder.publish(options_.environment);
    }
    info_ = written.info;
    return written.summary;
}

GlbSummary SceneFiles::write_tiles(OutputFolder& folder, const GivePieces& pieces, const std::string& version) {
    if (!info_) {
        SurfaceSurvey survey;
        pieces([&](const Mesh& mesh, const MeshReflectance& reflectance) { survey.add(mesh, reflectance.labels); });
        info_ = glb_info(scene_, survey, options_, version);
    }
    const auto write = [&](const std::string& name, const auto& write_to) {
        write_to(folder.stage("tiles/" + name));
        folder.publish("tiles/" + name);
    };
    TileWriter writer(write, *info_, options_.glb);
    pieces([&](const Mesh& mesh, const MeshReflectance& reflectance) { writer.add(mesh, reflectance); });
    return writer.finish();
}

namespace {

/// As in scene.glb; the transform is of the recording's world, row by row.
nlohmann::ordered_json gltf_json(const GlbInfo& info) {
    const glm::dvec3 up = info.upright.up();
    const RigidTransform gltf_from_world =
        info.upright.gltf_from_world() * glm::translate(RigidTransform(1), -info.world_offset_m);
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (glm::length_t row = 0; row < 4; ++row)
        for (glm::length_t column = 0; column < 4; ++column) rows.push_back(gltf_from_world[column][row]);
    nlohmann::ordered_json json{{"up", {{"source", name_of(info.upright.source)}, {"direction", {up.x, up.y, up.z}}}},
                                {"gltf_from_world", std::move(rows)}};
    if (!info.lights.empty()) json["candela_per_intensity"] = info.candela_per_intensity;
    if (info.environment)
        json["environment"] = {{"file", info.environment->file},
                               {"luminance_per_pixel_value", info.environment->luminance_per_pixel_value}};
    return json;
}

}  // namespace

std::optional<ReportScene> SceneFiles::report_scene(const OutputFolder& folder) const {
    const std::vector<std::string> files = folder.files();
    if (!info_ || !std::ranges::binary_search(files, "scene.glb")) return std::nullopt;
    ReportScene scene{read_scene_parts(folder.published("scene.glb")), {}};
    scene.parts.ambient = scene_.lighting.ambient;
    for (const TimedPose& pose : scene_.trajectory)
        scene.path_m.emplace_back(info_->upright.gltf_from_world() * pose.world_from_camera[3]);
    return scene;
}

void SceneFiles::add_to(RunSummary& summary) const {
    if (info_) summary.gltf = gltf_json(*info_);
    const Lighting lighting = in_recorded_world(scene_);
    summary.lamps = lighting.lights;
    summary.ambient = lighting.ambient;
    for (uint32_t label = 1; label < scene_.reflectance.segments.size(); ++label) {
        const SegmentReflectance& segment = scene_.reflectance.segments[label];
        if (segment.voxels == 0) continue;
        const std::vector<std::string>& names = info_ ? info_->segment_names : scene_.segment_names;
        summary.segments.push_back({label, label < names.size() ? names[label] : "", segment});
    }
}

}  // namespace patina::tools
