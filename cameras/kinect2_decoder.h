#pragma once

#include <string>

#include "cameras/kinect2_color_camera.h"
#include "engine/graph/runner.h"
#include "passes/kinect2/decode_settings.h"
#include "passes/kinect2/tables.h"
#include "patina/error.h"
#include "patina/frame.h"
#include "sensor/kinect2/calibration.h"
#include "sensor/kinect2/raw_frame.h"

namespace patina::cameras {

/// A device's calibration as the passes take it.
kinect2::CameraModel camera_model(const sensor::kinect2::Calibration& calibration);

/// What holds for all frames of such a device's stream, computed on the host. It has no length and no poses. Throws
/// Error as kinect2::make_tables and fit_color_camera.
SequenceInfo kinect2_info(const kinect2::CameraModel& model, const std::string& name,
                          const kinect2::DecodeSettings& settings = {});

struct Kinect2DecoderOptions {
    kinect2::DecodeSettings settings;
    bool registered = false;  ///< whether Kinect2Pictures::registered is made
};

/// A raw frame whose bytes are not what a Kinect v2 sends. The next one may be.
class DamagedFrame : public Error {
  public:
    using Error::Error;
};

/// What a Kinect v2 saw at one moment, mirrored back, as the world is.
struct Kinect2Pictures {
    Image<SrgbPixel> color;        ///< 1920 x 1080, of Kinect2Decoder::color_camera()
    Image<float> depth_m;          ///< 512 x 424, of the pinhole Kinect2Decoder::depth_camera(); 0: no reading
    Image<float> infrared;         ///< the same pixels under the sensor's own light, 0 to 65535
    Image<uint32_t> registered{};  ///< the same pixels' colours (add_register_color); empty unless asked for
};

/// Turns what a Kinect v2 sends into pictures: depth on the device, the JPEG meanwhile on the host. The colour picture
/// stays whole, beside a camera that is fitted to the device's polynomials: a Frame has a camera of its own for colour,
/// so that none of the 1920 x 1080 pixels is lost, and each keeps the direction from which the colour camera saw it.
class Kinect2Decoder {
  public:
    /// Throws Error as kinect2::Tables and fit_color_camera. `device` outlives it.
    Kinect2Decoder(vulkan::Device& device, const kinect2::CameraModel& model,
                   const Kinect2DecoderOptions& options = {});

    /// Waits for the device. `name` is the camera or the file, for messages. Throws DamagedFrame where the infrared
    /// frame is too short, or the JPEG is damaged or of another size; Error where the device fails.
    Kinect2Pictures decode(const sensor::kinect2::RawFrame& raw, const std::string& name);

    /// As kinect2_info().
    SequenceInfo info(const std::string& name) const;

    const Intrinsics& depth_camera() const { return tables_.host().depth; }
    const FittedColorCamera& color_camera() const { return color_; }

  private:
    graph::Runner runner_;
    Kinect2DecoderOptions options_;
    kinect2::Tables tables_;
    FittedColorCamera color_;
};

}  // namespace patina::cameras
