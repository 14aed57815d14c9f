// Reflectance observations: a hash of blocks of 2^3 or 4^3 voxels, and a pool of records, one per observed voxel. See
// passes/state/observation_map.h.
#ifndef PATINA_SHARED_OBSERVATIONS_H
#define PATINA_SHARED_OBSERVATIONS_H
#include "shared/fusion/voxel_map.h"
#include "shared/input/camera.h"
INTEROP_BEGIN

INTEROP_CONST uint kMaxObservations = 30u;  // of one voxel: m of the paper, Section 3.4
INTEROP_CONST uint kRecordQuads = 8u;       // uvec4 of directions, and of colours, per record
INTEROP_CONST uint kClosestDistance = 30u;  // the word behind the directions: squared distance of the closest pair
INTEROP_CONST uint kClosestPair = 31u;      // and the next: the pair's indices, lower | higher << 8

// What an entry of the record table holds beside record ids.
INTEROP_CONST uint kNoRecord = 0xffffffffu;       // never observed
INTEROP_CONST uint kRefusedRecord = 0xfffffffeu;  // the pool was full when it was first observed
INTEROP_CONST uint kNewRecord = 0xfffffffdu;      // gets one, or is refused, in this frame

INTEROP_CONST uint kMostSamples = 8u;           // averaged into one observation
INTEROP_CONST uint kMostSurfaceSamples = 16u;   // after which a voxel's surface is a sliding average
INTEROP_CONST uint kMostConfidence = 255u;      // of a label
INTEROP_CONST float kDirectionSteps = 2048.0f;  // directions are compared on a grid of this many steps to the unit

INTEROP_CONST uint kObservationGroupX = 32u;  // of passes over pixels
INTEROP_CONST uint kObservationGroupY = 4u;
INTEROP_CONST uint kRecordGroup = 64u;  // of passes over records
INTEROP_CONST uint kTableGroup = 16u;   // of the pass that clears blocks: four voxels each

// One observed voxel; its observations lie in arrays of their own. Packed by lib/records/observations.glsl.
struct VoxelRecord {
    uint block_key;  // where it is: with the voxel's number in `state`
    uint normal;     // octahedral, snorm 16 + 16
    uint state;      // observations 5 bits | voxel within its block 6 | surface samples 5 | offset snorm 16
    uint label;      // label 16 bits, 0: none | confidence 8
};

// What one frame's collection knows; a uniform buffer shared by its passes.
struct ObservationParams {
    VoxelGrid grid;  // voxel_m: of the observations' voxels; capacity: blocks; chunk_shift: of records
    Camera depth_camera;
    Camera color_camera;
    mat4 color_before_from_world;  // the colour camera at the frame before
    uvec2 visited;                 // how many pixels in x and y are looked at: every stride_px-th
    uint stride_px;
    uint phase;       // which of the stride^2 pixels, changes from frame to frame
    uint edge_shift;  // a block has 1 << edge_shift voxels along each edge
    uint record_capacity;
    uint max_table_keys;      // beyond it nothing is inserted
    uint stamp;               // the frame's index + 1
    float max_distance_m;     // farther surface is not observed
    float min_cosine;         // between the normal and the direction to the colour camera
    float depth_tolerance_m;  // of the distance between reading and surface: + depth_tolerance_per_m2 * depth^2
    float depth_tolerance_per_m2;
    float merge_distance2;  // directions this near are the same observation
    uint edge_margin_px;    // readings this near to an edge of the depth image are not used
    float jump_m;           // an edge: depth off the reading's plane by jump_m + jump_slope * depth
    float jump_slope;
    float shutter_share;        // of the time since the frame before, that the colour camera's shutter was open
    float max_blur_px;          // what moved farther over the picture meanwhile is not observed
    uint smeared_observations;  // unless the voxel has fewer observations than this
    uint pad0;
};

INTEROP_END
#endif
