#include "reconstruction/session/stored_map.h"

#include "reconstruction/session/session_state.h"
#include "reconstruction/setting_table.h"
#include "reconstruction/store/state_files.h"
#include "sensor/camera_json.h"

namespace patina {

namespace {

/// The settings of the session, without what only further frames need.
ReconstructionSettings settings_in(const std::filesystem::path& file, const nlohmann::ordered_json& session) {
    ReconstructionSettings settings;
    settings.segmentation.reset();
    settings.reflectance.reset();
    settings.specular.reset();
    for (const auto& [key, value] : session.at("settings").items())
        set_setting(settings, key, value.is_string() ? value.get<std::string>() : value.dump(), file.string());
    settings.tracking.reset();
    settings.keyframes.reset();
    settings.gains.reset();
    if (settings.specular) settings.specular->fit = true;  // no network is needed, as nothing is estimated any more
    return settings;
}

}  // namespace

StoredMap::StoredMap(vulkan::Device& device, const std::filesystem::path& file) {
    const auto map = MapFile::with_state(file);
    const std::string session_text = map->expect_text("session");
    const std::span text(reinterpret_cast<const uint8_t*>(session_text.data()), session_text.size());
    const auto session = sensor::JsonValue::parse(file.string(), text);
    name_ = session.at("sequence").string();
    camera_ = sensor::read_camera(session.at("depth"));
    world_offset_m_ = world_offset_in(device, *map);
    const Illumination light = light_in(device, *map).illumination;
    lighting_ = lighting_of(light);
    for (Light& lamp : lighting_.lights) lamp.position_m -= world_offset_m_;
    pipeline_ = std::make_unique<Pipeline>(device, settings_in(file, map->expect_json("session")));
    StateReader reader(device, *map);
    pipeline_->visit(reader);
    reader.values("session.poses", poses_);
    reader.finish();
}

Scene StoredMap::scene() {
    Scene scene;
    scene.name = name_;
    scene.lighting = lighting_;
    scene.trajectory = poses_;
    scene.world_offset_m = world_offset_m_;
    scene.mesh = pipeline_->extract_surface();
    scene.reflectance = pipeline_->sample_reflectance(scene.mesh);
    scene.far_field = pipeline_->far_field();
    scene.lighting.windows = pipeline_->windows(scene.trajectory, scene.lighting.lights);
    return scene;
}

}  // namespace patina
