#pragma once

#include <cstdint>
#include <vector>

namespace patina::sensor::kinect2::testing::usbip {

/// The descriptor that a GET_DESCRIPTOR request asks for, `value` as in it (kind and index). Endpoints are those of the
/// device; audio is left out. Empty: there is none.
std::vector<uint8_t> descriptor(uint16_t value, uint32_t infrared_bytes_per_interval);

}  // namespace patina::sensor::kinect2::testing::usbip
