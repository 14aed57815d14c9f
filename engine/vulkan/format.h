#pragma once

#include <cstdint>

namespace patina::vulkan {

/// Pixel formats that every Vulkan device can store to and load from in a compute shader.
enum class Format : uint8_t { kR32f, kRgba32f, kRgba16f, kRgba8, kR32u, kRgba32u };

/// Bytes per pixel.
constexpr uint32_t bytes_per_pixel(Format format) {
    switch (format) {
        case Format::kRgba32f:
        case Format::kRgba32u: return 16;
        case Format::kRgba16f: return 8;
        case Format::kR32f:
        case Format::kRgba8:
        case Format::kR32u: return 4;
    }
    return 0;
}

/// The format as a GLSL layout qualifier spells it, "rgba16f".
constexpr const char* name_of(Format format) {
    switch (format) {
        case Format::kR32f: return "r32f";
        case Format::kRgba32f: return "rgba32f";
        case Format::kRgba16f: return "rgba16f";
        case Format::kRgba8: return "rgba8";
        case Format::kR32u: return "r32ui";
        case Format::kRgba32u: return "rgba32ui";
    }
    return "?";
}

}  // namespace patina::vulkan
