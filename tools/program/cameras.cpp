#include "tools/program/cameras.h"

#include "cameras/kinect2_recorded.h"
#include "cameras/played_capture.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "sensor/kinect2/usb_transport.h"
#include "sensor/live/other_cameras.h"
#include "sensor/open.h"
#include "tools/program/standard_streams.h"

namespace patina::tools {

namespace {

const std::string kOpenNi2Prefix = std::string(kOpenNi2) + ":";

bool is_openni2(const std::string& source) { return source == kOpenNi2 || source.starts_with(kOpenNi2Prefix); }

}  // namespace

bool is_camera(const std::string& source) { return source == kKinect2 || source == kKinect1 || is_openni2(source); }

std::shared_ptr<sensor::CameraSource> open_other_camera(const std::string& name) {
    if (name == kKinect1) return std::make_shared<sensor::CameraSource>(sensor::open_kinect1());
    const std::string uri = name == kOpenNi2 ? "" : name.substr(kOpenNi2Prefix.size());
    return std::make_shared<sensor::CameraSource>(sensor::open_openni2(uri));
}

std::shared_ptr<cameras::Kinect2Capture> open_kinect2() {
    auto capture = std::make_shared<cameras::Kinect2Capture>(sensor::kinect2::open_usb());
    if (const std::string warning = capture->warning(); !warning.empty())
        print_error("warning: {}\n", printable(warning));
    return capture;
}

std::shared_ptr<cameras::RawCapture> open_raw_to_play(const std::string& recording) {
    if (!sensor::names_recording(recording)) return nullptr;
    const auto [file, role] = sensor::named_sequence(recording);
    const sensor::RecordingFile recorded(file);
    if (!recorded.has(role)) return nullptr;
    const sensor::RecordedSequence& sequence = recorded.sequence(role);
    if (sensor::holds_pictures(sequence) || !cameras::is_kinect2(sequence)) return nullptr;
    return std::make_shared<cameras::PlayedCapture>(file, role);
}

}  // namespace patina::tools
