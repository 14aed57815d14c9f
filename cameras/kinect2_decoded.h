#pragma once

#include <string>

#include "cameras/kinect2_recorded.h"
#include "cameras/raw_capture.h"

namespace patina::cameras {

/// What a recording keeps of a Kinect v2 whose frames are decoded before they are recorded: "depth" in metres as the
/// decode passes give it, and "color" as the JPEG that the camera sent, to be mirrored back. The calibration's pages
/// stay attached.
sensor::RecordedSequence kinect2_decoded_sequence(sensor::RecordedSequence raw);

/// Turns raw frames into those of such a sequence. Reading them yields what reading the raw ones yields, bit for bit,
/// without a device. What only raw frames have is lost: infrared pictures, and other settings of the decoder.
class Kinect2Repacker {
  public:
    /// Arguments and errors as Kinect2PayloadDecoder.
    Kinect2Repacker(Kinect2PayloadDecoder::GiveDevice give_device, const sensor::RecordedSequence& raw,
                    const std::string& where)
        : decoder_(std::move(give_device), raw, where), raw_streams_(raw.streams) {}

    /// Kinect2PayloadDecoder::prepare().
    void prepare() { decoder_.prepare(); }

    /// Skipped where the frame is damaged. Throws Error where the device fails.
    RawReading repack(const sensor::RecordedFrame& raw);

  private:
    Kinect2PayloadDecoder decoder_;
    std::vector<sensor::RecordedStream> raw_streams_;
};

}  // namespace patina::cameras
