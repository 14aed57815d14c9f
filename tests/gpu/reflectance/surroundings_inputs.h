#pragma once

#include <cstdint>
#include <vector>

#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "passes/reflectance/collect_surroundings.h"

namespace patina {

/// What add_collect_surroundings takes of a registered frame.
inline SurroundingsInputs upload_surroundings(graph::FrameGraph& frame, const Intrinsics& camera,
                                              const RigidTransform& world_from_camera, const Image<float>& depth_m,
                                              const Image<glm::vec4>& color_linear) {
    SurroundingsInputs inputs;
    inputs.depth_m =
        frame.upload("depth", {camera.extent, vulkan::Format::kR32f}, std::as_bytes(std::span(depth_m.pixels())));
    std::vector<uint64_t> halves;
    for (const glm::vec4& pixel : color_linear.pixels()) halves.push_back(glm::packHalf4x16(pixel));
    inputs.color_linear =
        frame.upload("color", {camera.extent, vulkan::Format::kRgba16f}, std::as_bytes(std::span(halves)));
    inputs.depth_camera = inputs.color_camera = make_camera(camera, world_from_camera);
    return inputs;
}

}  // namespace patina
