#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/graph/state_visitor.h"
#include "patina/frame.h"
#include "reconstruction/texture/cast_picture.h"
#include "shared/photometry/color_gains.h"

namespace patina {

class Pipeline;

/// Colour pictures that a texture is baked from when all frames were fused: of each stretch of the camera's way the
/// sharpest one, compressed without loss. Where they become too many or take too much memory, stretches become longer,
/// and of those that are joined the sharpest picture stays.
class KeptPictures {
  public:
    static constexpr size_t kMostPictures = 96;
    static constexpr uint64_t kMostBytes = uint64_t{256} << 20;  ///< compressed

    /// Looks at a frame that was fused; `order`: how many were before it.
    void add(const SequenceInfo& info, const Frame& frame, uint32_t order);

    /// Forgets pictures of frames that are no longer in the model: all but of the first `frames` that were fused. The
    /// stretches that these were the sharpest of have none then.
    void keep_first(uint32_t frames);

    /// Gives all of them to `take`, in the order of frames. `gains`: by order (Pipeline::gains); empty: all are 1.
    void give(const SequenceInfo& info, std::span<const gpu::ColorGains> gains,
              const std::function<void(const TexturePicture&)>& take);

    /// Views of the pipeline's model show them from now on (Pipeline::show_pictures). Throws Error as that does.
    void show_in(Pipeline& pipeline, const SequenceInfo& info);

    /// Edge of a pixel on the surface, metres, of the finest tenth of the pixels with depth; 0 without any.
    double finest_pixel_m() const;

    size_t size() const { return kept_.size() + (current_ ? 1 : 0); }

    void visit(graph::StateVisitor& visitor);

  private:
    struct Picture {
        uint32_t order = 0;
        Extent2D extent;
        uint32_t linear = 0;  ///< 1: the pixels are floats
        float sharpness = 0;
        float finest_m = 0;  ///< edge of a pixel of the finest tenth
        RigidTransform world_from_color{1.0};
        RigidTransform stretch{1.0};  ///< where its stretch of the way begins
    };
    struct Kept {
        Picture picture;
        std::vector<std::byte> packed;
    };
    struct Current {
        Picture picture;
        ColorImage color;
    };

    bool is_apart(const RigidTransform& a, const RigidTransform& b) const;
    void settle();
    void thin();
    static ColorImage unpack(const Kept& kept);

    float spacing_ = 1;  ///< how long stretches are, over kStep_m and kStep_rad
    std::vector<Kept> kept_;
    std::optional<Current> current_;  ///< the best one so far of the stretch at hand
};

}  // namespace patina
