#include "passes/specular/keep_mirrors.h"

#include "shared/specular/mirror_fit.h"
#include "spirv/shaders.h"

namespace patina {

void add_keep_mirrors(graph::FrameGraph& frame, const WardFits& table, WardFitIds& fits, uint32_t materials,
                      graph::BufferId& segment_materials) {
    auto pass = frame.compute("specular.keep_mirrors", spirv::keep_mirrors);
    fits.mirrors = pass.modify("Mirrors", fits.mirrors);
    segment_materials = pass.modify("Materials", segment_materials);
    pass.push(gpu::KeepMirrorsParams{table.labels(), materials});
    pass.dispatch_covering(table.labels());
}

}  // namespace patina
