#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/map_access.h"
#include "passes/state/observation_map.h"
#include "passes/state/reflectance_state.h"
#include "passes/state/segment_materials.h"
#include "passes/state/voxel_map.h"
#include "shared/lighting/lights.h"

namespace patina {

/// The surface as one camera sees it, and where to look for its records.
struct PredictRadianceInputs {
    graph::ImageId position_m;  ///< W x H rgba32f: world; w is 0 where nothing was hit
    graph::ImageId normal;      ///< W x H rgba16f: world, unit length; 0 where it is not known
    graph::BufferId view;       ///< gpu::ViewParams of the camera
    graph::BufferId view_grid;  ///< u32 per block of the box around the view: block id of the voxel map, or kNoBlock
    graph::BufferId lights;     ///< gpu::LightHeader, gpu::PointLight[gpu::kMaxPointLights]
    graph::BufferId materials;  ///< gpu::SegmentMaterial[material_count]
    graph::BufferId segments;   ///< gpu::SegmentAlbedo[material_count] (add_average_segments)
    uint32_t material_count = 0;
    uint32_t most_lights = gpu::kMaxPointLights;  ///< no fewer than `lights` has; few take a faster shader
    bool shadows = true;                          ///< false: every light reaches every surface, as in the paper
    MapAccess access = MapAccess::kStorage;
    bool gathers = false;  ///< records gathered light from all around (reflectance/gather_irradiance.h), which arrives
    /// kd is the one that rgb is made with, so that kd x light and the highlight are rgb. It may be above 1, and
    /// RecordSurroundings::around does not count.
    bool of_picture = false;
    /// rgb lacks what gloss mirrors of the light that records gathered; add_reflect_surroundings() adds it.
    bool gloss_apart = false;
    /// The lights are others than those that records were observed under. So their errors do not cancel out against
    /// those of kd, and rgb is made with kd as it is.
    bool other_light = false;
};

/// The records, with those that a view can show by voxel.
struct PackedRecords {
    graph::BufferId entries;  ///< u32 per observation voxel of each block of the voxel map: record id, or kNoRecord
    graph::BufferId content;  ///< uvec4 per record: lib/records/packed_records.glsl
};

/// What the model looks like. All zero where nothing was hit.
struct PredictedImages {
    graph::ImageId kd;  ///< W x H rgba16f: diffuse albedo; a is 1 where it is known, else all is 0
    /// W x H rgba16f: the one that rgb is made with, as `kd`; it may be above 1. Where records gathered light that they
    /// were observed under, what they reflect over that, so that errors of the light cancel out; else `kd`.
    graph::ImageId picture_kd;
    graph::ImageId label;  ///< W x H r32ui: segment, 0 where none is known
    graph::ImageId
        ks_alpha;        ///< W x H rgba16f: specular albedo and Ward roughness of the segment; 0 without a material
    graph::ImageId rgb;  ///< W x H rgba16f: linear pixel value; a is 1 where kd is known, else all is 0
    /// W x H rgba16f: what picture_kd multiplies in rgb, the irradiance over pi with shadows and ambient term; a: the
    /// part of the lamps' light that shadows leave, 0 on surfaces that face none, gpu::kNotMarched where no record
    /// around knows it; also where kd is not known.
    graph::ImageId light;
    PackedRecords packed{};  ///< what it was made from
    graph::BufferId glossy;  ///< gpu::GlossyPixel per pixel, where gloss is apart; else without meaning
};

/// Reflectance and radiance of each surface point (paper, Eq. 6 with Ward's Eq. 2-4, and an ambient term). Kd is the
/// trilinear mean of the eight records around the point (Section 3.7), each weighted by its certainty and by how much
/// its surface is the point's: normals agree, its tangent plane passes by. Where none of them is known, the nearest
/// known one within a voxel more counts, of the same surface if there is one. Where records are not
/// sure of it, the albedo of the surface around them counts by inverse variances (kSurfaceDeviation), or the mean of
/// the segment (kTextureDeviation), which is all there is where no record knows. How much of a light reaches the point
/// is interpolated likewise; all of it, where none was marched yet. The segment is that of the nearest record with a
/// label. Throws Error when the images differ in extent.
PredictedImages add_predict_radiance(graph::FrameGraph& frame, const VoxelMap& voxel_map, const VoxelMapIds& voxels,
                                     const ObservationMap& map, const ObservationMapIds& records,
                                     const ReflectanceStateIds& state, const PredictRadianceInputs& inputs);

}  // namespace patina
