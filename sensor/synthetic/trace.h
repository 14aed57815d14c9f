#pragma once

#include "engine/graph/frame.h"
#include "sensor/synthetic/scene.h"

namespace patina::sensor {

/// A scene on the GPU, for one frame.
struct SceneBuffers {
    graph::BufferId objects;  ///< gpu::TraceObject: rectangles, then boxes, then spheres
    graph::BufferId lights;   ///< gpu::TraceLight
    uint32_t rectangle_count = 0;
    uint32_t box_count = 0;
    uint32_t sphere_count = 0;
    uint32_t light_count = 0;
};

/// Copies a scene's objects and lights to the device. Throws Error naming the object that has no kd, an alpha outside
/// (0, 1], or an id that is 0, above 65535 or another's.
SceneBuffers upload_scene(graph::Frame& frame, const Scene& scene);

/// Whether lights are occluded by objects. The paper's model knows no shadows (Section 3.1).
enum class Shadows : uint8_t { kNone, kHard };

/// What the camera sees at each pixel. Where it sees no object all images are 0.
struct TracedImages {
    graph::ImageId radiance;   ///< W x H rgba32f, linear pixel values; a = 1 on an object
    graph::ImageId depth_m;    ///< W x H r32f, along the camera's z axis
    graph::ImageId object_id;  ///< W x H r32ui
    graph::ImageId normal;     ///< W x H rgba16f, world, unit length, towards the camera
};

/// Ray-traces a scene with one ray through each pixel's centre, Ward materials and point lights (paper, Eq. 2-4, 6).
/// Boxes and spheres are not seen from inside. Throws Error when the camera has lens distortion.
TracedImages add_trace_scene(graph::Frame& frame, const SceneBuffers& scene, const Intrinsics& camera,
                             const RigidTransform& world_from_camera, Shadows shadows = Shadows::kNone);

/// Encodes traced images as a recorded sequence holds them. Returns two u32 per pixel, row by row: 8-bit sRGB codes r |
/// g << 8 | b << 16 (clipped at 255), and depth in units of `metres_per_unit` | object id << 16. Depth beyond 65535
/// units becomes 0.
graph::BufferId add_encode_frame(graph::Frame& frame, const TracedImages& traced, double metres_per_unit);

}  // namespace patina::sensor
