#pragma once

#include <memory>
#include <string>

#include "sensor/kinect2/transport.h"

namespace patina::sensor::kinect2 {

/// Opens a Kinect v2 over libusb, resets it and claims its interfaces. `serial`: which one; empty takes the first.
/// Throws Error when there is none, it may not be opened, another program uses it, or its link is not SuperSpeed.
std::unique_ptr<Transport> open_usb(const std::string& serial = "");

}  // namespace patina::sensor::kinect2
