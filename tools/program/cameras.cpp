#include "tools/program/cameras.h"

#include "engine/core/printable.h"
#include "sensor/kinect2/usb_transport.h"
#include "tools/program/standard_streams.h"

namespace patina::tools {

bool is_camera(const std::string& source) { return source == kKinect2; }

std::shared_ptr<cameras::Kinect2Capture> open_kinect2() {
    auto capture = std::make_shared<cameras::Kinect2Capture>(sensor::kinect2::open_usb());
    if (const std::string warning = capture->warning(); !warning.empty())
        print_error("warning: {}\n", printable(warning));
    return capture;
}

}  // namespace patina::tools
