#include "reconstruction/session/warm_up.h"

#include <algorithm>
#include <cmath>

#include "reconstruction/session/rgbd_frame.h"

namespace patina {

namespace {

/// The first places the volume, the second is tracked, the others are fused into segments that are there.
constexpr uint32_t kWarmUpFrames = 4;

/// What is built does not depend on the pictures' sizes: they have a quarter of the camera's, and 64 pixels at least.
constexpr uint32_t kWarmUpShare = 4, kWarmUpSide_px = 64;

uint32_t warm_up_side(uint32_t pixels) { return std::max(pixels / kWarmUpShare, std::min(pixels, kWarmUpSide_px)); }

Intrinsics warm_up_camera(const Intrinsics& camera) {
    return scaled_to(camera, {warm_up_side(camera.extent.width), warm_up_side(camera.extent.height)});
}

/// Along the optical axis: a box before a wall, between a floor, a ceiling and two sides, so that the camera tracks.
float corner_m(const Intrinsics& camera, uint32_t x, uint32_t y) {
    const double rx = std::abs((x - camera.cx) / camera.fx), ry = std::abs((y - camera.cy) / camera.fy);
    const double box_m = rx < 0.2 && ry < 0.15 ? 1.2 : 1.6;
    return static_cast<float>(std::min({box_m, 0.9 / std::max(rx, 1e-6), 0.7 / std::max(ry, 1e-6)}));
}

Frame corner_frame(const SequenceInfo& info, uint32_t index) {
    Frame frame;
    frame.index = index;
    frame.timestamp_s = index / std::max(info.fps, 1.0);
    frame.world_from_camera = RigidTransform(1.0);
    Image<float> depth_m(info.depth.extent);
    for (uint32_t y = 0; y < depth_m.extent().height; ++y)
        for (uint32_t x = 0; x < depth_m.extent().width; ++x) depth_m.at(x, y) = corner_m(info.depth, x, y);
    // Cameras send either.
    if (index % 2 == 0) {
        frame.depth = std::move(depth_m);
    } else {
        Image<uint16_t> units(depth_m.extent());
        std::ranges::transform(depth_m.pixels(), units.pixels().begin(), [&](float z) {
            return static_cast<uint16_t>(std::min(std::round(z / info.metres_per_unit), 65535.0));
        });
        frame.depth = std::move(units);
    }
    Image<SrgbPixel> color(info.color.extent);
    for (uint32_t y = 0; y < color.extent().height; ++y)
        for (uint32_t x = 0; x < color.extent().width; ++x)
            color.at(x, y) = SrgbPixel(80 + (x / 8 + y / 8) % 2 * 60, 100, 120);
    frame.color = std::move(color);
    return frame;
}

}  // namespace

void warm_up(vulkan::Device& device, const ReconstructionSettings& settings, const SequenceInfo& info,
             const Illumination& illumination, const std::function<bool()>& stop) {
    SequenceInfo small = info;
    small.depth = warm_up_camera(info.depth);
    small.color = warm_up_camera(info.color);
    Pipeline pipeline(device, settings);
    pipeline.set_lights(lights_of(illumination), illumination.ambient);
    for (uint32_t i = 0; i < kWarmUpFrames && !stop(); ++i) {
        const Frame frame = corner_frame(small, i);
        RgbdFrame rgbd = to_rgbd(small, frame);
        rgbd.world_from_depth = RigidTransform(1.0);
        pipeline.add(rgbd);
        pipeline.view(small.depth, RigidTransform(1.0));
    }
    pipeline.wait();
}

}  // namespace patina
