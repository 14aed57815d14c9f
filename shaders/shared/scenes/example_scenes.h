// Small scenes of one labelled segment each, from which training examples are made: the voxels of a segment, the light
// that reaches them, and where a camera looks from. See scenes/description/example_scene.h.
#ifndef PATINA_SHARED_EXAMPLE_SCENES_H
#define PATINA_SHARED_EXAMPLE_SCENES_H
#include "shared/lighting/lights.h"
#include "shared/specular/hemi_images.h"
#include "shared/specular/specular_estimates.h"
INTEROP_BEGIN

INTEROP_CONST uint kExampleVoxels = 32u;  // per scene
INTEROP_CONST uint kExampleViews = 64u;
INTEROP_CONST uint kExampleLamps = 8u;
INTEROP_CONST uint kExampleWindows = 8u;
INTEROP_CONST uint kExampleMaterials = 4u;  // the segment's own, then those of things around it

INTEROP_CONST uint kExposeViews = 8u;        // looked at per voxel, to choose a scene's exposure
INTEROP_CONST uint kExposeSamples = 256u;    // kExampleVoxels * kExposeViews
INTEROP_CONST uint kIrradianceRays = 96u;    // from afar, per voxel
INTEROP_CONST uint kReflectedRays = 24u;     // from afar, per reading, where there are windows
INTEROP_CONST uint kReflectedRaysSky = 8u;   // where there are none: nothing but the gradient of the sky
INTEROP_CONST uint kExampleHalves = 16876u;  // of a packed set of images: kHemiSamples * kHemiPixels * 3, made even
INTEROP_CONST uint kExampleGroup = 64u;

// World coordinates; y points down. Radiance times exposure is a linear pixel value.
struct ExampleScene {
    vec4 sky;     // rgb radiance from straight above; w: the 95 % quantile of pixel values
    vec4 ground;  // and from below; w: share of the views in which a voxel is hidden
    uint lamps;
    uint windows;
    uint views;
    float read;  // noise: variance = read^2 + shot * value
    float shot;
    uint pad0;
    uint pad1;
    uint pad2;
};

// A soft-edged disk on the sphere of directions.
struct ExampleWindow {
    vec4 direction;  // to its middle; w: the cosine where it ends
    vec4 radiance;   // rgb; w: the cosine up to which it is as bright as in the middle
};

struct ExampleVoxel {
    vec4 point_m;        // w: factor of kd
    vec4 normal;         // the surface's
    vec4 stored_normal;  // as the map knows it
    uint material;       // of its scene
    uint shadow;         // a bit per lamp that does not reach it
    uint pad0;
    uint pad1;
};

// What one view shows of a voxel.
struct ExampleReading {
    vec4 to_viewer;  // unit length; w: 1 where the voxel is seen, else 0
    vec4 rgb;        // linear, as 8 bits of sRGB hold it; w: clipped channels, a bit each
};

struct ExampleParams {
    uvec2 seed;
    uint first;        // number of the batch's first scene among all of the seed
    uint scenes;       // of the batch
    float min_cosine;  // between the normal and the direction to the camera
    uint pad0;
    uint pad1;
    uint pad2;
};

struct InsertExamplesParams {
    uint scenes;
    uint view;
    uint chunk_shift;  // of records
    float merge_distance2;
};

INTEROP_END
#endif
