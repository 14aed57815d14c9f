#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace patina::sensor::kinect2 {

inline constexpr uint32_t kInfraredWidth = 512;
inline constexpr uint32_t kInfraredHeight = 424;
/// Three phases of each of three modulation frequencies, then ambient light.
inline constexpr uint32_t kSubImages = 10;
/// 424 rows of 512 codes of 11 bits: 704 bytes a row.
inline constexpr size_t kSubImageBytes = 298496;
inline constexpr size_t kInfraredBytes = kSubImages * kSubImageBytes;

inline constexpr uint32_t kColorWidth = 1920;
inline constexpr uint32_t kColorHeight = 1080;

/// The device's clock counts 8000 ticks a second in 32 bits, and wraps after 149 hours.
inline constexpr double kSecondsPerTick = 125e-6;

/// One moment as a Kinect v2 sends it, nothing decoded: an infrared frame and the colour picture nearest to it in time.
/// Both pictures are mirrored left to right.
struct RawFrame {
    uint32_t sequence = 0;   ///< of the infrared frame; the device adds 1 a frame, so that a gap is frames lost
    uint32_t timestamp = 0;  ///< of the infrared frame, in ticks (kSecondsPerTick)
    /// kInfraredBytes: the sub-images one after the other, as transmitted (rows interleaved, lower half bottom up).
    std::vector<uint8_t> infrared;

    uint32_t color_sequence = 0;
    uint32_t color_timestamp = 0;  ///< within 16 ms of `timestamp`
    std::vector<uint8_t> color;    ///< a baseline JPEG, kColorWidth x kColorHeight, from FF D8 to FF D9
    float color_exposure_ms = 0;   ///< as the device reports it, 0.5 to 66.5
    float color_gain = 0;          ///< as the device reports it, 1 to 1.5
    float color_gamma = 0;         ///< a third exposure value, 1 to 6.4; probably the analog gain
};

}  // namespace patina::sensor::kinect2
