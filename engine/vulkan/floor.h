#pragma once

#include <cstdint>

/// What every device that Patina runs on offers: shaders are held to it when they are packed, devices when they are
/// opened. Descriptors count as the driver counts them: an array is as many as its length.
namespace patina::vulkan::floor {

constexpr uint32_t kStorageBuffers = 16;  ///< per stage
constexpr uint32_t kStorageImages = 8;    ///< per stage; storage texel buffers count among them
constexpr uint32_t kSampledImages = 16;   ///< per stage, as every Vulkan device
constexpr uint32_t kUniformBuffers = 12;  ///< per stage, as every Vulkan device
constexpr uint32_t kPushBytes = 128;
constexpr uint32_t kGroupInvocations = 256;
constexpr uint32_t kSharedBytes = 16384;
constexpr uint64_t kStorageRange = uint64_t{128} << 20;  ///< bytes

/// Storage images per stage that the shaders called NAME_texel may bind: variants which are chosen only on devices that
/// have as many.
constexpr uint32_t kTexelVariantImages = 16;

}  // namespace patina::vulkan::floor
