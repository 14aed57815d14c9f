#include "scenes/files/scene_report.h"

#include <algorithm>
#include <sstream>
#include <variant>

#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "scenes/description/lighting_sequence.h"
#include "scenes/render/environment.h"
#include "sensor/files/text_file.h"
#include "sensor/report_lines.h"

namespace patina::scenes {
namespace {

template <class Vector>
std::string triple(const Vector& v, int digits) {
    return text(sensor::fixed(v.x, digits), " ", sensor::fixed(v.y, digits), " ", sensor::fixed(v.z, digits));
}

std::string objects_line(const SyntheticScene& scene) {
    size_t textured = 0, triangles = 0;
    for (const SceneObject& object : scene.objects) {
        textured += object.texture ? 1 : 0;
        for (const Part& part : object.parts)
            if (const auto* mesh = std::get_if<MeshShape>(&part.shape)) triangles += mesh->mesh->triangles.size();
    }
    return text(scene.objects.size(), ", ", textured, " of them textured, ", triangles, " triangles in meshes");
}

std::string light_line(const Light& light) {
    return text(
        "intensity ", triple(light.intensity, 3), " at ", triple(light.position_m, 3), " m, ",
        is_flat(light) ? text("flat, along ", triple(light.axis, 3), ", ") : "",
        light.radius_m > 0 ? text("radius ", sensor::fixed(light.radius_m, 3), " m") : "a point that no camera sees");
}

std::string environment_line(const Environment& environment) {
    return text("mean radiance ", triple(mean_radiance(*environment.radiance), 3));
}

std::string noise_line(const SensorNoise& noise) {
    const bool depth = noise.depth_constant_m > 0 || noise.depth_quadratic_per_m > 0 || noise.flying_pixels > 0;
    const bool color = noise.color_read > 0 || noise.color_shot > 0;
    const bool poses = noise.pose_translation_m > 0 || noise.pose_rotation_rad > 0;
    std::string of;
    for (const auto& [noisy, what] : {std::pair(depth, "depth"), {color, "colour"}, {poses, "poses"}})
        if (noisy) of += (of.empty() ? "of " : ", ") + std::string(what);
    return of.empty() ? "none" : of;
}

double path_length_m(const SyntheticScene& scene, uint32_t frames) {
    double length_m = 0;
    glm::dvec3 last_m(world_from_camera(scene.path, 0)[3]);
    for (uint32_t i = 1; i < frames; ++i) {
        const glm::dvec3 next_m(world_from_camera(scene.path, i / scene.fps)[3]);
        length_m += glm::distance(last_m, next_m);
        last_m = next_m;
    }
    return length_m;
}

std::string lighting_line(const SyntheticScene& scene) {
    const auto lighting = lighting_sequence(scene);
    if (!lighting) return "none: it needs a path and a lamp with a radius";
    return text(lighting->frames, " frames, exposed ", lighting->exposure, " times as long as the others");
}

}  // namespace

std::string format_scene_report(const SyntheticScene& scene, uint32_t frames) {
    const Intrinsics& color = scene.color_camera ? scene.color_camera->camera : scene.camera;
    const RigidTransform offset = scene.color_camera ? scene.color_camera->color_from_depth : RigidTransform(1.0);
    std::ostringstream out;
    const auto line = [&](const char* label, const std::string& value) { out << label << printable(value) << "\n"; };
    line("sequence      ", text(scene.name, " (synthetic)"));
    line("frames        ", text(frames, " by default"));
    line("time          ", text(sensor::fixed((frames - 1) / scene.fps, 2), " s at ", scene.fps, " frames/s"));
    line("colour camera ", sensor::camera_line(color));
    line("              ", sensor::offset_line(offset));
    line("depth camera  ", sensor::camera_line(scene.camera));
    line("              ", sensor::depth_units_line(scene.metres_per_unit, scene.max_metres));
    line("noise         ", noise_line(scene.recording.noise));
    line("poses         ",
         text(frames, " of ", frames, " frames, path ", sensor::fixed(path_length_m(scene, frames), 2), " m"));
    line("objects       ", objects_line(scene));
    for (const Light& light : scene.lights) line("light         ", light_line(light));
    if (scene.environment) line("environment   ", environment_line(*scene.environment));
    line("lighting      ", lighting_line(scene));
    return out.str();
}

}  // namespace patina::scenes
