#include "tests/gpu/scenes/small_office.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

ChosenFrames::ChosenFrames(const SmallOffice& office, std::vector<uint32_t> indices, bool with_poses)
    : office_(office), info_(office.info), indices_(std::move(indices)) {
    info_.frames = static_cast<uint32_t>(indices_.size());
    info_.has_poses = with_poses;
}

std::optional<Reading> ChosenFrames::next() {
    if (next_ == info_.frames) return std::nullopt;
    Frame frame = office_.frames[indices_[next_]];
    frame.index = next_++;
    frame.timestamp_s = frame.index / info_.fps;
    if (!info_.has_poses) frame.world_from_camera.reset();
    return frame;
}

std::vector<uint32_t> from_to(uint32_t first, uint32_t last) {
    std::vector<uint32_t> indices{first};
    while (indices.back() != last) indices.push_back(first < last ? indices.back() + 1 : indices.back() - 1);
    return indices;
}

PoseError pose_error(const RigidTransform& found, const Frame& frame) {
    const RigidTransform off = rigid_inverse(frame.world_from_camera.value()) * found;
    const double trace = off[0][0] + off[1][1] + off[2][2];
    return {glm::length(glm::dvec3(off[3])), glm::degrees(std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0)))};
}

}  // namespace patina
