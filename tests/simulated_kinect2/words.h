#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace patina::sensor::kinect2::testing {

/// Adds a little-endian number.
template <class T>
void put(std::vector<uint8_t>& bytes, T value) {
    const auto* begin = reinterpret_cast<const uint8_t*>(&value);
    bytes.insert(bytes.end(), begin, begin + sizeof value);
}

/// The little-endian word at a byte offset; 0 beyond the end.
inline uint32_t word_at(std::span<const uint8_t> bytes, size_t offset) {
    uint32_t word = 0;
    if (offset + sizeof word <= bytes.size()) std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

}  // namespace patina::sensor::kinect2::testing
