#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/map_access.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// A view of a model whose records gathered light.
struct ReflectSurroundingsInputs {
    graph::ImageId position_m;     ///< W x H rgba32f: world; w is 0 where nothing was hit
    graph::ImageId normal;         ///< W x H rgba16f: world, unit length; 0 where it is not known
    graph::ImageId rgb;            ///< W x H rgba16f: PredictedImages::rgb, without what gloss mirrors
    graph::BufferId glossy;        ///< gpu::GlossyPixel per pixel: PredictedImages::glossy
    graph::BufferId surroundings;  ///< ReflectanceStateIds::surroundings
    graph::BufferId lights;        ///< gpu::LightHeader, gpu::PointLight[gpu::kMaxPointLights]
    glm::vec4 ball_m{0};           ///< the camera's centre in the world; beyond the radius rays meet the surroundings
    uint32_t rays = 0;             ///< of a pixel whose ks is 0.5 or more, at least 1; of others in proportion
    MapAccess access = MapAccess::kStorage;
};

/// Adds what gloss sends to the viewer of the light from all around (the part of the paper's Eq. 6 that does not come
/// from lamps): the mean over directions of the Ward lobe, importance-sampled by Walter's method, of what
/// arrives from there (lib/lighting/incident_light.glsl): the fused colour of what a ray meets, the surroundings, or
/// the far field. Where none is known, the light that records gathered. Lamps are left out, their highlights are in
/// rgb. Directions depend on the pixel alone, so that the same view gives the same picture. Returns rgb with it.
/// Throws Error when extents differ.
graph::ImageId add_reflect_surroundings(graph::FrameGraph& frame, const VoxelMap& map, const VoxelMapIds& voxels,
                                        const ReflectSurroundingsInputs& inputs);

}  // namespace patina
