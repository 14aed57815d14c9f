#include "passes/kinect2/measure_phases.h"

#include "engine/core/error.h"
#include "spirv/shaders.h"

namespace patina::kinect2 {

PhasorIds add_measure_phases(graph::FrameGraph& frame, const TableIds& tables, std::span<const uint8_t> infrared) {
    constexpr const char* kPass = "kinect2.measure_phases";
    constexpr size_t kBytes = gpu::kPhaseImages * kSubImageBytes;
    if (infrared.size() < kBytes)
        throw Error("the pass '", kPass, "' got ", infrared.size(), " bytes of an infrared frame, not ", kBytes);
    const Extent2D words{gpu::kRowWords, gpu::kPhaseImages * gpu::kInfraredHeight};
    const graph::ImageId codes =
        frame.upload("kinect2.codes", {words, vulkan::Format::kR32u}, std::as_bytes(infrared.first(kBytes)));
    auto pass = frame.compute(kPass, spirv::measure_phases);
    pass.read("codes", codes).read("offsets_ab", tables.offsets_ab).read("offsets_c_ray", tables.offsets_c_ray);
    PhasorIds phasors;
    phasors.ab = pass.create("phasors_ab", {kInfraredExtent, vulkan::Format::kRgba32f});
    phasors.c = pass.create("phasors_c", {kInfraredExtent, vulkan::Format::kRgba32f});
    pass.dispatch_covering({gpu::kInfraredWidth / 4, gpu::kInfraredHeight});  // four codes an invocation
    return phasors;
}

}  // namespace patina::kinect2
