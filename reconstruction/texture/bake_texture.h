#pragma once

#include <functional>
#include <vector>

#include "engine/graph/runner.h"
#include "passes/state/texture_band.h"
#include "patina/texture.h"
#include "reconstruction/texture/cast_picture.h"
#include "reconstruction/texture/texture_triangles.h"

namespace patina {

/// Bakes a texture from pictures: each in turn is looked at by all texels that it shows.
class TextureBake {
  public:
    /// Places the surface in its pages. Throws Error when memory runs out. Runner and stages must outlive this.
    TextureBake(graph::Runner& runner, Stages& stages, const TextureLayout& layout);

    /// What the picture's camera sees of the model must be on the device. Throws Error as add_convert_color does.
    void add(const TexturePicture& picture);

    /// Waits for the device. Nothing may be added after it.
    std::vector<TexturePage> finish();

    /// Adds what the volume's surface faces to the pages of the layout (TexturePage::detail), in texels as large as
    /// voxels, where the mesh differs from it enough to see. Waits for the device.
    void add_detail(const TextureLayout& layout, std::vector<TexturePage>& pages);

  private:
    void place(const TextureLayout& layout);
    Image<glm::vec3> detail_of(const TextureTriangles& triangles, uint32_t page, Extent2D extent);
    TexturePage finish_page(uint32_t number);

    graph::Runner& runner_;
    Stages& stages_;
    std::vector<Extent2D> pages_;
    double texel_m_;
    bool known_ = false;  ///< records know what the surface reflects
    std::vector<TextureBand> bands_;
};

}  // namespace patina
