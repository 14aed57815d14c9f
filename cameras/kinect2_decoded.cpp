#include "cameras/kinect2_decoded.h"

#include <utility>

#include "sensor/recording/payload_codec.h"

namespace patina::cameras {

namespace {

enum DecodedStream : uint32_t { kDepthMetres, kColorPicture };

}  // namespace

sensor::RecordedSequence kinect2_decoded_sequence(sensor::RecordedSequence raw) {
    raw.streams.resize(2);
    raw.streams[kDepthMetres] = {"depth", std::string(sensor::kDepthFloat), sensor::kinect2::kSecondsPerTick};
    raw.streams[kColorPicture] = {"color", std::string(sensor::kMirroredJpegPicture), sensor::kinect2::kSecondsPerTick};
    return raw;
}

RawReading Kinect2Repacker::repack(const sensor::RecordedFrame& raw) {
    Frame frame;
    try {
        decoder_.decode(raw, frame);
    } catch (const sensor::DamagedFrame& error) {
        return Skipped{raw.index, error.what()};
    }
    sensor::RecordedFrame decoded = raw;
    for (sensor::Payload& payload : decoded.payloads) {
        const bool is_color = raw_streams_.at(payload.stream).name == "color";
        payload.stream = is_color ? kColorPicture : kDepthMetres;
        if (!is_color) payload.content = sensor::encode(frame.depth);
    }
    return decoded;
}

}  // namespace patina::cameras
