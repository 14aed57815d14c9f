#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "engine/core/error.h"

namespace patina::sensor::kinect2 {

static_assert(std::endian::native == std::endian::little, "the device's little-endian words are copied as they are");

/// The number at a byte offset, which need not be aligned; it must lie within the bytes.
template <class T>
T read_at(std::span<const uint8_t> bytes, size_t offset) {
    static_assert(std::is_arithmetic_v<T>);
    PATINA_ASSERT(offset + sizeof(T) <= bytes.size(), "offset ", offset, " of ", bytes.size());
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

/// Adds a number at the end.
template <class T>
void append(std::vector<uint8_t>& bytes, T value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes.resize(bytes.size() + sizeof value);
    std::memcpy(bytes.data() + bytes.size() - sizeof value, &value, sizeof value);
}

}  // namespace patina::sensor::kinect2
