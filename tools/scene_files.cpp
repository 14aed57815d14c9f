#include "tools/scene_files.h"

#include <utility>

#include "tools/export/materials.h"

namespace patina::tools {

namespace {

/// To a millionth, where the digits of a float end: files say 0.3, not 0.30000001192.
glm::dvec3 rounded(glm::vec3 v) { return glm::round(glm::dvec3(v) * 1e6) / 1e6; }

}  // namespace

SceneFiles::SceneFiles(MeshReflectance reflectance, const Illumination& illumination, std::vector<std::string> names)
    : reflectance_(std::move(reflectance)),
      world_offset_m_(illumination.world_offset_m),
      ambient_(rounded(illumination.ambient)),
      names_(std::move(names)) {
    for (const FoundLight& light : illumination.lights)
        lights_.push_back({rounded(light.position_m), rounded(light.intensity), rounded(glm::vec3(light.radius_m)).x});
}

std::vector<sensor::PointLight> SceneFiles::world_lights() const {
    std::vector<sensor::PointLight> lights = lights_;
    for (sensor::PointLight& light : lights) light.position_m += world_offset_m_;
    return lights;
}

GlbSummary SceneFiles::write(OutputFolder& folder, const Mesh& mesh, const GlbInfo& info) const {
    const GlbSummary summary = write_glb(folder.stage("scene.glb"), {mesh, &reflectance_, names_, lights_}, info);
    folder.publish("scene.glb");
    if (!reflectance_.segments.empty()) folder.write("materials.json", materials_json(reflectance_.segments, names_));
    if (!lights_.empty() || ambient_ != glm::dvec3(0)) {
        sensor::write_lights(folder.stage("lights.json"), world_lights(), ambient_);
        folder.publish("lights.json");
    }
    return summary;
}

void SceneFiles::tell(RunRecord& record) const {
    record.lamps = world_lights();
    record.ambient = ambient_;
    for (uint32_t label = 1; label < reflectance_.segments.size(); ++label) {
        const SegmentReflectance& segment = reflectance_.segments[label];
        if (segment.voxels == 0) continue;
        record.segments.push_back({label, label < names_.size() ? names_[label] : "", segment});
    }
}

}  // namespace patina::tools
