// Body of the passes that look for records whose visibility or albedo is out of date, and list them, each once. The
// includer defines list_for_marching.
#include "lib/records/record_list.glsl"
#include "lib/records/reflectance.glsl"

layout(std140, binding = 0) uniform Lights {
    LightHeader header;
    PointLight lights[kMaxPointLights];
};
layout(std430, binding = 1) readonly buffer Materials { SegmentMaterial materials[]; };
layout(std430, binding = 2) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 3) buffer Status { RecordStatus status[]; };
layout(std430, binding = 4) buffer March { uint march[]; };
layout(std430, binding = 5) buffer MarchArguments { uint march_arguments[]; };
layout(std430, binding = 6) buffer Refine { uint refine[]; };
layout(std430, binding = 7) buffer RefineArguments { uint refine_arguments[]; };
layout(push_constant) uniform Push { ReflectanceParams params; };

// `marched`: its lights were marched at their present positions, but not since it changed.
void list_for_marching(uint record, bool marched);

// `observed`: its observations, surface or label changed. `refresh`: what is around it may have.
void consider(uint record, bool observed, bool refresh) {
    const VoxelRecord known = records[record];
    if (observation_count(known) == 0u) return;
    const uint marched = status[record].marched;
    // Farther from the camera, what may throw a shadow is not known.
    const vec3 point_m = surface_point_m(known, params.records, params.edge_shift);
    const bool marchable = distance(point_m, params.ball_m.xyz) < params.ball_m.w;
    const bool march_again = marchable && (refresh || !is_marched_from(marched, known, header.position_version));
    if (march_again && atomicExchange(status[record].march_stamp, params.stamp) != params.stamp) {
        list_for_marching(record, is_marched(marched, header.position_version));
    }
    const uint label = record_label(known);
    const uint version = label != 0u && label < params.materials ? materials[label].version : 0u;
    const bool refine_again = observed || status[record].refined != refined_word(header.version, version);
    if (refine_again && atomicExchange(status[record].refine_stamp, params.stamp) != params.stamp) {
        APPEND_RECORD(refine, refine_arguments, record)
    }
}
