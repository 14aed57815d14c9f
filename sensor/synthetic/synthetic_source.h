#pragma once

#include "engine/graph/runner.h"
#include "sensor/source.h"
#include "sensor/synthetic/render.h"
#include "sensor/synthetic/scene.h"

namespace patina::sensor {

/// Records a synthetic scene along its camera path: 8-bit sRGB colour, clipped, and integer depth, with true poses, so
/// that the frames are those which SequenceWriter writes and the reader of Patina's own format reads back. Colour and
/// depth share one camera. Renders in next(), on the calling thread; as the device's queue takes one thread at a time,
/// that must be the thread that runs other frames on this device.
class SyntheticSource : public Source {
  public:
    /// The device must outlive the source. A scene that cannot be traced (see SceneModel) makes it throw.
    SyntheticSource(vulkan::Device& device, Scene scene, uint32_t frames);

    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override;

    /// What is true for all frames: objects with their materials, lights.
    const Scene& scene() const { return scene_; }

    /// The object id at each pixel of the last frame, 0 = background; empty before the first.
    const Image<uint16_t>& labels() const { return labels_; }

  private:
    Image<glm::uvec2> render(const RigidTransform& world_from_camera);

    graph::Runner runner_;
    Scene scene_;
    SceneModel model_;
    SequenceInfo info_;
    uint32_t next_index_ = 0;
    Image<uint16_t> labels_;
};

}  // namespace patina::sensor
