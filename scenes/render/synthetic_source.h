#pragma once

#include <deque>

#include "engine/graph/runner.h"
#include "patina/source.h"
#include "scenes/description/scene.h"
#include "scenes/render/render.h"

namespace patina::scenes {

/// What of a scene is recorded.
struct SyntheticOptions {
    uint32_t frames = 120;
    double exposure = 1;       ///< of all frames, over the one at which pixel values equal radiance (0.01 s, gain 1)
    uint32_t truth_every = 0;  ///< every so many frames have FrameTruth::seen; 0: none
};

/// What is true of one frame.
struct FrameTruth {
    RigidTransform world_from_camera{1.0};  ///< of the depth camera
    Image<uint16_t> labels;                 ///< the object id at each pixel of the depth camera; 0 = background or lamp

    /// What the colour camera sees, as RenderedImages; of the radiance at the exposure of pixel values, without noise
    /// or clipping.
    struct Seen {
        Image<glm::vec4> radiance;
        Image<float> depth_m;
        Image<uint32_t> object_id;
        Image<glm::vec4> normal;
        Image<glm::vec4> kd;
        Image<glm::vec4> ks_alpha;
    };
    std::optional<Seen> seen;
};

/// Records a synthetic scene along its camera path, with the errors, the exposure and the cameras of Scene: colour as
/// 8-bit sRGB, clipped, or linear floats, and integer depth, so that the frames are those which SequenceWriter writes
/// and the reader of Patina's own format reads back. A frame's index and Recording::seed make its errors. Renders in
/// next(), on the calling thread, two frames ahead; as the device's queue takes one thread at a time, that must be the
/// thread that runs other frames on this device.
class SyntheticSource : public Source {
  public:
    /// The device must outlive the source. A scene that cannot be traced (see SceneModel) makes it throw.
    SyntheticSource(vulkan::Device& device, SyntheticScene scene, const SyntheticOptions& options);

    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override;

    /// Leaves out the frames before `index`; to be called before next().
    void skip_to(uint32_t index) { next_index_ = index; }

    /// What is true for all frames: objects with their materials, lights.
    const SyntheticScene& scene() const { return scene_; }

    /// What is true of the last frame; empty images before the first.
    const FrameTruth& truth() const { return truth_; }

  private:
    /// What arrives from the device for FrameTruth::Seen.
    struct PendingSeen {
        graph::Readback radiance, depth_m, object_id, normal, kd, ks_alpha;
    };
    /// A frame that the device still computes.
    struct Pending {
        Frame frame;  ///< without pictures
        RigidTransform true_pose{1.0};
        graph::Readback depth_and_ids, color;
        std::optional<PendingSeen> seen;
    };
    void submit_next();
    Frame finished(Pending pending);

    graph::Runner runner_;
    SyntheticScene scene_;
    SyntheticOptions options_;
    SceneModel model_;
    SequenceInfo info_;
    uint32_t next_index_ = 0;  ///< to be submitted
    std::deque<Pending> pending_;
    FrameTruth truth_;
};

}  // namespace patina::scenes
