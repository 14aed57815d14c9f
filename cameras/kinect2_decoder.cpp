#include "cameras/kinect2_decoder.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "engine/core/error.h"
#include "passes/kinect2/decode.h"
#include "passes/kinect2/measure_phases.h"
#include "passes/kinect2/register_color.h"
#include "sensor/files/picture_file.h"

namespace patina::cameras {

namespace {

/// The picture in a JPEG, as the world is.
Image<SrgbPixel> color_of(const sensor::kinect2::RawFrame& raw, const std::string& name) {
    ColorImage decoded;
    try {
        decoded = sensor::decode_color(name, raw.color, kinect2::kColorExtent);
    } catch (const Error& error) {
        throw DamagedFrame(error.what());
    }
    if (!std::holds_alternative<Image<SrgbPixel>>(decoded))
        throw DamagedFrame(name, " has a colour picture in OpenEXR, not in JPEG");
    Image<SrgbPixel> picture = std::get<Image<SrgbPixel>>(std::move(decoded));
    const auto width = static_cast<ptrdiff_t>(picture.extent().width);
    auto row = picture.pixels().begin();
    for (uint32_t y = 0; y < picture.extent().height; ++y, row += width) std::reverse(row, row + width);
    return picture;
}

SequenceInfo info_of(const std::string& name, const Intrinsics& depth, const FittedColorCamera& color,
                     const kinect2::DecodeSettings& settings) {
    SequenceInfo info;
    info.name = name;
    info.format = "kinect2";
    info.fps = 30;
    info.color = color.color;
    info.depth = depth;
    info.max_metres = settings.max_m;
    info.color_from_depth = color.color_from_depth;
    info.exposure_known = true;
    return info;
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

SequenceInfo kinect2_info(const kinect2::CameraModel& model, const std::string& name,
                          const kinect2::DecodeSettings& settings) {
    const kinect2::HostTables tables = kinect2::make_tables(model);
    return info_of(name, tables.depth, fit_color_camera(tables), settings);
}

Kinect2Decoder::Kinect2Decoder(vulkan::Device& device, const kinect2::CameraModel& model,
                               const Kinect2DecoderOptions& options)
    : runner_(device), options_(options), tables_(device, model), color_(fit_color_camera(tables_.host())) {}

Kinect2Pictures Kinect2Decoder::decode(const sensor::kinect2::RawFrame& raw, const std::string& name) {
    constexpr size_t kInfraredBytes = gpu::kPhaseImages * kinect2::kSubImageBytes;
    if (raw.infrared.size() < kInfraredBytes)
        throw DamagedFrame(name, " has an infrared frame of ", raw.infrared.size(), " bytes, but ", kInfraredBytes,
                           " are needed");
    Kinect2Pictures pictures;
    if (options_.registered) pictures.color = color_of(raw, name);  // the device needs it, too

    graph::FrameGraph frame = runner_.begin();
    const kinect2::TableIds tables = tables_.import(frame);
    const auto images = kinect2::add_decode(frame, tables, raw.infrared, options_.settings);
    const graph::Readback depth_m = frame.read_back(images.depth_m), infrared = frame.read_back(images.infrared);
    graph::Readback registered;
    if (options_.registered)
        registered = frame.read_back(
            kinect2::add_register_color(frame, tables_, tables, images.depth_m, pictures.color.pixels()));
    runner_.submit(std::move(frame));
    if (!options_.registered) pictures.color = color_of(raw, name);
    runner_.wait();

    pictures.depth_m = depth_m.image<float>();
    pictures.infrared = infrared.image<float>();
    if (options_.registered) pictures.registered = registered.image<uint32_t>();
    return pictures;
}

SequenceInfo Kinect2Decoder::info(const std::string& name) const {
    return info_of(name, depth_camera(), color_, options_.settings);
}

}  // namespace patina::cameras
