#include "passes/kinect2/unwrap_phases.h"

#include <numbers>

#include "shared/kinect2/unwrap_phases.h"
#include "spirv/shaders.h"

namespace patina::kinect2 {

namespace {

// libfreenect2's depth_packet_processor.cpp: its constants are the sensor's own. The residual is compared with the
// square of 10^(kSlope log10(amplitude) + kOffset), between 20 and 35 degrees.
constexpr float kMinAmplitude = 3, kMinSum = 10;
constexpr float kSlope = -0.5330578f, kOffset = 0.7694894f;
constexpr float kMinResidual = 0.3490659f, kMaxResidual = 0.6108653f;
constexpr float kExponent = 5, kMaxDistance = 2.5f;

constexpr float kLog2E = std::numbers::log2e_v<float>;

/// Where exp(log2(e) x) stands for exp2(log2(e) x), as in libfreenect2, an exponent to base 2 grows once more.
float stretch(Exponentials exponentials) { return exponentials == Exponentials::kBase2 ? 1 : kLog2E; }

gpu::UnwrapPhasesParams params_of(Exponentials exponentials) {
    constexpr float kMinLength = kMinAmplitude / gpu::kAmplitudeScale;
    gpu::UnwrapPhasesParams params{};
    params.exponent = -kExponent * kLog2E * stretch(exponentials);
    params.min_square = kMinLength * kMinLength;
    params.max_distance = kMaxDistance;
    params.min_amplitude = kMinAmplitude;
    params.min_sum = kMinSum;
    params.slope = kSlope;  // log2(e) and ln(2) cancel
    params.offset = kOffset * std::numbers::ln10_v<float> * kLog2E * stretch(exponentials);
    params.min_residual = kMinResidual;
    params.max_residual = kMaxResidual;
    return params;
}

}  // namespace

graph::ImageId add_unwrap_phases(graph::FrameGraph& frame, const TableIds& tables, const PhasorIds& phasors,
                                 const DecodeSettings& settings) {
    auto pass = frame.compute("kinect2.unwrap_phases", spirv::unwrap_phases);
    pass.specialise("kSmooth", settings.smooth_phases);
    pass.read("phasors_ab", phasors.ab).read("phasors_c", phasors.c).read("offsets_c_ray", tables.offsets_c_ray);
    const graph::ImageId readings = pass.create("readings", {kInfraredExtent, vulkan::Format::kRgba32f});
    pass.push(params_of(settings.exponentials));
    pass.dispatch_covering({gpu::kInfraredWidth, gpu::kInfraredHeight / gpu::kUnwrapPhasesRows});
    return readings;
}

}  // namespace patina::kinect2
