#pragma once

#include "tools/viewer/display.h"
#include "tools/viewer/viewer_state.h"

namespace patina::tools {

/// Whether a key moves the free camera, so that the view no longer follows the sensor.
bool moves_camera(const KeyPress& press);

/// Does what a key stands for (the help panel lists them); other keys change nothing.
void take_key(const KeyPress& press, ViewerState& state);

}  // namespace patina::tools
