#include "tools/program/lights_text.h"

#include <string>

#include <fmt/format.h>

#include "tools/program/standard_streams.h"

namespace patina::tools {

namespace {

/// What speaks for a lamp, for a person.
std::string words_of(const FoundLight& found) {
    const LightEvidence& evidence = found.evidence;
    if (is_sun(found.light)) return fmt::format("a sun, in {} samples of its patches", evidence.sightings);
    const char* flat = is_flat(found.light) ? ", flat" : "";
    if (evidence.unseen) return fmt::format("found in what it lights{}", flat);
    std::string words = fmt::format("radius {:.3f} m  spread {:.1f} mm  {} sightings", found.light.radius_m,
                                    1000 * evidence.spread_m, evidence.sightings);
    words += flat;
    if (!evidence.has_depth) words += ", triangulated";
    if (evidence.shown != glm::dvec3(0)) {
        words += ", clipped: as bright as what it lights tells";
    } else if (evidence.clipped > 0) {
        words += ", clipped: the true intensity is higher";
    }
    return words;
}

void print(const Illumination& illumination, const FoundLight& found) {
    const glm::dvec3 at_m = world_position_m(illumination, found.light), intensity = found.light.intensity;
    print_out("{:8.3f} {:8.3f} {:8.3f} m  {:8.3f} {:8.3f} {:8.3f}  {}\n", at_m.x, at_m.y, at_m.z, intensity.r,
              intensity.g, intensity.b, words_of(found));
}

}  // namespace

void print_lights(const Illumination& illumination) {
    for (const FoundLight& found : illumination.lights) print(illumination, found);
    const glm::dvec3 ambient = illumination.ambient;
    if (ambient != glm::dvec3(0)) print_out("ambient {:.4f} {:.4f} {:.4f}\n", ambient.r, ambient.g, ambient.b);
    if (illumination.lights.empty()) print_out("no lamps found\n");
}

}  // namespace patina::tools
