#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "passes/fusion/visible_blocks.h"
#include "passes/segmentation/segment_frame.h"
#include "passes/segmentation/surface_view.h"
#include "passes/state/label_map.h"
#include "passes/state/map_access.h"
#include "passes/state/observation_map.h"
#include "passes/state/raycast_images.h"
#include "passes/state/segment_samples.h"
#include "passes/state/segment_table.h"
#include "reconstruction/frame_context.h"
#include "shared/specular/ward_fit.h"

namespace patina {

/// Sizes and thresholds of the segmentation of the map.
struct SegmentationSettings {
    SegmentSettings frame;            ///< how a frame is divided
    bool given = false;               ///< segments are those of RgbdFrame::labels, whose ids are the labels
    uint32_t capacity_labels = 4096;  ///< at first, label 0 included
    uint32_t limit_labels = 0;        ///< beyond which the table does not grow; 0: SegmentTable::kMaxCapacity
    float inherit_share = 0.3f;       ///< of a segment's pixels that a label must cover to be the segment's
    uint32_t inherit_pixels = 15;     ///< and how many at least
    uint32_t new_pixels = 100;        ///< smaller segments get no label of their own
    float merge_share = 0.2f;       ///< of a segment's pixels that its second label must cover to be the same object's
    uint32_t merge_frames = 3;      ///< in which two labels were the same, less those in which they were not
    float merge_chroma = 0.03f;     ///< labels whose mean chromaticities differ by more are not merged
    float merge_brightness = 1.4f;  ///< nor those whose kd's luminances have a larger ratio
    float merge_ks = 0.1f;          ///< nor those whose ks differs by more, in any channel
    float merge_alpha = 2;          ///< or whose alpha's ratio is larger
    float split_chroma = 0.12f;  ///< a label is split whose colours are two with chromaticities so far apart; 0: never
    uint32_t prune_voxels = 10;  ///< labels with fewer voxels are given up
    uint32_t prune_frames = 30;  ///< when they were not seen for so many frames
    /// Frames after which each segment's records are chosen anew, at first sooner; 0: never
    uint32_t sample_every = 16;
    /// Records with fewer are chosen only where there are too few others.
    uint32_t sample_observations = gpu::kFitLeastObservations;
    uint32_t sample_seed = 1;  ///< of the first choice; others differ
};

/// How often voxels changed from one label to another, after the first frames, and but for frames in which labels were
/// merged.
struct LabelStability {
    static constexpr uint32_t kFirstFrames = 30;

    uint64_t voxels = 0;  ///< that segments voted on
    uint64_t flips = 0;   ///< of these
    double seen = 0;  ///< voxels in sight that would be voted on if no block waited for its turn: about, as if those
                      ///< that have short turns, some of whose voxels nothing shows, were like others
    uint32_t frames = 0;  ///< all of them, the first ones too

    /// Counts a frame in.
    void add(const gpu::SegmentCounters& counters) {
        if (++frames <= kFirstFrames || counters.frame_merged > 0) return;
        voxels += counters.frame_voxels;
        flips += counters.frame_flips;
        if (counters.frame_due > 0)
            seen += static_cast<double>(counters.frame_voxels) * counters.frame_seen * gpu::kLabelQuads /
                    counters.frame_due;
    }
};

/// What one frame brings to the segmentation; images of the depth camera but for the colour.
struct SegmentationInputs {
    SurfaceView surface;                    ///< the map's, after the frame was fused
    graph::ImageId depth_m;                 ///< W x H r32f: smoothed readings
    graph::ImageId color_linear;            ///< rgba16f, of the colour camera
    std::optional<graph::BufferId> fits{};  ///< gpu::WardFit per label, as of the frame before
};

/// The surface as a camera sees it: `model` was cast into the camera of `visible`.
SurfaceView surface_of(const VisibleBlocks& visible, const RaycastImages& model);

/// The map's segments: a label per voxel, carried over from the segments of frames so that an object keeps its label.
/// Lives as long as the map.
class SegmentationStage {
  public:
    /// Throws Error for settings that cannot be met, or lack of memory. The map must outlive the stage.
    SegmentationStage(vulkan::Device& device, const VoxelMap& map, const SegmentationSettings& settings,
                      MapAccess access);

    /// Forgets everything; the first thing done with it.
    void reset(graph::FrameGraph& graph);

    /// Forgets which records segments keep; they are chosen as often as at first from frame `next_frame` on.
    void forget_samples(graph::FrameGraph& graph, uint32_t next_frame);

    /// Announces that the voxel map's pool grows to `blocks`.
    void enlarge_blocks(graph::Enlargement& enlargement, uint32_t blocks) { labels_.enlarge(enlargement, blocks); }
    /// Announces that there will be `labels`; in the same frame segmentation/grow_labels.h makes use of them.
    void enlarge_labels(graph::Enlargement& enlargement, uint32_t labels);
    /// That the table can grow to, memory permitting.
    uint32_t most_labels() const;

    /// To be called after a frame's blocks were allocated, in the frame that add() is called for.
    void clear_new_blocks(graph::FrameGraph& graph, const VoxelMapIds& voxels) const;

    /// Splits labels whose records have two colours, in the frame before records are chosen anew: those that are kept
    /// have neither been given back nor left the device since they were chosen. To be called before add().
    void add_split(graph::FrameGraph& graph, const VoxelMapIds& voxels, const ObservationMap& map,
                   const FrameContext& frame) const;

    /// Divides a frame, and carries its segments over to the map. Returns the label of each pixel: W x H r32ui, 0 where
    /// none is known.
    graph::ImageId add(graph::FrameGraph& graph, const VoxelMapIds& voxels, const SegmentationInputs& inputs,
                       const FrameContext& frame) const;

    /// Whether records may be given back before a frame's observations: it chooses the segments' records anew, or never
    /// does.
    bool may_lose_records(uint32_t frame_index) const;

    /// Whether a frame's graph sweeps over a part of the map's labels, and which (segmentation/sweep_labels.h).
    static bool sweeps(uint32_t frame_index);
    /// Whether it brings the labels of observations up to date, of the same part.
    static bool relabels(uint32_t frame_index);
    static uint32_t swept_part(uint32_t frame_index);

    /// Brings one part of the observations' labels up to date with merged and pruned segments, another every few
    /// frames. To be called in every frame in which add() was, before its observations.
    /// `away`: of the records that are not on the device (AwayAlbedo); it is replaced.
    void add_relabel(graph::FrameGraph& graph, const ObservationMap& map, std::optional<graph::BufferId> away,
                     uint32_t frame_index) const;

    /// Chooses the segments' records when that is due, of those around the camera: the same ones wherever others are.
    /// To be called in every frame in which add() was, after its observations.
    void add_choose_records(graph::FrameGraph& graph, const ObservationMap& map, const FrameContext& frame) const;

    /// Where records lie that segments keep from frame to frame, and keeping those at such places again
    /// (segmentation/sample_records.h).
    graph::BufferId add_place_samples(graph::FrameGraph& graph, const ObservationMap& map) const;
    void add_find_samples(graph::FrameGraph& graph, const ObservationMap& map, graph::BufferId places) const;

    /// The labels of the surface that a camera sees: W x H r32ui, 0 where none is known.
    graph::ImageId add_view(graph::FrameGraph& graph, const SurfaceView& surface) const;

    void visit(graph::StateVisitor& visitor);

    std::vector<VoxelMap::PoolBytes> memory() const;
    const SegmentationSettings& settings() const { return settings_; }
    const SegmentTable& table() const { return table_; }
    const LabelMap& labels() const { return labels_; }
    const SegmentSamples& samples() const { return samples_; }

  private:
    bool chooses_samples(uint32_t frame_index) const;
    FrameSegments segments(graph::FrameGraph& graph, const SegmentationInputs& inputs, const FrameContext& frame) const;
    gpu::SegmentationParams params(const gpu::Camera& color_camera, Extent2D extent, uint32_t frame_index) const;

    const VoxelMap& map_;
    SegmentationSettings settings_;
    MapAccess access_;
    LabelMap labels_;
    SegmentTable table_;
    SegmentSamples samples_;
    uint32_t samples_since_ = 0;  ///< the frame from which on their choices are counted
};

}  // namespace patina
