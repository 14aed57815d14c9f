#include "passes/segmentation_model.h"

#include <algorithm>
#include <bit>

#include "passes/model/pool_sizes.h"
#include "passes/segmentation/assign_labels.h"
#include "passes/segmentation/clear_labels.h"
#include "passes/segmentation/count_overlaps.h"
#include "passes/segmentation/label_pixels.h"
#include "passes/segmentation/list_due_blocks.h"
#include "passes/segmentation/relabel_records.h"
#include "passes/segmentation/sample_labels.h"
#include "passes/segmentation/sample_records.h"
#include "passes/segmentation/sweep_labels.h"
#include "passes/segmentation/update_labels.h"
#include "shared/ward_fit.h"

namespace patina {

namespace {

// Not in the frames in which samples are chosen, which add passes of their own.
constexpr uint32_t kSweepTurn = 1, kRelabelTurn = 3;

/// In the beginning, when most records are new, more often: after 4, 8, ... frames.
bool samples_are_due(uint32_t frame_index, uint32_t every) {
    if (every == 0) return false;
    const uint32_t frames = frame_index + 1;
    return frames % every == 0 || (frames >= 4 && frames < every && std::has_single_bit(frames));
}

/// Of no label: one entry, as buffers have some bytes.
graph::BufferId no_fits(graph::Frame& frame) {
    return frame.fill(frame.create_buffer("segmentation.no_fits", sizeof(gpu::WardFit)), 0);
}

uint32_t first_labels(const SegmentationSettings& settings) {
    return std::min(settings.capacity_labels, limit_or_none(settings.limit_labels));
}

}  // namespace

SegmentationModel::SegmentationModel(vulkan::Device& device, const VoxelMap& map, const SegmentationSettings& settings,
                                     MapAccess access)
    : map_(map),
      settings_(settings),
      access_(access),
      labels_(device, map),
      table_(device, first_labels(settings)),
      samples_(device, table_.capacity()) {}

uint32_t SegmentationModel::most_labels() const {
    return std::min(limit_or_none(settings_.limit_labels), SegmentTable::kMaxCapacity);
}

void SegmentationModel::enlarge_labels(graph::Enlargement& enlargement, uint32_t labels) {
    table_.enlarge(enlargement, labels);
    samples_.enlarge(enlargement, labels);
}

void SegmentationModel::reset(graph::Frame& frame) const {
    table_.reset(frame);
    samples_.reset(frame);
}

gpu::SegmentationParams SegmentationModel::params(const gpu::Camera& color_camera, Extent2D extent,
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

void SegmentationModel::clear_new_blocks(graph::Frame& frame, const VoxelMapIds& voxels) const {
    LabelMapIds labels = labels_.import(frame);
    add_clear_labels(frame, map_, voxels, labels);
}

FrameSegments SegmentationModel::segments(graph::Frame& frame, const SegmentationInputs& inputs,
                                          const gpu::Camera& depth_camera, const gpu::Camera& color_camera) const {
    const SegmentSettings& settings = settings_.frame;
    if (inputs.given) return add_given_segments(frame, *inputs.given, inputs.depth_m, settings.capacity);
    return add_segment_frame(frame, inputs.surface.position_m, inputs.depth_m, depth_camera,
                             {inputs.color_linear, color_camera}, settings);
}

graph::ImageId SegmentationModel::add(graph::Frame& frame, const VoxelMapIds& voxels, const SegmentationInputs& inputs,
                                      const gpu::Camera& depth_camera, const gpu::Camera& color_camera,
                                      uint32_t frame_index) const {
    const SurfaceView& surface = inputs.surface;
    const FrameSegments seen = segments(frame, inputs, depth_camera, color_camera);
    const gpu::SegmentationParams values = params(color_camera, frame.shape(surface.position_m).extent, frame_index);
    const auto uniforms = frame.upload<gpu::SegmentationParams>("segmentation.params", std::span(&values, 1));
    LabelMapIds labels = labels_.import(frame);
    SegmentTableIds table = table_.import(frame);
    const graph::ImageId known =
        add_sample_labels(frame, map_, labels, table.parents, surface, access_, gpu::kSampleStride);
    const SegmentOverlaps overlaps =
        add_count_overlaps(frame, table, seen, known, surface.position_m, inputs.color_linear, uniforms);
    KnownMaterials materials{samples_.import(frame).kd, inputs.fits ? *inputs.fits : no_fits(frame)};
    const graph::BufferId assigned = add_assign_labels(frame, table, seen, overlaps, materials, uniforms);
    // In these frames add_records() begins it anew.
    if (!samples_are_due(frame_index, settings_.sample_every)) frame.keep(materials.kd);
    const DueBlocks due = add_list_due_blocks(frame, map_, voxels, labels, surface.blocks, values.stamp);
    add_update_labels(frame, map_, voxels, labels, table, surface, due, seen, assigned, access_);
    if (values.stamp % gpu::kSweepEvery == kSweepTurn) add_sweep_labels(frame, map_, voxels, labels, table, uniforms);
    LabelMap::keep(frame, labels);
    SegmentTable::keep(frame, table);
    return add_label_pixels(frame, seen, known, table.parents, assigned, {values.extent.x, values.extent.y});
}

void SegmentationModel::add_records(graph::Frame& frame, const ObservationMap& map, ObservationMapIds& records,
                                    uint32_t frame_index) const {
    gpu::SegmentationParams values{};
    values.stamp = frame_index + 1;
    const auto uniforms = frame.upload<gpu::SegmentationParams>("segmentation.record_params", std::span(&values, 1));
    if (values.stamp % gpu::kSweepEvery == kRelabelTurn)
        add_relabel_records(frame, map, records, table_.import(frame), uniforms);
    if (!samples_are_due(frame_index, settings_.sample_every)) return;
    SegmentSampleIds ids = samples_.import(frame);
    add_sample_records(frame, map, records, samples_, ids, settings_.sample_observations,
                       settings_.sample_seed + frame_index);
    SegmentSamples::keep(frame, ids);
}

graph::ImageId SegmentationModel::add_view(graph::Frame& frame, const SurfaceView& surface) const {
    return add_sample_labels(frame, map_, labels_.import(frame), table_.import(frame).parents, surface, access_);
}

std::vector<VoxelMap::PoolBytes> SegmentationModel::memory() const {
    return {{"voxel labels", labels_.bytes()}, {"segments", table_.bytes()}, {"segment samples", samples_.bytes()}};
}

}  // namespace patina
