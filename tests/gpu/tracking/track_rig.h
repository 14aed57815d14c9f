#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/core/shader_camera.h"
#include "passes/tracking/normal_equations.h"
#include "passes/tracking/pack_frame.h"
#include "passes/tracking/pack_model.h"
#include "shared/tracking/tracking.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/scenes/analytic_scene.h"
#include "tests/reference/tracking/track.h"

namespace patina {

/// What a camera sees of an analytic scene, exactly.
struct SeenScene {
    Image<float> depth_m;
    Image<glm::vec4> position_m;  ///< world; w: depth
    Image<glm::vec4> normal;      ///< world
    Image<glm::vec4> color;       ///< linear, a = 1 where something is seen
};

/// A colour at a world point.
using Paint = std::function<glm::vec3(glm::dvec3)>;

SeenScene see(const reference::DistanceField& scene, const Paint& paint, const Intrinsics& camera,
              const RigidTransform& world_from_camera);

/// Half floats, and their rounding.
std::vector<uint64_t> to_halves(const Image<glm::vec4>& image);
Image<glm::vec4> rounded_to_halves(const Image<glm::vec4>& image);

/// Runs the tracker's passes alone.
class TrackTest : public GpuTest {
  protected:
    struct Level {
        std::vector<uint32_t> words;  ///< one per pixel of a frame, four of the model
        Intrinsics camera;
    };

    graph::ImageId upload_floats(graph::FrameGraph& frame, const Image<float>& image);
    graph::ImageId upload_halves(graph::FrameGraph& frame, const Image<glm::vec4>& image);
    TrackLevel pack_frame(graph::FrameGraph& frame, const SeenScene& seen, const Intrinsics& camera,
                          const std::optional<reference::TrackPicture>& picture, bool half = false);
    TrackLevel pack_model(graph::FrameGraph& frame, const SeenScene& seen, const Intrinsics& camera,
                          const RigidTransform& world_from_camera, bool colored, bool half = false);

    static Image<reference::TrackReading> readings(const std::vector<uint32_t>& words, Extent2D extent);
    static Image<reference::TrackSurface> surfaces(const std::vector<uint32_t>& words, Extent2D extent);
};

/// A state that starts from a pose.
gpu::TrackState state_at(const RigidTransform& model_from_frame, double center_m, double lever_m, double gain = 1);

}  // namespace patina
