#include "tools/program/lights_text.h"

#include "tools/program/standard_streams.h"

namespace patina::tools {

namespace {

void print(const Illumination& illumination, const FoundLight& found) {
    const auto& [light, evidence] = found;
    const glm::dvec3 at_m = world_position_m(illumination, light);
    print_out(
        "{:8.3f} {:8.3f} {:8.3f} m  {:8.3f} {:8.3f} {:8.3f}  radius {:.3f} m  spread {:.1f} mm  {} sightings{}{}\n",
        at_m.x, at_m.y, at_m.z, light.intensity.r, light.intensity.g, light.intensity.b, light.radius_m,
        1000 * evidence.spread_m, evidence.sightings, evidence.has_depth ? "" : ", triangulated",
        evidence.clipped > 0 ? ", clipped: the true intensity is higher" : "");
}

}  // namespace

void print_lights(const Illumination& illumination) {
    for (const FoundLight& found : illumination.lights) print(illumination, found);
    const glm::dvec3 ambient = illumination.ambient;
    if (ambient != glm::dvec3(0)) print_out("ambient {:.4f} {:.4f} {:.4f}\n", ambient.r, ambient.g, ambient.b);
    if (illumination.lights.empty()) print_out("no lamps found\n");
}

}  // namespace patina::tools
