#include "cameras/kinect2_recorded.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "engine/core/error.h"
#include "sensor/recording/payload_codec.h"

namespace patina::cameras {

namespace {

using sensor::kinect2::CalibrationPages;
using sensor::kinect2::RawFrame;

/// Ten packed sub-images as RawFrame::infrared has them.
constexpr const char* kInfraredEncoding = "kinect2-infrared";

enum Stream : uint32_t { kInfrared, kColor };

struct Page {
    const char* name;
    std::vector<uint8_t> CalibrationPages::*content;
};

constexpr std::array kPages{
    Page{"firmware", &CalibrationPages::firmware},
    Page{"serial", &CalibrationPages::serial},
    Page{"p0_tables", &CalibrationPages::p0_tables},
    Page{"depth_parameters", &CalibrationPages::depth_parameters},
    Page{"color_parameters", &CalibrationPages::color_parameters},
};

CalibrationPages pages_in(const sensor::RecordedSequence& sequence, const std::string& where) {
    CalibrationPages pages;
    for (const Page& page : kPages) {
        const auto found = std::ranges::find(sequence.attachments, page.name, &sensor::Attachment::name);
        if (found == sequence.attachments.end())
            throw Error(where, " holds frames of a Kinect v2, but not the page '", page.name, "' of its calibration");
        pages.*page.content = found->content;
    }
    return pages;
}

bool is_known(float value) { return std::isfinite(value) && value > 0; }

Exposure exposure_of(const RawFrame& raw) {
    Exposure exposure;
    if (is_known(raw.color_exposure_ms)) exposure.exposure_s = 0.001 * raw.color_exposure_ms;
    if (is_known(raw.color_gain)) exposure.gain = raw.color_gain;
    return exposure;
}

/// JSON has no number that is not finite.
std::string json_number(float value) { return std::isfinite(value) ? text(value) : "null"; }

}  // namespace

sensor::RecordedSequence kinect2_sequence(const CalibrationPages& pages, const std::string& name) {
    sensor::RecordedSequence sequence;
    sequence.info = kinect2_info(camera_model(sensor::kinect2::parse_calibration(pages, name)), name);
    sequence.streams.resize(2);
    sequence.streams[kInfrared] = {"infrared", kInfraredEncoding, sensor::kinect2::kSecondsPerTick};
    sequence.streams[kColor] = {"color", std::string(sensor::kJpegPicture), sensor::kinect2::kSecondsPerTick};
    for (const Page& page : kPages) sequence.attachments.push_back({page.name, pages.*page.content});
    return sequence;
}

sensor::RecordedFrame Kinect2Packer::pack(RawFrame raw) {
    sensor::RecordedFrame frame;
    frame.index = next_++;
    frame.timestamp_s = clock_.seconds(raw.timestamp);
    frame.exposure = exposure_of(raw);
    const std::string said = text(R"({"exposure_ms": )", json_number(raw.color_exposure_ms), R"(, "gain": )",
                                  json_number(raw.color_gain), R"(, "gamma": )", json_number(raw.color_gamma), "}");
    frame.payloads.push_back({kInfrared, raw.sequence, raw.timestamp, "", std::move(raw.infrared)});
    frame.payloads.push_back({kColor, raw.color_sequence, raw.color_timestamp, said, std::move(raw.color)});
    return frame;
}

Kinect2PayloadDecoder::Kinect2PayloadDecoder(GiveDevice give_device, const sensor::RecordedSequence& sequence,
                                             std::string where, OnInfrared on_infrared)
    : give_device_(std::move(give_device)),
      on_infrared_(std::move(on_infrared)),
      where_(std::move(where)),
      streams_(sequence.streams),
      model_(camera_model(sensor::kinect2::parse_calibration(pages_in(sequence, where_), where_))) {}

Kinect2Decoder& Kinect2PayloadDecoder::decoder() {
    if (!decoder_) decoder_ = std::make_unique<Kinect2Decoder>(give_device_(), model_, on_infrared_ != nullptr);
    return *decoder_;
}

void Kinect2PayloadDecoder::decode(const sensor::RecordedFrame& recorded, Frame& frame) {
    std::span<const uint8_t> infrared, jpeg;
    for (const sensor::Payload& payload : recorded.payloads)
        (streams_.at(payload.stream).name == "color" ? jpeg : infrared) = payload.content;
    Kinect2Pictures pictures = decoder().decode(infrared, jpeg, text(where_, ": frame ", recorded.index));
    if (on_infrared_) on_infrared_(std::move(pictures.infrared));
    frame.color = std::move(pictures.color);
    frame.depth = std::move(pictures.depth_m);
}

bool is_kinect2(const sensor::RecordedSequence& sequence) {
    return std::ranges::all_of(sequence.streams, [](const sensor::RecordedStream& stream) {
        return (stream.name == "infrared" && stream.encoding == kInfraredEncoding) ||
               (stream.name == "color" && stream.encoding == sensor::kJpegPicture);
    });
}

}  // namespace patina::cameras
