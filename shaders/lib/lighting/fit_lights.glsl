// Lights as the Ward fit sees them. The includer declares
//   layout(std140, binding = n) uniform Lights { LightHeader header; PointLight lights[kMaxPointLights]; };
#ifndef PATINA_LIB_FIT_LIGHTS_GLSL
#define PATINA_LIB_FIT_LIGHTS_GLSL
#include "lib/brdf/ward.glsl"
#include "lib/lighting/lamp_emission.glsl"
#include "lib/records/reflectance.glsl"

struct FitLight {
    vec3 to_light;
    float cosine;
    vec3 gloss;     // intensity / r^2 ward_light_part(); 0 where it does not reach the voxel
    vec3 received;  // irradiance / pi, likewise
};

FitLight fit_light(uint i, vec3 point_m, vec3 normal, uvec2 reached) {
    const vec3 offset_m = lights[i].position_m.xyz - point_m;
    const float distance2 = max(dot(offset_m, offset_m), 1e-6);
    const vec3 to_light = offset_m * inversesqrt(distance2);
    const float cosine = max(dot(normal, to_light), 0.0);
    const vec3 facing = bit_is_set(reached, i) ? intensity_from(lights[i], to_light) / distance2 : vec3(0.0);
    return FitLight(to_light, cosine, facing * ward_light_part(cosine), facing * (cosine / kPi));
}

float tan2_of_half(FitLight light, vec3 to_viewer, float viewer_cosine) {
    return ward_half_tan2(light.cosine, viewer_cosine, dot(light.to_light, to_viewer));
}

#endif
