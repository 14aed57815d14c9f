#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "shared/scenes/example_scenes.h"

namespace patina::scenes {

/// A scene that shows one segment, for training: docs/guide/training.md has the distributions.
struct ExampleScene {
    gpu::ExampleScene scene{};
    std::array<gpu::PointLight, gpu::kExampleLamps> lamps{};
    std::array<gpu::ExampleWindow, gpu::kExampleWindows> windows{};
    std::array<gpu::WardMaterial, gpu::kExampleMaterials> materials{};  ///< the first is the segment's
    std::array<gpu::ExampleVoxel, gpu::kExampleVoxels> voxels{};
    std::array<glm::vec4, gpu::kExampleViews> views{};
    float normal_error_degrees = 0;  ///< the most that a stored normal is off
};

/// Number `index` of a seed's scenes; the same with every standard library, but for the last bits of its functions.
ExampleScene draw_example_scene(uint64_t seed, uint64_t index);

/// What such a scene may be made of.
gpu::WardMaterial draw_example_material(uint64_t seed, uint64_t index, uint32_t which);

}  // namespace patina::scenes
