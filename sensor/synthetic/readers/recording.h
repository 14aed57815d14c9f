#pragma once

#include "sensor/json_file.h"
#include "sensor/synthetic/recording.h"

namespace patina::sensor {

/// Reads the member "recording" of a scene file; what it leaves out keeps Recording's defaults.
Recording read_recording(const JsonValue& value);

}  // namespace patina::sensor
