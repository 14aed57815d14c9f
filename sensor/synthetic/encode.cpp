#include "sensor/synthetic/encode.h"

#include "shared/encode_frame.h"
#include "spirv/shaders.h"

namespace patina::sensor {

graph::BufferId add_encode_frame(graph::Frame& frame, const RenderedImages& rendered, double metres_per_unit) {
    const Extent2D extent = frame.common_extent({rendered.radiance, rendered.depth_m, rendered.object_id});
    auto pass = frame.compute("synthetic.encode_frame", spirv::encode_frame);
    pass.read("radiance", rendered.radiance).read("depth_m", rendered.depth_m).read("object_id", rendered.object_id);
    const graph::BufferId encoded = pass.create("Encoded", extent.area() * sizeof(glm::uvec2));
    pass.push(gpu::EncodeFrameParams{{extent.width, extent.height}, static_cast<float>(1 / metres_per_unit), 0});
    pass.dispatch_covering(extent);
    return encoded;
}

}  // namespace patina::sensor
