#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "engine/vulkan/format.h"

namespace patina::vulkan {

/// What a shader binds at one binding number.
enum class BindingKind : uint8_t {
    kStorageBuffer,
    kUniformBuffer,
    kSampledImage,
    kStorageImage,
    kTexelBuffer,  ///< imageBuffer: a storage texel buffer, gathered faster than a storage buffer on software devices
};

/// One binding of descriptor set 0, as reflection found it.
struct ShaderBinding {
    const char* name;  ///< the block's name for buffers ("Lights"), the variable's for images ("position_m")
    uint32_t binding;
    BindingKind kind;
    uint32_t count;  ///< array length, 1 for a single resource
    bool reads;      ///< not declared writeonly
    bool writes;     ///< not declared readonly
    Format format;   ///< storage images and texel buffers only
};

/// A specialization constant. Booleans are 0 or 1.
struct ShaderConstant {
    const char* name;
    uint32_t id;
    uint32_t default_value;  ///< bit pattern
};

/// A compute shader compiled at build time: SPIR-V with what reflection read from it. Every instance is a generated
/// constant in namespace patina::spirv and lives as long as the program.
struct Shader {
    const char* name;  ///< "fusion.integrate"
    std::span<const uint32_t> words;
    std::span<const ShaderBinding> bindings;    ///< sorted by binding number
    std::span<const ShaderConstant> constants;  ///< sorted by id
    uint32_t push_bytes;
    std::array<uint32_t, 3> group_size;

    const ShaderBinding* find_binding(std::string_view binding_name) const {
        for (const ShaderBinding& binding : bindings) {
            if (binding_name == binding.name) return &binding;
        }
        return nullptr;
    }
    const ShaderConstant* find_constant(std::string_view constant_name) const {
        for (const ShaderConstant& constant : constants) {
            if (constant_name == constant.name) return &constant;
        }
        return nullptr;
    }
};

}  // namespace patina::vulkan
