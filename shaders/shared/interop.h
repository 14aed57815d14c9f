// Lets one header define a struct for C++ and GLSL. In C++ it opens namespace patina::gpu, where the names of GLSL's
// types mean GLM's; in GLSL it does nothing. Rules: 32-bit members only, no vec3, padding spelled out; the build
// compares every field's offset and type with the SPIR-V.
#ifdef __cplusplus
#pragma once
#include <cstdint>

#include <glm/glm.hpp>
namespace patina::gpu {
using uint = uint32_t;
using glm::ivec2;
using glm::ivec4;
using glm::mat4;
using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec4;
}  // namespace patina::gpu
#define INTEROP_BEGIN namespace patina::gpu {
#define INTEROP_END }
#define INTEROP_CONST inline constexpr
#else
#define INTEROP_BEGIN
#define INTEROP_END
#define INTEROP_CONST const
#endif
