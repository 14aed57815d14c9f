#include "export/environment.h"

#include <algorithm>
#include <cmath>

#include "engine/core/latitude_longitude.h"
#include "engine/core/octahedral.h"
#include "export/light_map.h"

namespace patina {

namespace {

/// A texel, also one beyond the map's border, where the map goes on on the border's other half.
glm::vec4 texel_at(const Image<glm::vec4>& map, int x, int y) {
    const int edge = static_cast<int>(map.extent().width);
    if (x < 0 || x >= edge) {
        x = x < 0 ? -1 - x : 2 * edge - 1 - x;
        y = edge - 1 - y;
    }
    if (y < 0 || y >= edge) {
        y = y < 0 ? -1 - y : 2 * edge - 1 - y;
        x = edge - 1 - x;
    }
    return map.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
}

/// Between the four texels around a direction in the world.
glm::dvec3 radiance_from(const Image<glm::vec4>& far_field, glm::dvec3 ambient, glm::dvec3 direction) {
    if (far_field.empty()) return ambient;
    const glm::dvec2 at = (octahedral_of_direction(direction) + 1.0) * (0.5 * far_field.extent().width) - 0.5;
    const glm::ivec2 low(glm::floor(at));
    const glm::dvec2 part = at - glm::dvec2(low);
    const auto texel = [&](int x, int y) {
        const glm::vec4 known = texel_at(far_field, low.x + x, low.y + y);
        return known.a > 0 ? glm::dvec3(known) : ambient;
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), part.x), glm::mix(texel(0, 1), texel(1, 1), part.x), part.y);
}

}  // namespace

Image<glm::vec3> environment_of(const Scene& scene, const glm::dquat& y_up_from_world, Extent2D extent) {
    Image<glm::vec3> map(extent);
    const glm::dmat3 world_from_picture = glm::mat3_cast(glm::conjugate(glm::normalize(y_up_from_world)));
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const glm::dvec3 direction = world_from_picture * direction_of_place({x + 0.5, y + 0.5}, extent);
            map.at(x, y) = glm::vec3(radiance_from(scene.far_field, scene.lighting.ambient, direction));
        }
    }
    for (Light light : scene.lighting.lights) {
        if (!is_sun(light)) continue;
        light.position_m = glm::normalize(y_up_from_world) * light.position_m;
        add_to_map(light, glm::dvec3(0), map);
    }
    const auto is_dark = [](glm::vec3 radiance) { return radiance == glm::vec3(0); };
    return std::ranges::all_of(map.pixels(), is_dark) ? Image<glm::vec3>() : map;
}

}  // namespace patina
