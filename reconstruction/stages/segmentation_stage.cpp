#include "reconstruction/stages/segmentation_stage.h"

#include <algorithm>
#include <bit>

#include "passes/segmentation/assign_labels.h"
#include "passes/segmentation/clear_labels.h"
#include "passes/segmentation/count_overlaps.h"
#include "passes/segmentation/label_pixels.h"
#include "passes/segmentation/list_due_blocks.h"
#include "passes/segmentation/relabel_away.h"
#include "passes/segmentation/relabel_records.h"
#include "passes/segmentation/sample_labels.h"
#include "passes/segmentation/sample_records.h"
#include "passes/segmentation/split_labels.h"
#include "passes/segmentation/sweep_away.h"
#include "passes/segmentation/sweep_labels.h"
#include "passes/segmentation/update_labels.h"
#include "passes/state/pool_sizes.h"
#include "shared/specular/ward_fit.h"

namespace patina {

namespace {

// Not in the frames in which samples are chosen, which add passes of their own.
constexpr uint32_t kSweepTurn = 1, kRelabelTurn = 3;

constexpr double kBlocksBesideSamples = 2;
static_assert(kBlocksBesideSamples < StreamRegion::kBlocksBeside);

/// In the beginning, when most records are new, more often: after 1, 2, 4, 8, ... frames.
bool samples_are_due(uint32_t frame_index, uint32_t every) {
    if (every == 0) return false;
    const uint32_t frames = frame_index + 1;
    return frames % every == 0 || (frames < every && std::has_single_bit(frames));
}

/// Of no label: one entry, as buffers have some bytes.
graph::BufferId no_fits(graph::FrameGraph& graph) {
    return graph.fill(graph.create_buffer("segmentation.no_fits", sizeof(gpu::WardFit)), 0);
}

uint32_t first_labels(const SegmentationSettings& settings) {
    return std::min(settings.capacity_labels, limit_or_none(settings.limit_labels));
}

/// The ids that a frame was given, as r32ui of its depth camera; 0 where it was given none.
graph::ImageId upload_labels(graph::FrameGraph& graph, const FrameContext& frame) {
    const Extent2D extent = frame.depth.intrinsics.extent;
    std::vector<uint32_t> words(frame.labels.begin(), frame.labels.end());
    words.resize(extent.area());
    return graph.upload("labels", {extent, vulkan::Format::kR32u}, std::as_bytes(std::span(words)));
}

}  // namespace

SurfaceView surface_of(const VisibleBlocks& visible, const RaycastImages& model) {
    return {model.position_m, model.normal, visible.view, visible.grid, visible.list};
}

SegmentationStage::SegmentationStage(vulkan::Device& device, const VoxelMap& map, const SegmentationSettings& settings,
                                     MapAccess access)
    : map_(map),
      settings_(settings),
      access_(access),
      labels_(device, map),
      table_(device, first_labels(settings)),
      samples_(device, table_.capacity()) {}

uint32_t SegmentationStage::most_labels() const {
    return std::min(limit_or_none(settings_.limit_labels), SegmentTable::kMaxCapacity);
}

void SegmentationStage::enlarge_labels(graph::Enlargement& enlargement, uint32_t labels) {
    table_.enlarge(enlargement, labels);
    samples_.enlarge(enlargement, labels);
}

void SegmentationStage::reset(graph::FrameGraph& graph) {
    table_.reset(graph);
    forget_samples(graph, 0);
}

void SegmentationStage::forget_samples(graph::FrameGraph& graph, uint32_t next_frame) {
    samples_.reset(graph);
    samples_since_ = next_frame - next_frame % gpu::kSweepEvery;  // as records leave in turns of sweeps
}

gpu::SegmentationParams SegmentationStage::params(const gpu::Camera& color_camera, Extent2D extent,
                                                  uint32_t frame_index) const {
    gpu::SegmentationParams params{};
    params.color_camera = color_camera;
    params.extent = {extent.width, extent.height};
    params.stamp = frame_index + 1;
    params.capacity = table_.capacity();
    params.overlap_slots = overlap_slots(extent);
    params.given = settings_.given ? 1 : 0;
    params.inherit_share = settings_.inherit_share;
    params.inherit_pixels = settings_.inherit_pixels;
    params.merge_share = settings_.merge_share;
    params.merge_count = settings_.merge_frames;
    params.merge_chroma = settings_.merge_chroma;
    params.merge_brightness = settings_.merge_brightness;
    params.merge_ks = settings_.merge_ks;
    params.merge_alpha = settings_.merge_alpha;
    params.new_pixels = settings_.new_pixels;
    params.prune_voxels = settings_.prune_voxels;
    params.prune_frames = settings_.prune_frames;
    return params;
}

void SegmentationStage::clear_new_blocks(graph::FrameGraph& graph, const VoxelMapIds& voxels) const {
    LabelMapIds labels = labels_.import(graph);
    add_clear_labels(graph, map_, voxels, labels);
}

FrameSegments SegmentationStage::segments(graph::FrameGraph& graph, const SegmentationInputs& inputs,
                                          const FrameContext& frame) const {
    const SegmentSettings& settings = settings_.frame;
    if (settings_.given)
        return add_given_segments(graph, upload_labels(graph, frame), inputs.depth_m, settings.capacity);
    return add_segment_frame(graph, inputs.surface.position_m, inputs.depth_m, frame.depth.gpu,
                             {inputs.color_linear, frame.color.gpu}, settings);
}

void SegmentationStage::add_split(graph::FrameGraph& graph, const VoxelMapIds& voxels, const ObservationMap& map,
                                  const FrameContext& frame) const {
    if (settings_.given || settings_.split_chroma <= 0 || !chooses_samples(frame.index + 1)) return;
    LabelMapIds labels = labels_.import(graph);
    ObservationMapIds records = map.import(graph);
    SegmentTableIds table = table_.import(graph);
    SegmentSampleIds samples = samples_.import(graph);
    add_split_labels(graph, map_, voxels, labels, map, records, table, samples, table_.capacity(),
                     {settings_.split_chroma, frame.index + 1});
}

graph::ImageId SegmentationStage::add(graph::FrameGraph& graph, const VoxelMapIds& voxels,
                                      const SegmentationInputs& inputs, const FrameContext& frame) const {
    const SurfaceView& surface = inputs.surface;
    const FrameSegments seen = segments(graph, inputs, frame);
    const gpu::SegmentationParams values = params(frame.color.gpu, graph.shape(surface.position_m).extent, frame.index);
    const auto uniforms = graph.upload<gpu::SegmentationParams>("segmentation.params", std::span(&values, 1));
    LabelMapIds labels = labels_.import(graph);
    SegmentTableIds table = table_.import(graph);
    const graph::ImageId known =
        add_sample_labels(graph, map_, labels, table.parents, surface, access_, gpu::kSampleStride);
    const SegmentOverlaps overlaps =
        add_count_overlaps(graph, table, seen, known, surface.position_m, inputs.color_linear, uniforms);
    KnownMaterials materials{samples_.import(graph).kd, inputs.fits ? *inputs.fits : no_fits(graph)};
    const graph::BufferId assigned = add_assign_labels(graph, table, seen, overlaps, materials, uniforms);
    // In these frames add_choose_records() begins it anew.
    if (!chooses_samples(frame.index)) graph.keep(materials.kd);
    const DueBlocks due = add_list_due_blocks(graph, map_, voxels, labels, surface.blocks, values.stamp);
    add_update_labels(graph, map_, voxels, labels, table, surface, due, seen, assigned, access_);
    if (sweeps(frame.index)) add_sweep_labels(graph, map_, voxels, labels, table, uniforms);
    if (!frame.labels_away.empty())
        add_sweep_away(graph, table, graph.upload<uint32_t>("segmentation.labels_away", frame.labels_away));
    LabelMap::keep(graph, labels);
    SegmentTable::keep(graph, table);
    return add_label_pixels(graph, seen, known, table.parents, assigned, {values.extent.x, values.extent.y});
}

bool SegmentationStage::sweeps(uint32_t frame_index) { return (frame_index + 1) % gpu::kSweepEvery == kSweepTurn; }

bool SegmentationStage::relabels(uint32_t frame_index) { return (frame_index + 1) % gpu::kSweepEvery == kRelabelTurn; }

uint32_t SegmentationStage::swept_part(uint32_t frame_index) {
    return (frame_index + 1) / gpu::kSweepEvery % gpu::kSweepParts;
}

bool SegmentationStage::may_lose_records(uint32_t frame_index) const {
    return settings_.sample_every == 0 || chooses_samples(frame_index);
}

bool SegmentationStage::chooses_samples(uint32_t frame_index) const {
    return samples_are_due(frame_index - samples_since_, settings_.sample_every);
}

graph::BufferId SegmentationStage::add_place_samples(graph::FrameGraph& graph, const ObservationMap& map) const {
    return patina::add_place_samples(graph, map.import(graph), samples_, samples_.import(graph));
}

void SegmentationStage::add_find_samples(graph::FrameGraph& graph, const ObservationMap& map,
                                         graph::BufferId places) const {
    SegmentSampleIds ids = samples_.import(graph);
    patina::add_find_samples(graph, map, map.import(graph), samples_, ids, places);
    SegmentSamples::keep(graph, ids);
}

void SegmentationStage::add_relabel(graph::FrameGraph& graph, const ObservationMap& map,
                                    std::optional<graph::BufferId> away, uint32_t frame_index) const {
    if (!relabels(frame_index)) return;
    ObservationMapIds records = map.import(graph);
    gpu::SegmentationParams values{};
    values.stamp = frame_index + 1;
    const auto uniforms = graph.upload<gpu::SegmentationParams>("segmentation.record_params", std::span(&values, 1));
    const SegmentTableIds table = table_.import(graph);
    add_relabel_records(graph, map, records, table, uniforms);
    if (away) add_relabel_away(graph, *away, table, uniforms);
}

void SegmentationStage::add_choose_records(graph::FrameGraph& graph, const ObservationMap& map,
                                           const FrameContext& frame) const {
    if (!chooses_samples(frame.index)) return;
    const ObservationMapIds records = map.import(graph);
    SegmentSampleIds ids = samples_.import(graph);
    // What estimates look at beside a record lies in the region, too.
    const double beside_m = kBlocksBesideSamples * double{map_.settings().voxel_m} * gpu::kBlockEdge;
    add_sample_records(graph, map, records, samples_, ids,
                       {map_.grid(), frame.around.grown(-beside_m).gpu(), settings_.sample_observations,
                        settings_.sample_seed + frame.index});
    SegmentSamples::keep(graph, ids);
}

graph::ImageId SegmentationStage::add_view(graph::FrameGraph& graph, const SurfaceView& surface) const {
    return add_sample_labels(graph, map_, labels_.import(graph), table_.import(graph).parents, surface, access_);
}

std::vector<VoxelMap::PoolBytes> SegmentationStage::memory() const {
    return {{"voxel labels", labels_.bytes()}, {"segments", table_.bytes()}, {"segment samples", samples_.bytes()}};
}

void SegmentationStage::visit(graph::StateVisitor& visitor) {
    labels_.visit(visitor);
    table_.visit(visitor);
    samples_.visit(visitor);
    visitor.value("segmentation.samples_since", samples_since_);
}

}  // namespace patina
