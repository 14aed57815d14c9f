#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// One invocation per record in view: looks up the voxel's surface in the cast model, then in the depth and the colour
// image, and adds what the colour camera sees of it to the voxel's observations (paper, Section 3.4). An invocation
// writes its own record only, so that nothing depends on their order.
#include "lib/camera/camera.glsl"
#include "lib/map/slope.glsl"
#include "lib/map/voxel_map.glsl"
#include "lib/records/observations.glsl"
#include "lib/records/record_list.glsl"
#include "shared/fusion/integrate.h"

layout(local_size_x = kRecordGroup) in;
layout(std140, binding = 0) uniform Observation { ObservationParams frame; };
layout(binding = 1, rgba32f) uniform readonly image2D position_m;
layout(binding = 2, rgba16f) uniform readonly image2D normal;
layout(binding = 3, r32f) uniform readonly image2D depth_m;
layout(binding = 4, r32ui) uniform readonly uimage2D slope;
layout(binding = 5, rgba16f) uniform readonly image2D color_linear;
layout(binding = 6, r32ui) uniform readonly uimage2D labels;
layout(std430, binding = 7) readonly buffer Visible { uint visible[]; };
layout(std430, binding = 8) buffer Records { VoxelRecord records[]; };
layout(std430, binding = 9) buffer Changed { uint changed[]; };
layout(std430, binding = 10) buffer ChangedList { uint changed_list[]; };
layout(std430, binding = 11) buffer Stale { uint stale[]; };
layout(std430, binding = 12) buffer Arguments { uvec4 arguments[]; };  // of dispatches over the changed, the stale
layout(std430, binding = 13) buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 18) buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(constant_id = 1) const bool kColorApart = false;  // the colour camera is not where the depth camera is
#include "observation/insert_observation.glsl"

const int kSightSteps = 16;
const float kNearestOccluder = 0.3;  // metres

struct Surface {
    vec3 normal;
    float offset_vox;  // along the normal, from the voxel's centre
    uint samples;      // 0: not known
};

vec2 pixel_of(Camera camera, vec3 in_camera_m) {
    return in_camera_m.z > kNearestDepth ? project(camera, in_camera_m) : vec2(-1e6);
}

// The mean plane of the cast model around `guess_m`, over about the voxel's own size, of one face: that of `known`, or
// where it shows none, of the point seen nearest to the guess. `samples` is 1, or 0 where the camera does not see the
// model near the guess.
Surface seen_surface(vec3 guess_m, vec3 center_m, Surface known) {
    const float voxel_m = frame.grid.voxel_m;
    const vec3 in_camera = to_camera(frame.depth_camera, guess_m);
    const ivec2 pixel = ivec2(floor(pixel_of(frame.depth_camera, in_camera) + 0.5));
    const float pixel_m = in_camera.z / frame.depth_camera.focal_center_px.x;
    const int spread = max(int(voxel_m / (3.0 * max(pixel_m, 1e-6)) + 0.5), 1);
    const float reach_m = 1.25 * voxel_m + pixel_m;
    const ivec2 taps[5] = ivec2[](ivec2(0), ivec2(-1, -1), ivec2(1, -1), ivec2(-1, 1), ivec2(1, 1));
    vec3 normals[5];
    vec3 points[5];
    vec3 face = vec3(0.0);
    float agreement = known.samples > 0u ? kSameFaceCosine : 2.0;  // of a tap with the known normal: the best so far
    [[unroll]] for (int i = 0; i < 5; ++i) {
        const vec4 point = imageLoad(position_m, pixel + spread * taps[i]);
        const vec3 n = imageLoad(normal, pixel + spread * taps[i]).xyz;
        const vec3 apart = point.xyz - guess_m;
        const bool near = point.w > 0.0 && dot(n, n) > 0.5 && dot(apart, apart) <= reach_m * reach_m;
        normals[i] = near ? n : vec3(0.0);
        points[i] = point.xyz - center_m;
        const float agrees = dot(normals[i], known.normal);
        face = face == vec3(0.0) || agrees > agreement ? normals[i] : face;
        agreement = max(agreement, agrees);
    }
    vec3 sum = vec3(0.0);
    vec4 place = vec4(0.0);
    [[unroll]] for (int i = 0; i < 5; ++i) {
        const bool same = dot(normals[i], face) > kSameFaceCosine;
        sum += same ? normals[i] : vec3(0.0);
        place += same ? vec4(points[i], 1.0) : vec4(0.0);
    }
    const vec3 mean = sum / max(length(sum), 1e-6);
    const float offset_vox = dot(mean, place.xyz) / (max(place.w, 1.0) * voxel_m);
    return Surface(mean, offset_vox, place.w > 0.0 && abs(offset_vox) <= 1.0 ? 1u : 0u);
}

// A running mean; once it is one over many frames, only what contradicts it moves it, so that a resting camera changes
// nothing. Another face than the known one takes samples from it, and its place when none are left.
Surface updated(Surface known, Surface seen) {
    if (seen.samples == 0u) return known;
    if (known.samples == 0u) return seen;
    if (dot(known.normal, seen.normal) < kSameFaceCosine) {
        return known.samples == 1u ? seen : Surface(known.normal, known.offset_vox, known.samples - 1u);
    }
    const bool settled = known.samples == kMostSurfaceSamples &&
                         dot(known.normal, seen.normal) > 0.9986 &&  // 3 degrees
                         abs(known.offset_vox - seen.offset_vox) < 0.1;
    if (settled) return known;
    const float share = 1.0 / float(min(known.samples + 1u, kMostSurfaceSamples));
    return Surface(normalize(mix(known.normal, seen.normal, share)), mix(known.offset_vox, seen.offset_vox, share),
                   min(known.samples + 1u, kMostSurfaceSamples));
}

// By more than rounding and the model's last settling do: a resting camera changes nothing. What stays below adds up to
// 1.6 degrees over all samples.
bool has_moved(Surface now, Surface before) {
    return now.samples != 0u && (before.samples == 0u || distance(now.normal, before.normal) > 0.0017 ||
                                 abs(now.offset_vox - before.offset_vox) > 0.005);
}

struct Reading {
    bool shown;  // the depth image shows the point
    bool even;   // and no edge nearby, and of the face that is known
};

Reading read_depth(vec3 in_camera, vec2 pixel, vec3 facing) {
    const vec2 nearest = floor(pixel + 0.5);
    const float reading = imageLoad(depth_m, ivec2(nearest)).x;
    const uint inclination = imageLoad(slope, ivec2(nearest)).x;
    const vec2 depth_per_px = slope_depth_per_px(inclination);
    const float off_m = (reading + dot(depth_per_px, pixel - nearest) - in_camera.z) * slope_plane_factor(inclination);
    const float tolerance_m = frame.depth_tolerance_m + frame.depth_tolerance_per_m2 * in_camera.z * in_camera.z;
    const float jump_m = frame.jump_m + frame.jump_slope * reading;
    bool even = true;
    [[unroll]] for (int i = 0; i < 9; ++i) {
        const vec2 offset = vec2(i % 3 - 1, i / 3 - 1) * float(frame.edge_margin_px);
        const float there = imageLoad(depth_m, ivec2(nearest + offset)).x;
        even = even && there > 0.0 && abs(there - reading - dot(depth_per_px, offset)) <= jump_m;
    }
    const bool shown = reading > 0.0 && inclination != 0u && abs(off_m) <= tolerance_m;
    const vec3 shown_normal = imageLoad(normal, ivec2(nearest)).xyz;
    const bool same_face = shown_normal == vec3(0.0) || dot(shown_normal, facing) > kSameFaceCosine;
    return Reading(shown, shown && even && same_face);
}

// The colour camera sees the point too: from there to it, nothing that the depth image shows is in between. What the
// depth image hides counts as in between. Steps are even in disparity, at a Kinect's resolution 3 pixels wide.
bool color_sees(vec3 in_camera) {
    if (!kColorApart) return true;
    const vec3 center = to_camera(frame.depth_camera, camera_center_m(frame.color_camera));
    bool free = true;
    [[unroll]] for (int i = 1; i <= kSightSteps; ++i) {
        const float z = 1.0 / mix(1.0 / in_camera.z, 1.0 / kNearestOccluder, float(i) * (1.0 / float(kSightSteps)));
        const float share = (in_camera.z - z) / max(in_camera.z - center.z, 1e-3);
        const vec3 at = mix(in_camera, center, share);
        const float reading = imageLoad(depth_m, ivec2(floor(pixel_of(frame.depth_camera, at) + 0.5))).x;
        const float tolerance_m = frame.jump_m + frame.jump_slope * z;
        free = free && (reading <= 0.0 || reading >= at.z - tolerance_m || share <= 0.0 || share >= 1.0);
    }
    return free;
}

// The picture was not smeared at the point by more than observations may be.
bool is_sharp(vec3 point_m, vec2 pixel) {
    const vec2 before = pixel_of(frame.color_camera, (frame.color_before_from_world * vec4(point_m, 1.0)).xyz);
    return frame.shutter_share * distance(pixel, before) <= frame.max_blur_px;
}

// Linear colour, bilinear; `clipped` says which channels are in one of the four pixels. False where one has no reading.
bool sample_color(vec2 pixel, out vec3 rgb, out bvec3 clipped) {
    const vec2 low = floor(pixel);
    const vec2 t = pixel - low;
    vec4 sum = vec4(0.0);
    bvec3 any_clipped = bvec3(false);
    bool valid = true;
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const ivec2 corner = ivec2(i & 1, i >> 1);
        const vec4 seen = imageLoad(color_linear, ivec2(low) + corner);
        const vec2 share = mix(1.0 - t, t, vec2(corner));
        sum += seen * (share.x * share.y);
        valid = valid && seen.a > 0.0;
        any_clipped =
            bvec3(uvec3(any_clipped) | (uvec3(greaterThanEqual(seen.rgb, vec3(1.0))) & uvec3(seen.a < 1.0 ? 1u : 0u)));
    }
    rgb = sum.rgb;
    clipped = any_clipped;
    return valid;
}

// A vote of the label image: agreement strengthens a label, contradiction weakens and in the end replaces it.
uint voted_label(uint known, uint seen) {
    const uint label = known & 0xffffu;
    const uint confidence = known >> 16;
    if (seen == 0u) return known;
    if (seen == label) return label | min(confidence + 1u, kMostConfidence) << 16;
    return confidence > 1u ? label | (confidence - 1u) << 16 : seen | 1u << 16;
}

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= visible[0]) return;
    const uint record = visible[1u + item];
    VoxelRecord known = records[record];
    const ivec3 block = block_of_key(frame.grid, known.block_key);
    const uint voxel = voxel_in_block(known);
    const vec3 center_m = (vec3(voxel_of_record(block, voxel, frame.edge_shift)) + 0.5) * frame.grid.voxel_m;

    const Surface before = Surface(surface_normal(known), surface_offset_vox(known), surface_samples(known));
    const vec3 guess_m =
        center_m + (before.samples > 0u ? before.normal * (before.offset_vox * frame.grid.voxel_m) : vec3(0.0));
    const Surface surface = updated(before, seen_surface(guess_m, center_m, before));
    const vec3 point_m = center_m + surface.normal * (surface.offset_vox * frame.grid.voxel_m);

    const vec3 in_depth = to_camera(frame.depth_camera, point_m);
    const vec2 depth_px = pixel_of(frame.depth_camera, in_depth);
    const vec3 in_color = to_camera(frame.color_camera, point_m);
    const vec3 toward = camera_center_m(frame.color_camera) - point_m;
    const float distance_m = length(toward);
    const Reading reading = read_depth(in_depth, depth_px, surface.normal);
    const bool faces = surface.samples > 0u && distance_m <= frame.max_distance_m &&
                       dot(surface.normal, toward) >= frame.min_cosine * distance_m;
    vec3 rgb;
    bvec3 clipped;
    const vec2 color_px = pixel_of(frame.color_camera, in_color);
    uint count = observation_count(known);
    const bool serves = count < frame.smeared_observations || is_sharp(point_m, color_px);
    const bool colored = serves && sample_color(color_px, rgb, clipped);

    const uint old_label = record_label(known);
    const bool moved = surface != before;
    bool has_changed = has_moved(surface, before);
    if (faces && reading.even && colored && color_sees(in_depth)) {
        const Insertion insertion = insert_observation(frame.grid.chunk_shift, record, count, toward / distance_m, rgb,
                                                       clipped, frame.merge_distance2);
        if (insertion.lost_closest) APPEND_RECORD(stale, arguments[1], record)
        count = insertion.count;
        has_changed = has_changed || insertion.changed;
    }
    // A label goes with the reading, edge or not: what is seen beside edges alone can still be its segment's.
    if (faces && reading.shown)
        known.label = voted_label(known.label, imageLoad(labels, ivec2(floor(depth_px + 0.5))).x);
    // What has not moved keeps its bits: packing what was unpacked could round to others.
    if (moved) known.normal = pack_normal(surface.normal);
    known.state = pack_state(count, voxel, surface.samples, surface.offset_vox);
    records[record] = known;
    if (count > 0u && (has_changed || record_label(known) != old_label)) {
        changed[record] = frame.stamp;
        APPEND_RECORD(changed_list, arguments[0], record)
    }
}
