#pragma once

#include "scenes/description/recording.h"
#include "sensor/files/json_file.h"

namespace patina::scenes {

/// Reads the member "recording" of a scene file; what it leaves out keeps Recording's defaults.
Recording read_recording(const sensor::JsonValue& value);

}  // namespace patina::scenes
