#pragma once

#include <cstdint>
#include <functional>
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

constexpr double kCeiling_m = -1.52;  ///< y, which points down

/// Adds what a camera that looks straight up sees of a ceiling: the radiance by x and z.
inline void add_ceiling(graph::FrameGraph& frame, ReflectanceStateIds& state,
                        const std::function<float(double, double)>& radiance) {
    const Intrinsics camera{{160, 160}, 80, 80, 79.5, 79.5, {}};
    RigidTransform world_from_camera(1.0);
    world_from_camera[1] = {0, 0, 1, 0};
    world_from_camera[2] = {0, -1, 0, 0};
    Image<float> depth_m(camera.extent, static_cast<float>(-kCeiling_m));
    Image<glm::vec4> color(camera.extent, glm::vec4(0));
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            const double per_pixel_m = -kCeiling_m / camera.fx;
            color.at(x, y) =
                glm::vec4(glm::vec3(radiance((x - camera.cx) * per_pixel_m, (y - camera.cy) * per_pixel_m)), 1);
        }
    }
    SurroundingsInputs inputs = upload_surroundings(frame, camera, world_from_camera, depth_m, color);
    for (inputs.frame_index = 0; inputs.frame_index < 16; ++inputs.frame_index)
        add_collect_surroundings(frame, state, inputs);
}

}  // namespace patina
