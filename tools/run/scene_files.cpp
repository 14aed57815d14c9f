#include "tools/run/scene_files.h"

#include "export/materials.h"
#include "export/write_tiles.h"

namespace patina::tools {

void SceneFiles::write_lists(OutputFolder& folder) const {
    if (!scene_.reflectance.segments.empty())
        folder.write("materials.json", materials_json(scene_.reflectance.segments, scene_.segment_names));
    if (const Lighting lighting = in_recorded_world(scene_); !lighting.empty()) {
        write_lighting(folder.stage("lights.json"), lighting);
        folder.publish("lights.json");
    }
}

GlbSummary SceneFiles::write_glb(OutputFolder& folder, const GivePieces& pieces, const std::string& version) const {
    const GlbSummary summary = write_scene_glb(folder.stage("scene.glb"), scene_, pieces, version);
    folder.publish("scene.glb");
    return summary;
}

GlbSummary SceneFiles::write_tiles(OutputFolder& folder, const GivePieces& pieces, const std::string& version) const {
    const auto write = [&](const std::string& name, const auto& write_to) {
        write_to(folder.stage("tiles/" + name));
        folder.publish("tiles/" + name);
    };
    TileWriter writer(write, glb_info(scene_, version));
    pieces([&](const Mesh& mesh, const MeshReflectance& reflectance) { writer.add(mesh, reflectance); });
    return writer.finish();
}

void SceneFiles::add_to(RunSummary& summary) const {
    const Lighting lighting = in_recorded_world(scene_);
    summary.lamps = lighting.lights;
    summary.ambient = lighting.ambient;
    for (uint32_t label = 1; label < scene_.reflectance.segments.size(); ++label) {
        const SegmentReflectance& segment = scene_.reflectance.segments[label];
        if (segment.voxels == 0) continue;
        const std::string name = label < scene_.segment_names.size() ? scene_.segment_names[label] : "";
        summary.segments.push_back({label, name, segment});
    }
}

}  // namespace patina::tools
