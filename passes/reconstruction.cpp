#include "passes/reconstruction.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "engine/core/error.h"
#include "engine/core/seed.h"
#include "engine/core/shader_camera.h"
#include "passes/fusion/integrate.h"
#include "passes/fusion/measure_slope.h"
#include "passes/fusion/remove_empty_blocks.h"
#include "passes/fusion/shade_color.h"
#include "passes/fusion/sharpen_normals.h"
#include "passes/fusion/visible_blocks.h"
#include "passes/input/convert_color.h"
#include "passes/input/convert_depth.h"
#include "passes/sample_mesh.h"
#include "passes/shading/restore_detail.h"
#include "passes/surface/extract_surface.h"

namespace patina {

namespace {

/// Four half floats per pixel to four floats.
Image<glm::vec4> widened(const graph::Readback& read) {
    const Image<uint64_t> halves = read.image<uint64_t>();
    Image<glm::vec4> wide(halves.extent());
    for (size_t i = 0; i < halves.pixels().size(); ++i) wide.pixels()[i] = glm::unpackHalf4x16(halves.pixels()[i]);
    return wide;
}

template <class Pixels>
void check_size(const char* what, const Pixels& pixels, const Intrinsics& camera) {
    const size_t count = std::visit([](const auto& span) { return span.size(); }, pixels);
    if (count != camera.extent.area()) {
        throw Error("the ", what, " picture has ", count, " pixels, its camera ", camera.extent);
    }
}

SurfaceView surface_of(const VisibleBlocks& visible, const RaycastImages& model) {
    return {model.position_m, model.normal, visible.view, visible.grid, visible.list};
}

RigidTransform world_from_color_of(const RgbdFrame& frame) {
    return frame.world_from_depth * rigid_inverse(frame.color_from_depth);
}

/// Throws Error for what would make shaders divide by zero, or a weight outgrow its 16 bits.
const ReconstructionSettings& checked(const ReconstructionSettings& settings) {
    const auto check_range = [](const char* name, uint32_t value, uint32_t most) {
        if (value == 0 || value > most) throw Error(name, " is ", value, ", it must be 1 to ", most);
    };
    check_range("fusion.allocation_stride_px", settings.fusion.allocation_stride_px, 64);
    check_range("fusion.max_weight", settings.fusion.max_weight, 65535);
    check_range("fusion.max_color_weight", settings.fusion.max_color_weight, 65535);
    check_range("fusion.settled_color_every", settings.fusion.settled_color_every, 64);
    if (settings.gains && !settings.fusion.color) {
        throw Error("gains are estimated from fused colours, but fusion.color is false");
    }
    if (settings.specular && !(settings.reflectance && settings.segmentation)) {
        throw Error("specular materials are estimated from the reflectance of segments, but there ",
                    settings.reflectance ? "are no segments" : "is no reflectance");
    }
    return settings;
}

}  // namespace

ModelView PendingView::get() const {
    ModelView view{position_m_.image<glm::vec4>(), widened(normal_), widened(color_)};
    if (label_) view.label = label_->image<uint32_t>();
    if (reflectance_) {
        view.reflectance = {
            widened(reflectance_->kd),  widened(reflectance_->ks_alpha), reflectance_->label.image<uint32_t>(),
            widened(reflectance_->rgb), widened(reflectance_->light),    {}};
        for (const auto& segment : reflectance_->segments.as<gpu::SegmentAlbedo>())
            view.reflectance->segment_kd.push_back(kd_of(segment));
    }
    return view;
}

Reconstruction::Reconstruction(vulkan::Device& device, const ReconstructionSettings& settings)
    : settings_(checked(settings)),
      runner_(device),
      map_(device, settings.map),
      access_(preferred_map_access(device.caps(), map_)) {
    if (settings.gains) color_correction_.emplace(device, map_, *settings.gains, access_);
    if (settings.segmentation) {
        SegmentationSettings segmentation = *settings.segmentation;
        segmentation.sample_seed = seed_of_draw(segmentation.sample_seed, settings.seed);
        segmentation_.emplace(device, map_, segmentation, access_);
    }
    if (settings.reflectance) {
        if (segmentation_) settings_.reflectance->capacity_labels = segmentation_->table().capacity();
        reflectance_.emplace(device, map_, *settings_.reflectance);
    }
    if (settings.specular) {
        SpecularSettings specular = *settings.specular;
        specular.seed = seed_of_draw(specular.seed, settings.seed);
        specular_.emplace(device, specular, segmentation_->table().capacity(), settings.network);
    }
    if (settings.tracking) tracking_.emplace(device, *settings.tracking);
    if (settings.keyframes) {
        KeyframeSettings keyframes = *settings.keyframes;
        keyframes.store.seed = seed_of_draw(keyframes.store.seed, settings.seed);
        keyframes_.emplace(device, keyframes);
    }
    pools_.emplace(device, map_, segmentation_ ? &*segmentation_ : nullptr, reflectance_ ? &*reflectance_ : nullptr,
                   specular_ ? &*specular_ : nullptr);
}

void Reconstruction::check(const RgbdFrame& frame) const {
    check_size("depth", frame.depth.pixels, frame.depth.camera);
    check_size("colour", frame.color.pixels, frame.color.camera);
    check_depth(frame.depth);
    check_color(frame.color);
    if (!frame.labels.empty() && frame.labels.size() != frame.depth.camera.extent.area()) {
        throw Error("the label picture has ", frame.labels.size(), " pixels, the depth camera ",
                    frame.depth.camera.extent);
    }
    // Readers orthonormalise poses; what is left is rounding.
    const double defect = rotation_defect(frame.world_from_depth);
    if (!(defect < 1e-3)) throw Error("the pose of frame ", frames(), " is not rigid: its rotation is off by ", defect);
}

VisibleBlocks Reconstruction::add_passes(graph::Frame& graph, VoxelMapIds& ids, const RgbdFrame& frame,
                                         const InputPictures& pictures) {
    const gpu::Camera depth_camera = make_camera(frame.depth.camera, frame.world_from_depth);
    const RigidTransform world_from_color = world_from_color_of(frame);
    const gpu::Camera color_camera = make_camera(frame.color.camera, world_from_color);
    InputImages input = add_input(graph, pictures, depth_camera, settings_.input);
    // With the colours that the camera gave: those of a lost frame cannot be corrected.
    if (keyframes_) keyframes_->add_keep(graph, input.depth_m, input.color, frame.world_from_depth, frames_);
    const graph::ImageId slope = add_measure_slope(graph, input.filtered_depth_m, frame.depth.camera);

    // What the view does not reach would take blocks that no frame fuses into.
    FusionSettings fusion = settings_.fusion;
    fusion.max_depth_m = reach_m(frame.depth.camera);
    fusion.seed = seed_of_draw(fusion.seed, settings_.seed);
    const gpu::FusionParams values =
        make_fusion_params(map_, fusion, depth_camera, color_camera, frames_, color_frames_);
    const auto params = graph.upload<gpu::FusionParams>("fusion.params", std::span(&values, 1));
    if (color_correction_) {
        input.color = color_correction_->add(graph, ids, input.color, frame.color.camera, world_from_color,
                                             settings_.near_m, far_m());
    }
    add_allocate_blocks(graph, map_, ids, input.depth_m, params, fusion.allocation_stride_px);
    if (segmentation_) segmentation_->clear_new_blocks(graph, ids);
    const VisibleBlocks visible = add_visible_blocks(graph, map_, ids, depth_camera, settings_.near_m, far_m());
    add_integrate(graph, map_, ids, visible, params, input.depth_m, slope,
                  fuses_color(frame) ? std::optional(input.color) : std::nullopt);
    if (segmentation_ || reflectance_ || tracking_ || settings_.view_every_frame) {
        const RaycastImages model = add_raycast(graph, map_, ids, visible, access_);
        if (tracking_) keep_reference(graph, ids, visible, model, frame.depth.camera, frame.world_from_depth);
        const RaycastImages sharp = sharpened(graph, model, frame.depth.camera);
        ObservationInputs observed{sharp.position_m, sharp.normal, input.depth_m, slope, input.color, {}};
        if (segmentation_) observed.labels = segment(graph, ids, visible, model, input, frame);
        if (segmentation_ && reflectance_) {
            ObservationMapIds records = reflectance_->observations().import(graph);
            segmentation_->add_records(graph, reflectance_->observations(), records, frames_);
        }
        if (reflectance_ && !frame.held_out) observe(graph, ids, observed, frame);
        if (settings_.view_every_frame) {
            graph.keep(model.position_m);
            graph.keep(model.normal);
        }
    }
    if (settings_.remove_every > 0 && frames_ % settings_.remove_every == settings_.remove_every - 1) {
        add_remove_empty_blocks(graph, map_, ids, visible, params);
    }
    return visible;
}

RaycastImages Reconstruction::sharpened(graph::Frame& graph, const RaycastImages& model,
                                        const Intrinsics& camera) const {
    return add_sharpen_normals(graph, model, static_cast<float>(camera.fx), settings_.map.voxel_m);
}

graph::ImageId Reconstruction::segment(graph::Frame& graph, const VoxelMapIds& ids, const VisibleBlocks& visible,
                                       const RaycastImages& model, const InputImages& input, const RgbdFrame& frame) {
    SegmentationInputs inputs{surface_of(visible, model), input.filtered_depth_m, input.color, {}};
    if (specular_) inputs.fits = specular_->fits(graph);
    if (settings_.segmentation->given) {
        const Extent2D extent = frame.depth.camera.extent;
        std::vector<uint32_t> words(frame.labels.begin(), frame.labels.end());
        words.resize(extent.area());
        inputs.given = graph.upload("labels", {extent, vulkan::Format::kR32u}, std::as_bytes(std::span(words)));
    }
    return segmentation_->add(graph, ids, inputs, make_camera(frame.depth.camera, frame.world_from_depth),
                              make_camera(frame.color.camera, world_from_color_of(frame)), frames_);
}

void Reconstruction::observe(graph::Frame& graph, const VoxelMapIds& ids, ObservationInputs inputs,
                             const RgbdFrame& frame) {
    if (world_from_color_before_) {
        inputs.motion = {make_camera(frame.color.camera, *world_from_color_before_).camera_from_world,
                         frame.shutter_share};
    }
    const RecordList changed =
        reflectance_->add(graph, ids, inputs, make_camera(frame.depth.camera, frame.world_from_depth),
                          make_camera(frame.color.camera, world_from_color_of(frame)), frames_);
    if (specular_) specular_->add(graph, *reflectance_, *segmentation_, changed, frames_);
}

void Reconstruction::refine_all() {
    if (!reflectance_ || frames_ == 0) return;
    fuse_waiting();
    graph::Frame graph = runner_.begin();
    reflectance_->refine_all(graph, map_.import(graph));
    runner_.submit(std::move(graph));
}

void Reconstruction::relight(std::span<const PointLight> lights, glm::vec3 ambient) {
    if (!reflectance_ || frames_ == 0) return;
    refine_all();
    graph::Frame graph = runner_.begin();
    reflectance_->relight(graph, map_.import(graph), lights, ambient);
    runner_.submit(std::move(graph));
}

float Reconstruction::far_m() const {
    const FusionSettings& fusion = settings_.fusion;
    const float truncation_m = least_truncation_m(fusion, settings_.map.voxel_m);
    return fusion.max_depth_m + truncation_m + fusion.truncation_slope * fusion.max_depth_m;
}

float Reconstruction::reach_m(const Intrinsics& camera) const {
    const float seen_m = view_reach_m(make_camera(camera, RigidTransform(1)), settings_.map.voxel_m, far_m());
    if (seen_m >= far_m()) return settings_.fusion.max_depth_m;
    // Behind a surface there is room for its truncation band.
    const float truncation_m = least_truncation_m(settings_.fusion, settings_.map.voxel_m);
    return (seen_m - truncation_m) / (1 + settings_.fusion.truncation_slope);
}

bool Reconstruction::add(const RgbdFrame& frame) {
    check(frame);
    if (!tracking_) {
        fuse_posed(frame);
        return true;
    }
    const bool first = !tracking_->has_reference();
    const TrackingReport report = first ? start_tracking(frame) : track(frame);
    if (report.state != TrackingState::kTracking) return false;
    RgbdFrame posed = frame;
    posed.world_from_depth = report.world_from_depth;
    if (first) {
        fuse_posed(posed);
        return true;
    }
    // The caller's pixels are gone when the frame has its turn.
    posed.depth.pixels = {};
    posed.color.pixels = {};
    posed.labels = {};
    waiting_.emplace(Waiting{posed, {frame.labels.begin(), frame.labels.end()}});
    return true;
}

void Reconstruction::start_map(const RgbdFrame& frame) {
    graph::Frame graph = runner_.begin();
    const glm::dvec3 center_m(frame.world_from_depth[3]);
    map_.reset(graph, center_m);
    if (color_correction_) color_correction_->reset(graph);
    if (reflectance_) reflectance_->reset(graph, center_m);
    if (segmentation_) segmentation_->reset(graph);
    if (specular_) specular_->reset(graph);
    if (keyframes_) keyframes_->reset(graph);
    runner_.submit(std::move(graph));
    pools_->reset();
}

/// A frame that fuses; before it, one that lets pools grow where they are short.
graph::Frame Reconstruction::begin_fusing() {
    pools_->grow(runner_, frames_);
    return runner_.begin();
}

Reconstruction::PendingCounts Reconstruction::submit_posed(graph::Frame graph, const RgbdFrame& frame) {
    PendingCounts counts =
        add_fusion(graph, frame, {add_convert_depth(graph, frame.depth), add_convert_color(graph, frame.color)});
    submit_fusion(std::move(graph), counts);
    return counts;
}

void Reconstruction::submit_fusion(graph::Frame graph, const PendingCounts& counts) {
    runner_.submit(std::move(graph));
    pools_->await(frames_, counts.pools);
}

/// Nothing is known yet of what the first frame asks for. Where that is more than the pools hold, they grow, and the
/// frame is fused anew, into an empty model.
void Reconstruction::fuse_first(const RgbdFrame& frame) {
    std::optional<PendingCounts> counts;
    do {
        start_map(frame);
        counts = submit_posed(runner_.begin(), frame);
        runner_.wait();
    } while (pools_->first_was_refused() && pools_->grow(runner_, 0));
    note_fused(frame, *std::move(counts));
}

void Reconstruction::fuse_posed(const RgbdFrame& frame) {
    if (frames_ == 0) return fuse_first(frame);
    note_fused(frame, submit_posed(begin_fusing(), frame));
}

void Reconstruction::fuse_waiting() {
    if (!waiting_) return;
    graph::Frame graph = begin_fusing();
    PendingCounts counts = add_waiting(graph);
    submit_fusion(std::move(graph), counts);
    note_waiting_fused(std::move(counts));
}

Reconstruction::PendingCounts Reconstruction::add_waiting(graph::Frame& graph) {
    waiting_->frame.labels = waiting_->labels;
    return add_fusion(graph, waiting_->frame, tracking_->pictures().import(graph));
}

void Reconstruction::note_waiting_fused(PendingCounts counts) {
    note_fused(waiting_->frame, std::move(counts));
    waiting_.reset();
}

Reconstruction::PendingCounts Reconstruction::add_fusion(graph::Frame& graph, const RgbdFrame& frame,
                                                         const InputPictures& pictures) {
    VoxelMapIds ids = map_.import(graph);
    const VisibleBlocks visible = add_passes(graph, ids, frame, pictures);
    VoxelMap::keep(graph, ids);
    PendingCounts pending{{graph.read_back(ids.counters)}, graph.read_back(visible.list, 0, sizeof(uint32_t))};
    if (segmentation_) pending.pools.labels = graph.read_back(segmentation_->table().import(graph).counters);
    if (reflectance_) {
        const ObservationMapIds observed = reflectance_->observations().import(graph);
        pending.pools.observed_blocks = graph.read_back(observed.block_counters);
        pending.pools.observed_records = graph.read_back(observed.record_counters);
    }
    return pending;
}

void Reconstruction::note_fused(const RgbdFrame& frame, PendingCounts counts) {
    pending_counts_.push_back(std::move(counts));
    world_from_color_before_ = world_from_color_of(frame);
    ++frames_;
    if (fuses_color(frame)) ++color_frames_;
    take_counts();
}

void Reconstruction::wait() {
    fuse_waiting();
    runner_.wait();
}

PendingView Reconstruction::view(const Intrinsics& camera, const RigidTransform& world_from_camera) {
    fuse_waiting();
    graph::Frame graph = runner_.begin();
    const VoxelMapIds ids = map_.import(graph);
    const VisibleBlocks visible = add_visible_blocks(graph, map_, ids, make_camera(camera, world_from_camera),
                                                     settings_.near_m, 2 * settings_.fusion.max_depth_m);
    const RaycastImages model = sharpened(graph, add_raycast(graph, map_, ids, visible, access_), camera);
    const graph::ImageId color = add_shade_color(graph, map_, ids, visible, model.position_m);
    PendingView pending;
    pending.position_m_ = graph.read_back(model.position_m);
    pending.normal_ = graph.read_back(model.normal);
    pending.color_ = graph.read_back(color);
    if (segmentation_) pending.label_ = graph.read_back(segmentation_->add_view(graph, surface_of(visible, model)));
    if (reflectance_) {
        const auto [predicted, segments] = reflectance_->add_predict(graph, ids, visible, model);
        const RestoreDetailInputs inputs{model.position_m, model.normal, color, static_cast<float>(camera.fx),
                                         settings_.reflectance->voxel_m};
        // Under other lights than those of the frames, their colours would bring back the shadows of these.
        const bool detailed = settings_.fusion.color && reflectance_->settings().refine.albedo;
        const PredictedImages seen = detailed ? add_restore_detail(graph, predicted, inputs) : predicted;
        pending.reflectance_ = {graph.read_back(seen.kd),  graph.read_back(seen.ks_alpha), graph.read_back(seen.label),
                                graph.read_back(seen.rgb), graph.read_back(seen.light),    graph.read_back(segments)};
    }
    runner_.submit(std::move(graph));
    return pending;
}

Mesh Reconstruction::extract_surface() {
    if (frames_ == 0) return {};
    wait();
    runner_.forget_shapes();  // extraction may need the memory of what frames keep between them
    return patina::extract_surface(runner_, map_);
}

MeshReflectance Reconstruction::sample_reflectance(const Mesh& mesh) {
    if (!reflectance_ || frames_ == 0) return {};
    refine_all();
    MeshReflectance sampled = sample_mesh(runner_, *reflectance_, mesh);
    if (!specular_) return sampled;
    graph::Frame graph = runner_.begin();
    const graph::Readback read = graph.read_back(specular_->fits(graph));
    runner_.submit(std::move(graph));
    runner_.wait();
    const auto fits = read.as<gpu::WardFit>();
    for (size_t label = 0; label < std::min(fits.size(), sampled.segments.size()); ++label) {
        if (auto& gloss = sampled.segments[label].gloss) gloss->confidence = fits[label].confidence;
    }
    return sampled;
}

void Reconstruction::take_counts() {
    for (; !pending_counts_.empty() && pending_counts_.front().visible_blocks.ready(); pending_counts_.pop_front()) {
        const PendingCounts& counts = pending_counts_.front();
        counters_ = counts.pools.voxels.as<gpu::MapCounters>().front();
        visible_blocks_ = counts.visible_blocks.as<uint32_t>().front();
        if (segmentation_) {
            segment_counters_ = counts.pools.labels.as<gpu::SegmentCounters>().front();
            label_stability_.add(segment_counters_);
        }
        if (!reflectance_) continue;
        observation_counters_.blocks = counts.pools.observed_blocks.as<gpu::MapCounters>().front();
        observation_counters_.records = counts.pools.observed_records.as<gpu::MapCounters>().front();
    }
}

const gpu::MapCounters& Reconstruction::counters() {
    take_counts();
    return counters_;
}

const ObservationCounters& Reconstruction::observation_counters() {
    take_counts();
    return observation_counters_;
}

const LabelStability& Reconstruction::label_stability() {
    take_counts();
    return label_stability_;
}

const gpu::SegmentCounters& Reconstruction::segment_counters() {
    take_counts();
    return segment_counters_;
}

std::vector<PoolState> Reconstruction::pools() {
    wait();
    return pools_->states();
}

uint32_t Reconstruction::visible_blocks() {
    take_counts();
    return visible_blocks_;
}

}  // namespace patina
