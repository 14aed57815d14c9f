#include "tests/gpu/scenes/small_office.h"

#include <algorithm>
#include <cmath>

#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"

namespace patina {

SmallOffice::SmallOffice(vulkan::Device& device, uint32_t count) {
    scenes::SyntheticScene scene = scenes::load_scene("office");
    scene.camera = scaled_to(scene.camera, {160, 132});
    scene.fps /= 3;
    scenes::SyntheticSource source(device, std::move(scene), {.frames = count});
    info = source.info();
    while (auto reading = source.next()) frames.push_back(std::get<Frame>(std::move(*reading)));
}

PoseError pose_error(const RigidTransform& found, const Frame& frame) {
    const RigidTransform off = rigid_inverse(frame.world_from_camera.value()) * found;
    const double trace = off[0][0] + off[1][1] + off[2][2];
    return {glm::length(glm::dvec3(off[3])), glm::degrees(std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0)))};
}

}  // namespace patina
