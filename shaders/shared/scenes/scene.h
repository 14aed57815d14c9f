// A synthetic scene on the device, as scenes/render/scene_data.h packs it: two bounding volume hierarchies in one
// list of nodes, the shapes in their leaves, and what surfaces look like.
#ifndef PATINA_SHARED_SCENE_H
#define PATINA_SHARED_SCENE_H
#include "shared/lighting/lights.h"
INTEROP_BEGIN

INTEROP_CONST uint kBundleRays = 4u;      // rays that one invocation traces together
INTEROP_CONST uint kTexelRow = 4096u;     // element i of a list in an image is texel (i % kTexelRow, i / kTexelRow)
INTEROP_CONST uint kNodeOrders = 8u;      // bit i set: for rays that run down axis i
INTEROP_CONST uint kNodeTexels = 2u;      // of a SceneNode
INTEROP_CONST uint kPartTexels = 5u;      // of a ScenePart
INTEROP_CONST uint kTriangleTexels = 3u;  // the corners, world; w unused
INTEROP_CONST uint kLeafCountBits = 3u;   // a leaf is: how many shapes, whether parts, the first one's index
INTEROP_CONST uint kLeafIndexShift = 4u;
INTEROP_CONST uint kLeafParts = 8u;             // the bit of a leaf that holds parts, not triangles
INTEROP_CONST uint kTriangleHit = 0x80000000u;  // the bit of a hit primitive that is a triangle, not a part
INTEROP_CONST uint kNothingHit = 0xffffffffu;
INTEROP_CONST float kUnbounded = 1e10f;  // stands for infinity where products with it must stay finite

struct SceneInfo {
    uint node_count;  // in each order
    uint light_count;
    uint has_lamps;          // whether any light is a lamp, a sphere that is seen
    uint first_part_texel;   // of the image of shapes: behind the triangles
    uvec2 environment_size;  // pixels of its picture; unused without one
    uint pad1;
    uint pad2;
};

// A node of the trees, in depth-first order; boxes are axis-aligned in the world, metres.
struct SceneNode {
    vec4 low_skip;   // xyz: lowest corner; w: bits of the index to go on with when the box is missed
    vec4 high_leaf;  // xyz: highest corner; w: bits of the leaf, 0 for an inner node
};

// A convex shape: what three slabs and a quadric have in common, |x_i| <= half_size[i] and
// quadric.xz (x^2 + z^2) + quadric.y y^2 <= squared radius, in its part's frame.
struct ScenePart {
    vec4 row_x;  // rows of part_from_world, rigid, metres
    vec4 row_y;
    vec4 row_z;
    vec4 size;     // xyz: half sizes; w: squared radius; kUnbounded where the shape has no such side
    vec4 quadric;  // x: factor of x^2 + z^2, 0 or 1; y: of y^2; z: the object's index, exact; w unused
};

// What a triangle's surface looks like; corners a, b, c.
struct SceneTriangle {
    vec4 normal;    // xyz: geometric, world, unit length; w: the object's index, exact
    vec4 normal_a;  // xyz: world, unit length; w: u
    vec4 normal_b;
    vec4 normal_c;
    vec4 v;  // xyz: of a, b, c; w unused
};

// Material of an object. Its kd is a picture, which may have a single texel.
struct SceneObject {
    vec4 ks_alpha;       // rgb, roughness
    vec2 texels_per_uv;  // texel (i, j) has its centre at (i + 0.5, j + 0.5) = (u, v) * texels_per_uv
    uvec2 texture_size;  // texels; repeated beyond
    uint first_texel;
    uint id;  // what the object id image shows, above 0
    uint pad0;
    uint pad1;
};

struct SceneLight {
    PointLight light;
    vec4 emitted;  // rgb, radiance of the lamp; w unused
};

INTEROP_END
#endif
