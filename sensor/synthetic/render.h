#pragma once

#include <cstdint>

#include "engine/graph/frame.h"
#include "engine/graph/runner.h"
#include "sensor/synthetic/scene.h"

namespace patina::sensor {

/// A scene on the device: uploaded once, then rendered in any number of frames.
class SceneModel {
  public:
    /// Uploads the scene in a frame of its own. Throws Error naming the object that has neither kd nor texture, an
    /// alpha outside (0, 1], or an id that is 0, above 65535 or another's.
    SceneModel(graph::Runner& runner, const Scene& scene);

    /// Its buffers in one frame.
    struct Ids {
        graph::BufferId objects;  ///< gpu::TraceObject: rectangles, then boxes, then spheres
        graph::BufferId lights;   ///< gpu::TraceLight
    };
    Ids import(graph::Frame& frame) const;

    uint32_t rectangle_count() const { return rectangle_count_; }
    uint32_t box_count() const { return box_count_; }
    uint32_t sphere_count() const { return sphere_count_; }
    uint32_t light_count() const { return light_count_; }

  private:
    vulkan::BufferRef objects_;
    vulkan::BufferRef lights_;
    uint32_t rectangle_count_ = 0;
    uint32_t box_count_ = 0;
    uint32_t sphere_count_ = 0;
    uint32_t light_count_ = 0;
};

/// What a camera sees at each pixel, through the pixel's centre. Where it sees nothing, all images are 0.
struct RenderedImages {
    graph::ImageId radiance;   ///< W x H rgba32f, linear pixel values; a = 1 where anything is seen
    graph::ImageId depth_m;    ///< W x H r32f, along the camera's z axis
    graph::ImageId object_id;  ///< W x H r32ui; 0 on lamps
    graph::ImageId normal;     ///< W x H rgba32f, world, unit length, towards the camera; a unused
    graph::ImageId kd;         ///< W x H rgba32f, rgb; 0 on lamps; a unused
    graph::ImageId ks_alpha;   ///< W x H rgba32f, ks and roughness; 0 on lamps
};

/// Ray-traces a scene with Ward materials (paper, Eq. 2-4, 6). The same settings give the same pixels; frames of one
/// sequence pass their index as `frame_index` to differ in their random samples. Throws Error when the camera has lens
/// distortion.
RenderedImages add_render(graph::Frame& frame, const SceneModel& scene, const Intrinsics& camera,
                          const RigidTransform& world_from_camera, const RenderSettings& settings = {},
                          uint32_t frame_index = 0);

}  // namespace patina::sensor
