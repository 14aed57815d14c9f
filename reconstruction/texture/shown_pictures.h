#pragma once

#include <optional>
#include <vector>

#include "engine/graph/runner.h"
#include "passes/state/texture_band.h"
#include "reconstruction/texture/cast_picture.h"

namespace patina {

/// What pictures tell of the surface that they show, on the device, for views of the model. They see more than its
/// voxels hold: a pixel of theirs covers less than a voxel. They are kept beside the light when they were added, so
/// that views may be under another one.
class ShownPictures {
  public:
    static constexpr uint64_t kMostBytes = uint64_t{256} << 20;  ///< of all pictures, on the device

    /// Runner and stages must outlive this; stages must have reflectance.
    ShownPictures(graph::Runner& runner, Stages& stages) : runner_(runner), stages_(stages) {}

    /// How many pictures of such a camera there may be.
    static size_t most_of(const Intrinsics& camera);

    /// What the picture's camera sees of the model must be on the device. Throws Error as add_cast_picture does, or
    /// when memory runs out.
    void add(const TexturePicture& picture);

    /// Shows the surface of a view with the albedo that the pictures tell (add_show_texels). Returns `elsewhere` where
    /// the view has more pixels than a band may have texels (TextureBand::most_rows), about 3 million.
    PredictedImages add_to_view(graph::FrameGraph& graph, const PosedCamera& camera, graph::ImageId position_m,
                                graph::ImageId normal, const PredictedImages& predicted,
                                const PredictedImages& elsewhere);

    /// The model is under another light from now on.
    void relight() { other_light_ = true; }
    bool relit() const { return other_light_; }

  private:
    struct Picture {
        gpu::Camera camera;
        vulkan::ImageRef diffuse, light, depth_m;
    };

    graph::Runner& runner_;
    Stages& stages_;
    std::vector<Picture> pictures_;
    bool other_light_ = false;
    std::optional<TextureBand> page_;  ///< of the last view's extent
};

}  // namespace patina
