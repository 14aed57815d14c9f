// Whether a segment reflects what is around it as a mirror does. See passes/specular/fit_mirrors.h.
#ifndef PATINA_SHARED_MIRROR_FIT_H
#define PATINA_SHARED_MIRROR_FIT_H
#include "shared/reflectance/surroundings.h"
#include "shared/specular/ward_fit.h"
INTEROP_BEGIN

INTEROP_CONST uint kMirrorGroup = 64u;
INTEROP_CONST uint kFewViews = 1u;
INTEROP_CONST float kMirrorAlpha = 0.06f;  // roughness of the mirrors that are looked for
INTEROP_CONST uint kMirrorSets = 4u;       // of rays, of a pair: 0 and 2 of its first view, 1 and 3 of its second

// Two views of one voxel that lie far apart.
struct MirrorPair {
    uint record;  // kNoRecord: none
    uint first;   // direction words; of none, kFewViews where the voxel was seen too seldom
    uint second;
    uint pad0;
    vec4 brighter;  // rgb: by how much the first is, linear
};

// Sums over pairs, by label.
struct MirrorFit {
    vec4 product;    // rgb: of the difference in colour and the difference in what the mirrored rays meet; w: of
                     // brightness
    vec4 square;     // of the latter, from two sets of rays
    float product2;  // the square of product.w, which tells its error
    float pairs;
    float color2;  // of the difference in brightness, squared
    uint pad0;
};

struct KeepMirrorsParams {
    uint labels;     // of the table of fits
    uint materials;  // entries of theirs
};

struct MirrorParams {
    VoxelGrid records;  // the observation map's grid
    uint edge_shift;    // of the observation map
    uint labels;        // of the tables
    uint materials;     // entries of the table
    uint stamp;         // the frame's index + 1
    float memory;       // the share of the earlier frames' sums that is kept
    uint pad0;
    uint pad1;
    uint pad2;
};

INTEROP_END
#endif
