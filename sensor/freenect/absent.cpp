// In place of the camera where this program was built without libfreenect.

#include "engine/core/error.h"
#include "sensor/live/other_cameras.h"

namespace patina::sensor {

std::unique_ptr<PictureCamera> open_kinect1() {
    throw Error(
        "this patina reads no Kinect v1: libfreenect-dev was not installed when it was built (tools/setup installs "
        "it)");
}

std::string kinect1_report() { return "Kinect v1\n  not built in      libfreenect-dev was not installed\n"; }

}  // namespace patina::sensor
