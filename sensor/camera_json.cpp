#include "sensor/camera_json.h"

namespace patina::sensor {

nlohmann::ordered_json camera_json(const Intrinsics& camera) {
    return {{"width", camera.extent.width},
            {"height", camera.extent.height},
            {"fx", camera.fx},
            {"fy", camera.fy},
            {"cx", camera.cx},
            {"cy", camera.cy},
            {"distortion", camera.distortion}};
}

}  // namespace patina::sensor
