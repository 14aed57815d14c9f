#pragma once

#include <filesystem>
#include <vector>

#include "sensor/recording/recorder.h"

namespace patina::sensor::testing {

/// Records test_frame()s of test_info(), and as many of low exposure where `lighting` is set; waits for a full queue.
void write_recording(const std::filesystem::path& file, uint32_t frames, bool lighting = false);

/// Whether two frames are the same to the last bit.
bool same_frame(const Frame& a, const Frame& b);

/// Bytes that no compression makes smaller, of a seed.
std::vector<uint8_t> noise_bytes(size_t count, uint64_t seed);

/// A sequence of one stream of a device's own.
RecordedSequence raw_sequence();
/// A frame of it with a payload of noise, 1/30 s after the last.
RecordedFrame raw_frame(uint32_t index, size_t bytes);

}  // namespace patina::sensor::testing
