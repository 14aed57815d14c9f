#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "patina/scene.h"

namespace patina {

/// A triangle of a surface, or a few that it stands for.
struct Patch {
    glm::vec3 center_m{0};
    glm::vec3 area_m2{0};  ///< area along the normal, which points to free space
    uint32_t label = 0;    ///< of its segment, 0 for none
};

/// A sample of a surface's triangles, of all its parts alike: enough to find its planes. The surface may come in
/// pieces. The same pieces give the same sample.
class SurfaceSurvey {
  public:
    /// 3.5 MiB of patches; a plane that has a hundredth of the surface has 600 or more of them.
    static constexpr size_t kMostPatches = 1 << 17;

    /// `labels` by vertex; empty: none. A patch faces where the mesh's normals do, which are smoother than its
    /// triangles are; without normals, or where they cancel out, as its triangle.
    void add(const Mesh& mesh, std::span<const uint32_t> labels);

    std::span<const Patch> patches() const { return patches_; }

  private:
    void add(const Patch& patch);

    std::vector<Patch> patches_;
    uint64_t seen_ = 0, each_ = 1;  ///< triangles; of so many one is kept
};

}  // namespace patina
