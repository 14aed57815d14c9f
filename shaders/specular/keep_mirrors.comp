#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation per label: forgets its material, and that it may be a mirror, unless it is sure to be one.
#include "lib/lighting/set_material.glsl"
#include "shared/specular/mirror_fit.h"

layout(local_size_x = kMirrorGroup) in;
layout(std430, binding = 0) buffer Mirrors { MirrorFit mirrors[]; };
layout(std430, binding = 1) buffer Materials { SegmentMaterial materials[]; };
layout(push_constant) uniform Push { KeepMirrorsParams params; };

void main() {
    const uint label = gl_GlobalInvocationID.x;
    if (label >= params.labels) return;
    const bool known = label < params.materials;
    const SegmentMaterial material = materials[known ? label : 0u];
    if (known && material.mirror >= kSureMirror) return;
    mirrors[label] = MirrorFit(vec4(0.0), vec4(0.0), 0.0, 0.0, 0u, 0u);
    if (known && material.version != 0u)
        materials[label] = SegmentMaterial(vec4(0.0, 0.0, 0.0, 1.0), material.version % 0xffffu + 1u, 0.0, 0.0, 0u);
}
