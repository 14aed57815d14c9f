#pragma once

#include <cstdint>

#include "engine/graph/frame_graph.h"
#include "engine/graph/runner.h"
#include "scenes/description/scene.h"

namespace patina::scenes {

/// A scene on the device: uploaded once, then rendered in any number of frames.
class SceneModel {
  public:
    /// Uploads the scene in a frame of its own. Throws Error for a scene that pack_scene() refuses.
    SceneModel(graph::Runner& runner, const SyntheticScene& scene);

    /// Binds what shaders/scenes/scene.glsl declares: geometry and lights.
    void bind_geometry(graph::FrameGraph& frame, graph::PassBuilder& pass) const;
    /// Binds what shaders/scenes/surface.glsl declares beyond that.
    void bind_surfaces(graph::FrameGraph& frame, graph::PassBuilder& pass) const;
    /// Binds what shaders/scenes/environment.glsl declares beyond that.
    void bind_environment(graph::FrameGraph& frame, graph::PassBuilder& pass) const;

    bool has_environment() const { return has_environment_; }
    bool has_area_lights() const { return has_area_lights_; }  ///< whether any lamp has a radius

  private:
    vulkan::BufferRef info_, lights_, objects_, triangle_surfaces_, environment_, environment_aliases_;
    vulkan::ImageRef nodes_, shapes_, texels_;
    bool has_environment_ = false;
    bool has_area_lights_ = false;
};

/// What a camera sees at each pixel, through the pixel's centre. Where it sees nothing, all images are 0, but for the
/// radiance of an environment.
struct RenderedImages {
    graph::ImageId radiance;   ///< W x H rgba32f, linear pixel values; a = 1 where anything but the environment is seen
    graph::ImageId depth_m;    ///< W x H r32f, along the camera's z axis
    graph::ImageId object_id;  ///< W x H r32ui; 0 on lamps
    graph::ImageId normal;     ///< W x H rgba32f, world, unit length, towards the camera; a unused
    graph::ImageId kd;         ///< W x H rgba32f, rgb; 0 on lamps; a unused
    graph::ImageId ks_alpha;   ///< W x H rgba32f, ks and roughness; 0 on lamps
    graph::BufferId lifted_m;  ///< vec4[W H], world: a little above the surface, where rays may leave it; 0 on lamps
};

/// The invocations that cover an image in passes that trace bundles of rays: each takes kBundleRays pixels of a column.
Extent2D bundles_of(Extent2D extent);

/// Ray-traces a scene with Ward materials (paper, Eq. 2-4, 6). The same settings give the same pixels; frames of one
/// sequence pass their index as `frame_index` to differ in their random samples. Throws Error when the camera has lens
/// distortion, or when light is to be sampled (add_gather_light) with no samples.
RenderedImages add_render(graph::FrameGraph& frame, const SceneModel& scene, const Intrinsics& camera,
                          const RigidTransform& world_from_camera, const RenderSettings& settings = {},
                          uint32_t frame_index = 0);

}  // namespace patina::scenes
