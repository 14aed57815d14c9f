#include "passes/lighting/find_lights.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/core/error.h"
#include "spirv/shaders.h"

namespace patina {
namespace {

constexpr float kDepthUnitsPerMetre = 1e5f;  // 32 bits hold 42 km in steps of 10 micrometres

float chord_of(float angle_rad) { return 2 * std::sin(angle_rad / 2); }

gpu::FindLightsParams params_of(const FindLightsInputs& in, const FindLightsSettings& settings) {
    gpu::FindLightsParams params{};
    params.camera = in.color_camera;
    params.threshold = settings.threshold;
    params.radiance_scale = in.radiance_scale;
    params.bandwidth_m = settings.bandwidth_m;
    params.bandwidth_chord = chord_of(settings.bandwidth_rad);
    params.match_m = settings.match_m;
    params.match_rad = settings.match_rad;
    const uint32_t pixels = in.color_camera.extent.x * in.color_camera.extent.y;
    params.group_count = (pixels + gpu::kEmitterGroup - 1) / gpu::kEmitterGroup;
    return params;
}

/// Half the colour pixels, in each direction, that a depth pixel covers beyond the one it falls into.
uint32_t reach_px(const FindLightsInputs& in) {
    const glm::vec4 color = in.color_camera.focal_center_px, depth = in.depth_camera.focal_center_px;
    const float ratio = std::max(color.x / depth.x, color.y / depth.y);
    return static_cast<uint32_t>(std::ceil(std::max(ratio - 1, 0.0f) / 2));
}

/// The depth camera's readings as the colour camera would have them; u32 per colour pixel, kNoDepth where none is.
graph::BufferId add_warp_depth(graph::FrameGraph& frame, const FindLightsInputs& in, graph::BufferId params,
                               const gpu::WarpDepthParams& warp) {
    const uint64_t pixels = uint64_t{in.color_camera.extent.x} * in.color_camera.extent.y;
    const graph::BufferId empty =
        frame.fill(frame.create_buffer("lighting.warped_depth", pixels * sizeof(uint32_t)), gpu::kNoDepth);
    auto pass = frame.compute("lighting.warp_depth", spirv::warp_depth);
    pass.read("depth_m", in.depth_m).read("Params", params);
    const graph::BufferId warped = pass.modify("Warped", empty);
    pass.push(warp);
    pass.dispatch_covering(Extent2D{in.depth_camera.extent.x, in.depth_camera.extent.y});
    return warped;
}

/// The shining pixels in the picture's order, and where each group's begin; the last place is their count.
struct EmitterList {
    graph::BufferId emitters;
    graph::BufferId places;
};

EmitterList add_list_emitters(graph::FrameGraph& frame, const FindLightsInputs& in, graph::BufferId params,
                              graph::BufferId warped, const gpu::WarpDepthParams& warp, uint32_t groups) {
    auto count = frame.compute("lighting.count_emitters", spirv::count_emitters);
    count.read("color", in.color).read("Params", params);
    const graph::BufferId counts = count.create("Counts", groups * sizeof(uint32_t));
    count.dispatch(groups);

    EmitterList list;
    auto place = frame.compute("lighting.place_emitters", spirv::place_emitters);
    place.read("Params", params).read("Counts", counts);
    list.places = place.create("Places", (groups + 1) * sizeof(uint32_t));
    place.dispatch(1);

    auto pass = frame.compute("lighting.list_emitters", spirv::list_emitters);
    pass.read("color", in.color).read("Params", params).read("Warped", warped).read("Places", list.places);
    list.emitters = pass.create("Emitters", gpu::kMaxEmitters * sizeof(gpu::Emitter));
    pass.push(warp);
    pass.dispatch(groups);
    return list;
}

/// The frame's clusters: gpu::EmitterMode[kMaxLightCandidates], heaviest first.
graph::BufferId add_cluster_emitters(graph::FrameGraph& frame, graph::BufferId params, const EmitterList& list) {
    auto shift = frame.compute("lighting.shift_means", spirv::shift_means);
    shift.read("Params", params).read("Places", list.places).read("Emitters", list.emitters);
    const graph::BufferId modes = shift.create("Modes", gpu::kMeanShiftSeeds * sizeof(gpu::EmitterMode));
    shift.dispatch(gpu::kMeanShiftSeeds);

    auto merge = frame.compute("lighting.merge_modes", spirv::merge_modes);
    merge.read("Params", params).read("Modes", modes);
    const uint64_t bytes = gpu::kMaxLightCandidates * sizeof(gpu::EmitterMode);
    const graph::BufferId candidates = merge.create("Candidates", bytes);
    merge.dispatch(1);

    auto grow = frame.compute("lighting.grow_modes", spirv::grow_modes);
    grow.read("Params", params).read("Places", list.places).read("Emitters", list.emitters);
    grow.read("Candidates", candidates);
    const graph::BufferId grown = grow.create("Grown", bytes);
    grow.dispatch(gpu::kMaxLightCandidates);
    return grown;
}

graph::BufferId add_measure_emitters(graph::FrameGraph& frame, graph::BufferId params, const EmitterList& list,
                                     graph::BufferId candidates) {
    auto pass = frame.compute("lighting.measure_emitters", spirv::measure_emitters);
    pass.read("Params", params).read("Places", list.places).read("Emitters", list.emitters);
    pass.read("Candidates", candidates);
    const graph::BufferId sightings = pass.create("Sightings", gpu::kMaxLightCandidates * sizeof(gpu::LightSighting));
    pass.dispatch(gpu::kMaxLightCandidates);
    return sightings;
}

}  // namespace

void add_find_lights(graph::FrameGraph& frame, LightTrackIds& tracks, const FindLightsInputs& in,
                     const FindLightsSettings& settings) {
    if (!(in.radiance_scale > 0) || !std::isfinite(in.radiance_scale)) {
        throw Error("the pass 'lighting.list_emitters' needs an exposure ratio above 0, not ", in.radiance_scale);
    }
    const gpu::FindLightsParams values = params_of(in, settings);
    const auto params = frame.upload<gpu::FindLightsParams>("lighting.params", std::span(&values, 1));
    const gpu::WarpDepthParams warp{in.depth_camera, kDepthUnitsPerMetre, reach_px(in), 0, 0};
    const graph::BufferId warped = add_warp_depth(frame, in, params, warp);
    const EmitterList list = add_list_emitters(frame, in, params, warped, warp, values.group_count);
    const graph::BufferId candidates = add_cluster_emitters(frame, params, list);
    const graph::BufferId sightings = add_measure_emitters(frame, params, list, candidates);

    auto track = frame.compute("lighting.track_lights", spirv::track_lights);
    track.read("Params", params).read("Sightings", sightings);
    tracks.tracks = track.modify("Tracks", tracks.tracks);
    tracks.history = track.modify("History", tracks.history);
    track.dispatch(1);
}

graph::BufferId add_settle_lights(graph::FrameGraph& frame, const LightTrackIds& tracks) {
    auto pass = frame.compute("lighting.settle_lights", spirv::settle_lights);
    pass.read("Tracks", tracks.tracks).read("History", tracks.history);
    const graph::BufferId found = pass.create("Found", gpu::kMaxLights * sizeof(gpu::FoundLight));
    pass.dispatch(gpu::kMaxLights);
    return found;
}

}  // namespace patina
