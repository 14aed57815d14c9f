// In place of the cameras where this program was built without OpenNI2.

#include "engine/core/error.h"
#include "sensor/live/other_cameras.h"

namespace patina::sensor {

std::unique_ptr<PictureCamera> open_openni2(const std::string&) {
    throw Error(
        "this patina reads no camera of OpenNI2: libopenni2-dev was not installed when it was built (tools/setup "
        "installs it)");
}

std::string openni2_report() { return "OpenNI2\n  not built in      libopenni2-dev was not installed\n"; }

}  // namespace patina::sensor
