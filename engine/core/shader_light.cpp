#include "engine/core/shader_light.h"

namespace patina {

gpu::PointLight make_point_light(const Light& light) {
    return {glm::vec4(light.position_m, light.radius_m), glm::vec4(light.intensity, is_sun(light) ? 1 : 0),
            glm::vec4(light.axis, is_flat(light) ? 0 : 1)};
}

Light light_of(const gpu::PointLight& light) {
    return {glm::dvec3(light.position_m), glm::dvec3(light.intensity), light.position_m.w, glm::dvec3(light.axis)};
}

Light rounded_to_float(const Light& light) { return light_of(make_point_light(light)); }

}  // namespace patina
