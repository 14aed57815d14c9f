#include "passes/specular/bound_materials.h"

#include <algorithm>

#include "shared/specular/ward_fit.h"
#include "spirv/shaders.h"

namespace patina {

static_assert(2 * 4 * gpu::kBoundsLevels <= gpu::kBoundsGroup, "an invocation finds one end of one interval");
static_assert(gpu::kFitAlphas <= gpu::kBoundsGroup, "and the likelihood of one alpha");

graph::BufferId add_bound_materials(graph::FrameGraph& frame, const BoundMaterialsInputs& inputs) {
    const uint32_t labels = inputs.table.labels();
    auto bound = frame.compute("specular.bound_materials", spirv::bound_materials);
    bound.read("Fits", inputs.fits.fits).read("Curves", inputs.fits.curves).read("Albedo", inputs.albedo);
    bound.push(gpu::BoundMaterialsParams{labels});
    const graph::BufferId bounds =
        bound.create("Bounds", uint64_t{labels} * gpu::kBoundsLevels * sizeof(gpu::MaterialBounds));
    bound.dispatch(std::min(labels, gpu::kBoundsRow), (labels + gpu::kBoundsRow - 1) / gpu::kBoundsRow);
    return bounds;
}

}  // namespace patina
