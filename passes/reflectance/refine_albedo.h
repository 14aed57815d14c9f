#pragma once

#include "passes/reflectance/reflectance_frame.h"

namespace patina {

/// Computes the diffuse albedo of the listed records from all their observations, given lights, visibility, ambient
/// light, and ks and alpha of their segment (paper, Eq. 7): the robust mean of B_k - S_k over the irradiance. Clipped
/// channels count only where there is nothing else; highlights, grazing views and outliers count less. The map's albedo
/// becomes kd (lib/records/reflectance.glsl: shared exponent) and three certainties in [0, 1], 0 where a channel
/// receives too little light to know.
void add_refine_albedo(graph::FrameGraph& frame, ReflectanceFrame& reflectance, const RecordList& refine);

}  // namespace patina
