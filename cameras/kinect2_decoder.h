#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "cameras/kinect2_color_camera.h"
#include "engine/graph/runner.h"
#include "passes/kinect2/tables.h"
#include "patina/frame.h"
#include "patina/source.h"
#include "sensor/kinect2/calibration.h"

namespace patina::cameras {

/// A device's calibration as the passes take it.
kinect2::CameraModel camera_model(const sensor::kinect2::Calibration& calibration);

/// What holds for all frames of such a device's stream, computed on the host. It has no length and no poses. Throws
/// Error as kinect2::make_tables and fit_color_camera.
SequenceInfo kinect2_info(const kinect2::CameraModel& model, const std::string& name);

/// What a Kinect v2 saw at one moment, mirrored back, as the world is.
struct Kinect2Pictures {
    Image<SrgbPixel> color;  ///< 1920 x 1080, of the camera that kinect2_info() fits to the device's polynomials
    Image<float> depth_m;    ///< 512 x 424, of the pinhole Kinect2Decoder::depth_camera(); 0: no reading
    Image<float> infrared;   ///< the same pixels under the sensor's own light, 0 to 65535; empty unless asked for
};

/// Turns what a Kinect v2 sends into pictures: depth on the device, the JPEG meanwhile on the host. The colour picture
/// stays whole. A Frame has a camera of its own for colour, so that none of the 1920 x 1080 pixels is lost, and each
/// keeps the direction from which the colour camera saw it.
class Kinect2Decoder {
  public:
    /// `with_infrared`: whether Kinect2Pictures::infrared is read back. Throws Error as kinect2::Tables. `device`
    /// outlives it.
    Kinect2Decoder(vulkan::Device& device, const kinect2::CameraModel& model, bool with_infrared = false);

    /// Decodes the bytes of RawFrame::infrared and RawFrame::color; waits for the device. `name` is the frame, for
    /// messages. Throws sensor::DamagedFrame where the infrared frame is too short, or the JPEG is damaged or of
    /// another size; Error where the device fails.
    Kinect2Pictures decode(std::span<const uint8_t> infrared, std::span<const uint8_t> jpeg, const std::string& name);

    /// Lets the device build what decode() needs, with a frame that shows nothing. Throws Error where the device fails.
    void prepare();

    const Intrinsics& depth_camera() const { return tables_.host().depth; }

  private:
    graph::Runner runner_;
    kinect2::Tables tables_;
    bool with_infrared_;
};

}  // namespace patina::cameras
