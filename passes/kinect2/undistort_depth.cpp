#include "passes/kinect2/undistort_depth.h"

#include <cmath>

#include "engine/core/error.h"
#include "shared/kinect2/undistort_depth.h"
#include "spirv/shaders.h"

namespace patina::kinect2 {

UndistortedImages add_undistort_depth(graph::FrameGraph& frame, const TableIds& tables, graph::ImageId readings,
                                      const DecodeSettings& settings) {
    constexpr const char* kPass = "kinect2.undistort_depth";
    // libfreenect2's depth_packet_processor.cpp.
    constexpr float kMinAmplitude = 50, kMaxDeviation = 0.05f, kNearStep = 50, kFarStep = 30, kMaxStep = 100;
    if (!(settings.min_m > 0 && settings.max_m > settings.min_m && std::isfinite(settings.max_m)))
        throw Error("the pass '", kPass, "' got a range without use: ", settings.min_m, " m to ", settings.max_m, " m");
    auto pass = frame.compute(kPass, spirv::undistort_depth);
    pass.specialise("kDropEdges", settings.drop_edges);
    pass.read("readings", readings).read("sources", tables.sources);
    UndistortedImages images;
    images.depth_m = pass.create("depth_m", {kInfraredExtent, vulkan::Format::kR32f});
    images.infrared = pass.create("infrared", {kInfraredExtent, vulkan::Format::kR32f});
    pass.push(gpu::UndistortDepthParams{1000 * settings.min_m, 1000 * settings.max_m, kMinAmplitude, kMaxDeviation,
                                        kNearStep, kFarStep, kMaxStep, 0});
    pass.dispatch_covering(kInfraredExtent);
    return images;
}

}  // namespace patina::kinect2
