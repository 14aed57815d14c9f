#pragma once

#include <functional>
#include <memory>
#include <string>

#include "cameras/kinect2_decoder.h"
#include "sensor/kinect2/raw_frame.h"
#include "sensor/kinect2/tick_clock.h"
#include "sensor/recording/recording_source.h"

namespace patina::cameras {

/// What a recording keeps of a Kinect v2's stream beside its frames: the streams "infrared" and "color", with bytes as
/// the device sends them, and the pages of its calibration as attachments. Throws Error as parse_calibration() and
/// kinect2_info(). `name` is the device, for messages.
sensor::RecordedSequence kinect2_sequence(const sensor::kinect2::CalibrationPages& pages, const std::string& name);

/// Turns raw frames into those of a recording. Nothing of them is lost.
class Kinect2Packer {
  public:
    /// The next frame. Indices count from 0, times from the first frame on.
    sensor::RecordedFrame pack(sensor::kinect2::RawFrame raw);

  private:
    sensor::kinect2::TickClock clock_;
    uint32_t next_ = 0;
};

/// Decodes such frames. Throws as Kinect2Decoder. The tables on the device are made with the first frame.
class Kinect2PayloadDecoder : public sensor::PayloadDecoder {
  public:
    using GiveDevice = std::function<vulkan::Device&()>;
    /// Takes the infrared picture of each frame that is decoded (Kinect2Pictures), before decode() returns.
    using OnInfrared = std::function<void(Image<float>)>;

    /// `give_device` is called by the first decode(), on whose thread the device is used; the device outlives this.
    /// `where` is the camera or the recording, for messages. Throws Error where a page of the calibration is missing or
    /// damaged.
    Kinect2PayloadDecoder(GiveDevice give_device, const sensor::RecordedSequence& sequence, std::string where,
                          OnInfrared on_infrared = {});

    void decode(const sensor::RecordedFrame& recorded, Frame& frame) override;

    /// Makes the tables, and lets the device build what it needs, before the first decode().
    void prepare() { decoder().prepare(); }

  private:
    Kinect2Decoder& decoder();

    GiveDevice give_device_;
    OnInfrared on_infrared_;
    std::string where_;
    std::vector<sensor::RecordedStream> streams_;
    kinect2::CameraModel model_;
    std::unique_ptr<Kinect2Decoder> decoder_;
};

/// Whether a recorded sequence holds what a Kinect v2 sends.
bool is_kinect2(const sensor::RecordedSequence& sequence);

}  // namespace patina::cameras
