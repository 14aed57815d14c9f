#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "patina/lighting.h"
#include "tools/report/drawing.h"
#include "tools/report/run_summary.h"

namespace patina {

/// A sphere of a material under lamps, as seen by an eye on the z axis: Ward's model (paper, Eq. 2 to 6), no shadows.
/// `lights` are relative to the sphere, whose radius is small beside their distance, y up. The exposure makes a white
/// diffuse surface that faces the strongest light 0.8. Without light it is lit from the front. It fills a square; what
/// is beside it has the colour at its rim.
Drawing swatch(const SegmentReflectance& material, const Lighting& lights, uint32_t size_px);

/// Swatches of the largest segments whose albedo is known, with their names and what is known of their gloss, as
/// markup. `center_m`: where the spheres are among the lamps, in the lamps' coordinates. Empty without segments.
std::string swatch_grid(std::span<const SegmentSummary> segments, const Lighting& lights, glm::dvec3 center_m);

/// The CSS of swatches, for report_page().
std::string_view swatch_style();

}  // namespace patina
