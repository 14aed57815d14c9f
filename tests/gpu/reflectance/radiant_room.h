#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "passes/reflectance/collect_surroundings.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/observation/observation_rig.h"
#include "tests/gpu/reflectance/reflectance_rig.h"
#include "tests/gpu/reflectance/surroundings_inputs.h"

namespace patina {

inline const Intrinsics kCamera{{160, 160}, 72, 72, 79.5, 79.5, {}};  // 96 degrees: six views see all around
inline constexpr double kHalf_m = 0.4;
inline constexpr double kColorStep =
    0.004;  // of a fused colour around 0.4: 10 bits of its square root, rounded by chance

/// A cube seen from inside.
inline double room(glm::dvec3 p) { return -reference::box({0, 0, 0}, glm::dvec3(kHalf_m))(p); }

using Radiance = std::function<glm::dvec3(glm::dvec3)>;
inline glm::dvec3 grey(glm::dvec3) { return glm::dvec3(0.4); }

/// A room of known radiance, as cameras in its middle see it.
class RadiantRoomTest : public GpuTest {
  protected:
    struct Model {
        Model(vulkan::Device& device, graph::Runner& runner)
            : observations(device, runner, {.voxel_m = 0.02f, .capacity_records = 131072}),
              reflectance(device, runner, observations.fusion().map(), observations.map()) {}
        ObservationRig observations;
        ReflectanceRig reflectance;
    };

    /// The room from its middle, in the given directions.
    std::unique_ptr<Model> fused(const Radiance& radiance, std::span<const glm::dvec3> directions) {
        auto model = std::make_unique<Model>(device(), runner());
        std::vector<RigFrame> frames;
        for (const glm::dvec3 direction : directions) frames.push_back(view(radiance, direction));
        for (const RigFrame& frame : frames) {
            for (int i = 0; i < 4; ++i) {
                model->observations.fusion().fuse(frame.camera, frame.world_from_camera, frame.depth_m, frame.color);
            }
        }
        for (const RigFrame& frame : frames) model->observations.collect(frame);
        return model;
    }

    static glm::dvec3 seen_m(const RigFrame& frame, uint32_t x, uint32_t y) {
        const glm::dvec3 in_camera((x - kCamera.cx) / kCamera.fx, (y - kCamera.cy) / kCamera.fy, 1);
        return glm::dvec3(frame.world_from_camera * glm::dvec4(in_camera * double{frame.depth_m.at(x, y)}, 1));
    }

    static RigFrame view(const Radiance& radiance, glm::dvec3 direction) {
        RigFrame frame;
        frame.camera = kCamera;
        // Never along the axis that look_at() takes for up.
        frame.world_from_camera = reference::look_at({0, 0, 0}, direction + glm::dvec3(0.03, 0.02, 0.03));
        frame.depth_m = reference::render_depth(room, kCamera, frame.world_from_camera, 4);
        frame.color = {kCamera, frame.world_from_camera, Image<glm::vec4>(kCamera.extent, glm::vec4(0))};
        for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
            for (uint32_t x = 0; x < kCamera.extent.width; ++x) {
                frame.color.linear.at(x, y) = glm::vec4(glm::vec3(radiance(seen_m(frame, x, y))), 1);
            }
        }
        return frame;
    }

    /// What a camera in the middle sees of the room all around, at the usual exposure or at a low one. Where `is_open`
    /// the depth camera sees nothing.
    static void collect_surroundings(
        Model& model, const Radiance& radiance, float radiance_scale = 0,
        const std::function<bool(glm::dvec3)>& is_open = [](glm::dvec3) { return false; }) {
        for (const glm::dvec3 direction : kAll) {
            RigFrame seen = view(radiance, direction);
            for (uint32_t y = 0; y < kCamera.extent.height; ++y)
                for (uint32_t x = 0; x < kCamera.extent.width; ++x)
                    if (is_open(seen_m(seen, x, y))) seen.depth_m.at(x, y) = 0;
            model.reflectance.change([&](graph::FrameGraph& frame, ReflectanceStateIds& state) {
                SurroundingsInputs inputs =
                    upload_surroundings(frame, kCamera, seen.world_from_camera, seen.depth_m, seen.color.linear);
                inputs.radiance_scale = radiance_scale;
                inputs.lamp_luminance = 1e6f;
                for (inputs.frame_index = 0; inputs.frame_index < 16; ++inputs.frame_index)
                    add_collect_surroundings(frame, state, inputs);
            });
        }
    }

    static constexpr std::array<glm::dvec3, 6> kAll{glm::dvec3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0},
                                                    {0, -1, 0},          {0, 0, 1},  {0, 0, -1}};
};

/// In the middle of a wall, and looking away from it.
inline bool on_wall(const RefinedRecord& record) {
    const glm::dvec3 apart = glm::abs(glm::abs(record.point_m) - kHalf_m);
    const int axis = apart.x < 0.01 ? 0 : apart.y < 0.01 ? 1 : 2;
    const glm::dvec3 inwards = -glm::sign(record.point_m[axis]) * glm::dvec3(axis == 0, axis == 1, axis == 2);
    return record.observations > 0 && apart[axis] < 0.01 && glm::dot(record.normal, inwards) > 0.98 &&
           apart[(axis + 1) % 3] > 0.06 && apart[(axis + 2) % 3] > 0.06;
}

}  // namespace patina
