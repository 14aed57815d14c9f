#include "reconstruction/session/rgbd_frame.h"

namespace patina {

namespace {

template <class Pixel>
std::span<const Pixel> span_of(const Image<Pixel>& image) {
    return {image.pixels().data(), image.pixels().size()};
}

}  // namespace

RgbdFrame to_rgbd(const SequenceInfo& info, const Frame& frame) {
    RgbdFrame rgbd;
    std::visit([&](const auto& image) { rgbd.depth.pixels = span_of(image); }, frame.depth);
    std::visit([&](const auto& image) { rgbd.color.pixels = span_of(image); }, frame.color);
    rgbd.depth.camera = info.depth;
    rgbd.depth.metres_per_unit = info.metres_per_unit;
    rgbd.depth.max_metres = info.max_metres;
    rgbd.color.camera = info.color;
    rgbd.color_from_depth = info.color_from_depth;
    rgbd.world_from_depth = frame.world_from_camera.value_or(RigidTransform(1.0));
    rgbd.time.timestamp_s = frame.timestamp_s;
    return rgbd;
}

float shutter_share(const SequenceInfo& info, const Frame& frame, double before_s) {
    if (!info.motion_blur) return 0;
    const double open_s = info.exposure_known ? frame.exposure.exposure_s : 0.5 / info.fps;
    const double since_s = frame.timestamp_s - before_s;
    return since_s > open_s ? static_cast<float>(open_s / since_s) : 1.0f;
}

}  // namespace patina
