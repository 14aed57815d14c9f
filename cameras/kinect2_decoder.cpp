#include "cameras/kinect2_decoder.h"

#include <algorithm>
#include <variant>
#include <vector>

#include "passes/kinect2/decode.h"
#include "passes/kinect2/measure_phases.h"
#include "passes/kinect2/register_color.h"
#include "sensor/kinect2/raw_frame.h"
#include "sensor/recording/payload_codec.h"
#include "sensor/recording/recording_source.h"

namespace patina::cameras {

namespace {

static_assert(kinect2::kSubImageBytes == sensor::kinect2::kSubImageBytes);

/// The picture in a JPEG, as the world is.
Image<SrgbPixel> color_of(std::span<const uint8_t> jpeg, const std::string& name) {
    try {
        return std::get<Image<SrgbPixel>>(
            sensor::decode_color(sensor::kMirroredJpegPicture, jpeg, kinect2::kColorExtent, name));
    } catch (const Error& error) {
        throw sensor::DamagedFrame(error.what());
    }
}

}  // namespace

kinect2::CameraModel camera_model(const sensor::kinect2::Calibration& calibration) {
    const auto& depth = calibration.depth;
    const auto& color = calibration.color;
    kinect2::CameraModel model;
    model.depth = {kinect2::kInfraredExtent, depth.fx,       depth.fy,
                   depth.cx - 0.5,           depth.cy - 0.5, {depth.k1, depth.k2, depth.p1, depth.p2, depth.k3}};
    model.color = {color.f, color.cx, color.cy, color.shift_d, color.shift_m, {}, {}};
    std::copy(color.mx.begin(), color.mx.end(), model.color.mx.begin());
    std::copy(color.my.begin(), color.my.end(), model.color.my.begin());
    model.p0 = calibration.p0;
    return model;
}

SequenceInfo kinect2_info(const kinect2::CameraModel& model, const std::string& name) {
    const kinect2::HostTables tables = kinect2::make_tables(model);
    const FittedColorCamera color = fit_color_camera(tables);
    SequenceInfo info;
    info.name = name;
    info.format = "kinect2";
    info.fps = 30;
    info.color = color.color;
    info.depth = tables.depth;
    info.max_metres = kinect2::DecodeSettings{}.max_m;
    info.color_from_depth = color.color_from_depth;
    info.exposure_known = true;
    return info;
}

Kinect2Decoder::Kinect2Decoder(vulkan::Device& device, const kinect2::CameraModel& model, bool with_infrared)
    : runner_(device), tables_(device, model), with_infrared_(with_infrared) {}

Kinect2Pictures Kinect2Decoder::decode(std::span<const uint8_t> infrared, std::span<const uint8_t> jpeg,
                                       const std::string& name) {
    constexpr size_t kNeeded = gpu::kPhaseImages * kinect2::kSubImageBytes;
    if (infrared.size() < kNeeded)
        throw sensor::DamagedFrame(name, " has an infrared frame of ", infrared.size(), " bytes, but ", kNeeded,
                                   " are needed");
    graph::FrameGraph frame = runner_.begin();
    const auto images = kinect2::add_decode(frame, tables_.import(frame), infrared);
    const graph::Readback depth_m = frame.read_back(images.depth_m);
    graph::Readback light;
    if (with_infrared_) light = frame.read_back(images.infrared);
    runner_.submit(std::move(frame));
    Kinect2Pictures pictures;
    pictures.color = color_of(jpeg, name);
    runner_.wait();
    pictures.depth_m = depth_m.image<float>();
    if (with_infrared_) pictures.infrared = light.image<float>();
    return pictures;
}

void Kinect2Decoder::prepare() {
    const std::vector<uint8_t> dark(gpu::kPhaseImages * kinect2::kSubImageBytes);
    graph::FrameGraph frame = runner_.begin();
    frame.read_back(kinect2::add_decode(frame, tables_.import(frame), dark).depth_m);
    runner_.submit(std::move(frame));
    runner_.wait();
}

}  // namespace patina::cameras
