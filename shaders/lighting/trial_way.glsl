// Whether the model leaves the way from a sample to a trial light open. The includer declares the map as
// lib/map/march_map.glsl says, and sets `grid`.
#include "lib/map/march_map.glsl"

const float kLiftVox = 4.0;          // above the surface, where the way begins
const float kMostSkippedVox = 16.0;  // of the way, to get there

// Along a direction that leaves the surface with this cosine, as far as `reach` (voxels).
bool is_open(LightSample lit, vec3 direction, float cosine, float reach) {
    const float skipped = min(kLiftVox / cosine, kMostSkippedVox);
    const float lift = max(kLiftVox - skipped * cosine, 0.0);
    const vec3 start = lit.point_m.xyz / grid.voxel_m + lift * lit.normal.xyz;
    return march(start, direction, skipped, reach, cosine, lift, kInsideVox).open;
}
