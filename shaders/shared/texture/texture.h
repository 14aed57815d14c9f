// A surface in the page of a texture, and what pictures say of its texels.
#ifndef PATINA_SHARED_TEXTURE_H
#define PATINA_SHARED_TEXTURE_H
#include "shared/fusion/voxel_map.h"
#include "shared/input/camera.h"
INTEROP_BEGIN

INTEROP_CONST uint kTextureTile = 16u;        // texels along the side of a tile, and invocations along that of a group
INTEROP_CONST uint kGutterTexels = 3u;        // around a triangle, that show its border
INTEROP_CONST uint kNoSurface = 0x80008000u;  // SurfaceTexel::normal where no surface lies; no normal is packed to that

INTEROP_CONST float kLeastShownLight = 0.02f;  // irradiance over pi below which a colour says little of the albedo

INTEROP_CONST uint kBalanceTaps = 4u;   // on each side of a block, along each axis
INTEROP_CONST uint kTextureBlock = 8u;  // texels along the side of a block, whose mean is balanced

// A vertex of the surface.
struct TextureVertex {
    vec4 position_m;  // world; w: its column in the page, texels; 0.5 is the middle of the first
    vec4 kd;          // what records know; w: its row in the page
    vec4 normal;      // world, of any length; w unused
};

// The triangles that may touch a tile, in the list of all tiles.
struct TextureTile {
    uint first;
    uint count;
};

// The surface at a texel.
struct SurfaceTexel {
    uint x;  // world, metres: bits of a float
    uint y;
    uint z;
    uint normal;  // world: packSnorm2x16 of to_octahedral, or kNoSurface
};

struct PlaceTexelsParams {
    uvec2 extent;    // of the band, texels
    uint first_row;  // of the page
    uint tiles_x;    // tiles along a row
};

struct DetailNormalsParams {
    VoxelGrid grid;
    uvec2 extent;  // of the page, texels
    uint tiles_x;  // tiles along a row
    uint pad0;
};

struct DiffusePictureParams {
    vec4 gain;      // rgb: of the picture over the first one's; w unused
    float voxel_m;  // of the surface
    uint pad0;
    uint pad1;
    uint pad2;
};

struct BlendPictureParams {
    Camera camera;      // the colour camera, of the pictures' extent
    vec4 gain_voxel_m;  // rgb: gain of the picture over the first one's; w: edge of a voxel of the surface
    uint texels;        // of the band
    uint pad0;
    uint pad1;
    uint pad2;
};

struct BlendDiffuseParams {
    Camera camera;  // the colour camera, of the picture's extent
    float eye_x_m;  // world: who looks at the texels
    float eye_y_m;
    float eye_z_m;
    float voxel_m;  // of the surface
    uint texels;    // of the band
    uint pad0;
    uint pad1;
    uint pad2;
};

// What the texels of a block that a picture shows have in common.
struct TextureBlock {
    vec4 position_m;  // world, their mean; w: how many there are
    vec4 seen;        // rgb: mean albedo by pictures; w unused
    vec4 squares;     // rgb: mean of its squares; w unused
    vec4 known;       // rgb: mean albedo by records; w unused
};

struct AverageTexelsParams {
    uvec2 extent;    // of the band, texels
    uint first_row;  // of the band in the page, a multiple of kTextureBlock
    uint blocks_x;   // blocks along a row of the page
};

struct BalanceBlocksParams {
    uvec2 blocks;   // of the page
    uint stride;    // blocks from one tap to the next
    float reach_m;  // of the taps: what is farther away is another surface
    float most_factor;
    uint pad0;
    uint pad1;
    uint pad2;
};

struct FinishTexelsParams {
    uvec2 extent;    // of the band, texels
    uint first_row;  // of the page
    uint blocks_x;   // blocks along a row of the page
    uint blocks_y;
    float reach_m;  // a block whose mean is farther from a texel is of another surface
    uint pad0;
    uint pad1;
};

struct ViewTexelsParams {
    uvec2 blocks;   // of the view
    float reach_m;  // a block whose mean is farther from a texel is of another surface
    uint pad0;
};

INTEROP_END
#endif
