#include "passes/kinect2/decode.h"

#include "passes/kinect2/measure_phases.h"
#include "passes/kinect2/unwrap_phases.h"

namespace patina::kinect2 {

UndistortedImages add_decode(graph::FrameGraph& frame, const TableIds& tables, std::span<const uint8_t> infrared,
                             const DecodeSettings& settings) {
    const PhasorIds phasors = add_measure_phases(frame, tables, infrared);
    return add_undistort_depth(frame, tables, add_unwrap_phases(frame, tables, phasors, settings), settings);
}

}  // namespace patina::kinect2
