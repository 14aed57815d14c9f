// The isotropic Ward BRDF with point lights. Functions without bindings.
#ifndef PATINA_LIB_WARD_GLSL
#define PATINA_LIB_WARD_GLSL

const float kWardPi = 3.14159265358979;

// The Ward lobe without its albedo, e^gamma / N (paper, Eq. 3 and 4), in 1/sr. `normal`, `to_light` and `to_viewer` are
// of unit length; alpha > 0. 0 where the light or the viewer is at or below the horizon, where N has no meaning.
float ward_lobe(float alpha, vec3 normal, vec3 to_light, vec3 to_viewer) {
    const float cos_i = dot(normal, to_light);
    const float cos_o = dot(normal, to_viewer);
    if (min(cos_i, cos_o) <= 0.0) return 0.0;
    // tan(theta_h) from the half vector's tangential part: 1 - cos^2 would cancel in sharp highlights.
    const vec3 half_vector = to_light + to_viewer;
    const float along = dot(normal, half_vector);
    const vec3 across = half_vector - along * normal;
    const float tan2_h = dot(across, across) / (along * along);
    const float alpha2 = alpha * alpha;
    return exp(-tan2_h / alpha2) / (4.0 * kWardPi * alpha2 * sqrt(cos_i * cos_o));
}

// The Ward BRDF (paper, Eq. 2), in 1/sr; kd and ks are RGB albedos. 0 where the light or the viewer is at or below the
// horizon.
vec3 ward(vec3 kd, vec3 ks, float alpha, vec3 normal, vec3 to_light, vec3 to_viewer) {
    if (min(dot(normal, to_light), dot(normal, to_viewer)) <= 0.0) return vec3(0.0);
    return kd / kWardPi + ks * ward_lobe(alpha, normal, to_light, to_viewer);
}

// What a point light adds to a pixel (one term of the paper's Eq. 6): BRDF * intensity / r^2 * cos(theta_i).
// `light_offset_m` leads from the surface point to the light; a light in the surface point itself adds nothing.
vec3 ward_point_light(vec3 kd, vec3 ks, float alpha, vec3 normal, vec3 light_offset_m, vec3 intensity, vec3 to_viewer) {
    const float distance2 = dot(light_offset_m, light_offset_m);
    if (distance2 <= 0.0) return vec3(0.0);
    const vec3 to_light = light_offset_m * inversesqrt(distance2);
    return ward(kd, ks, alpha, normal, to_light, to_viewer) * intensity * (max(dot(normal, to_light), 0.0) / distance2);
}

#endif
