#pragma once

#include <cstddef>
#include <span>

#include "passes/kinect2/tables.h"

namespace patina::kinect2 {

/// Bytes of one sub-image of an infrared frame.
inline constexpr size_t kSubImageBytes = size_t{gpu::kInfraredHeight} * gpu::kRowWords * 4;

/// A phasor per modulation frequency: its angle is the phase, its length 1.5 times the amplitude. Both images are
/// 512 x 424 rgba32f, as the sensor's pixels are; 0 where the sensor was saturated or has no data.
struct PhasorIds {
    graph::ImageId ab;  ///< at 80 MHz, then at 16 MHz
    graph::ImageId c;   ///< at 120 MHz; z: infrared light, 0 to 65535, which is 16 times the amplitudes' mean, with
                        ///< 65535 for the length of a saturated phasor
};

/// Uploads an infrared frame as the sensor sends it and computes the phasors (libfreenect2, stage 1). `infrared`: the
/// sub-images one after the other, of which the first nine are used; rows of 512 codes of 11 bits, interleaved, the
/// lower half bottom up. Throws Error when there are fewer bytes than nine sub-images.
PhasorIds add_measure_phases(graph::FrameGraph& frame, const TableIds& tables, std::span<const uint8_t> infrared);

}  // namespace patina::kinect2
