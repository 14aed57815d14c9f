#include "tests/scenes/scene_json.h"

#include "engine/core/error.h"
#include "tests/sensor/sequences.h"

namespace patina::scenes::testing {

nlohmann::json small_scene() {
    return nlohmann::json::parse(R"({
  "name": "small",
  "fps": 25,
  "camera": {"width": 64, "height": 48, "fx": 60, "fy": 61, "cx": 31.5, "cy": 23.5},
  "color_camera": {"camera": {"width": 96, "height": 54, "fx": 80, "fy": 80, "cx": 47.5, "cy": 26.5},
                   "color_from_depth": [1, 0, 0, 0.05, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
  "depth": {"metres_per_unit": 0.0005, "max_metres": 6},
  "textures": {"tiles": {"checker": {"colors": [[0.8, 0.7, 0.6], 0.1], "count": [4, 4], "size": 64}, "repeat": [0.5, 0.25]}},
  "materials": {"oak": {"kd": [0.24, 0.14, 0.07], "ks": 0.033, "alpha": 0.2},
                "floor": {"kd": "tiles", "ks": [0.05, 0.06, 0.07], "alpha": 0.3}},
  "objects": [
    {"name": "ground", "material": "floor",
     "parts": [{"rectangle": {"size": [4, 6]}, "rotations": [{"axis": [1, 0, 0], "degrees": 90}]}]},
    {"name": "table", "material": "oak",
     "parts": [{"box": {"size": [1, 0.1, 0.6]}, "position": [0, -0.7, 0]},
               {"cylinder": {"radius": 0.05, "height": 0.65}, "position": [0, -0.325, 0]}],
     "position": [1, 0, 0.5], "rotations": [{"axis": [0, 1, 0], "degrees": 90}]},
    {"name": "ball", "material": {"kd": 0.5, "ks": 0.1, "alpha": 0.1},
     "parts": [{"sphere": {"radius": 0.2}}], "position": [-1, -0.2, 0]}],
  "lights": [{"position": [0, -2, -1], "intensity": [5, 4, 3], "radius": 0.06},
             {"position": [1, -2, 1], "intensity": 2}],
  "environment": {"uniform": {"radiance": [0.1, 0.2, 0.3]}, "height": 16, "scale": 2},
  "path": {"orbit": {"target": [0, -0.2, 0], "distance": 3, "azimuth_degrees": 10,
                     "elevation_degrees": {"mean": 30, "amplitude": 10, "period_s": 9, "phase": 90}}},
  "lighting": {"path": {"tour": {"period_s": 20, "waypoints": [{"position": [0, -1.5, -1.5], "target": [0, -1.6, 0]},
                                                               {"position": [1, -1.5, -1], "target": [0, -1.6, 0]},
                                                               {"position": [0.5, -1.5, -2], "target": [0, -1.6, 0]}]}},
               "frames": 20},
  "recording": {"shadows": false, "area_lights": true, "bounces": 2, "samples": 16, "noise": "kinect1",
                "pose_noise": {"translation": 0.002, "rotation_degrees": 180}, "exr": true, "seed": 7}
})");
}

SyntheticScene load(const std::filesystem::path& file, const nlohmann::json& scene, const SceneChanges& changes) {
    sensor::testing::write_text(file, scene.dump());
    return load_scene(file.string(), changes);
}

std::string load_error(const std::filesystem::path& file, const std::string& content, const SceneChanges& changes) {
    sensor::testing::write_text(file, content);
    try {
        load_scene(file.string(), changes);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace patina::scenes::testing
