#include "reconstruction/setting_rows.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <type_traits>

#include "passes/state/segment_materials.h"
#include "passes/state/segment_table.h"
#include "shared/segmentation/frame_segments.h"
#include "shared/tracking/keyframes.h"

namespace patina {

namespace {

/// The value of an optional part; null where it is off and stays so.
template <class Part>
Part* held(std::optional<Part>& part, bool create) {
    if (!part && create) part.emplace();
    return part ? &*part : nullptr;
}

/// A struct of settings within another one; null where that is off.
template <class Outer, class Part>
Part* within(Outer* outer, Part Outer::*part) {
    return outer ? &(outer->*part) : nullptr;
}

/// The struct of settings of one type, of which there is one.
template <class Part>
Part* find(ReconstructionSettings& s, bool create) {
    const auto in_reflectance = [&](auto part) { return within(held(s.reflectance, create), part); };
    const auto in_segmentation = [&] { return within(held(s.segmentation, create), &SegmentationSettings::frame); };
    const auto in_edges = [&] { return within(in_segmentation(), &SegmentSettings::edges); };
    const auto in_tracking = [&](auto part) { return within(held(s.tracking, create), part); };
    if constexpr (std::is_same_v<Part, ReconstructionSettings>) return &s;
    if constexpr (std::is_same_v<Part, VoxelMapSettings>) return &s.map;
    if constexpr (std::is_same_v<Part, FusionSettings>) return &s.fusion;
    if constexpr (std::is_same_v<Part, DepthFilter>) return &s.input.filter;
    if constexpr (std::is_same_v<Part, DepthJump>) return &s.input.jump;
    if constexpr (std::is_same_v<Part, SegmentationSettings>) return held(s.segmentation, create);
    if constexpr (std::is_same_v<Part, SegmentSettings>) return in_segmentation();
    if constexpr (std::is_same_v<Part, EdgeSettings>) return in_edges();
    if constexpr (std::is_same_v<Part, DepthNoise>) return within(in_edges(), &EdgeSettings::noise);
    if constexpr (std::is_same_v<Part, FoldSettings>) return within(in_segmentation(), &SegmentSettings::folds);
    if constexpr (std::is_same_v<Part, GainSettings>) return held(s.gains, create);
    if constexpr (std::is_same_v<Part, ReflectanceStageSettings>) return held(s.reflectance, create);
    if constexpr (std::is_same_v<Part, ReflectanceSettings>) return in_reflectance(&ReflectanceStageSettings::refine);
    if constexpr (std::is_same_v<Part, ObservationSettings>) return in_reflectance(&ReflectanceStageSettings::observe);
    if constexpr (std::is_same_v<Part, TrackingSettings>) return held(s.tracking, create);
    if constexpr (std::is_same_v<Part, TrackErrors>) return in_tracking(&TrackingSettings::errors);
    if constexpr (std::is_same_v<Part, TrackingBounds>) return in_tracking(&TrackingSettings::bounds);
    if constexpr (std::is_same_v<Part, KeyframeSettings>) return held(s.keyframes, create);
    if constexpr (std::is_same_v<Part, KeyframeStoreSettings>)
        return within(held(s.keyframes, create), &KeyframeSettings::store);
    if constexpr (std::is_same_v<Part, SpecularSettings>) return held(s.specular, create);
}

template <class Part, class Value>
Part part_of(Value Part::*);

template <auto kMember>
using PartOf = decltype(part_of(kMember));

/// A name for each struct that has settings.
template <class Part>
constexpr std::string_view owner_name() {
    return __PRETTY_FUNCTION__;
}

template <auto kMember>
SettingPlace place(ReconstructionSettings& settings, bool create) {
    if (auto* part = find<PartOf<kMember>>(settings, create)) return &(part->*kMember);
    return std::monostate{};
}

/// A setting that is a number.
template <auto kMember>
constexpr SettingRow number(const char* key, const char* unit, double min, double max, const char* sentence,
                            const char* note = "") {
    return {key, unit, min, max, sentence, note, place<kMember>, owner_name<PartOf<kMember>>()};
}

/// A setting that is a flag or a word.
template <auto kMember>
constexpr SettingRow choice(const char* key, const char* sentence) {
    return {key, "", 0, 0, sentence, "", place<kMember>, owner_name<PartOf<kMember>>()};
}

constexpr double kAnyCount = UINT32_MAX;
constexpr double kFar_m = 1000;
constexpr double kManyPixels = 1e6;
/// Up to here every whole number has a double of its own, one more included.
constexpr double kLargestSeed = 9007199254740991.0;
constexpr const char* kOneRecording = "Chosen on one recording.";
constexpr const char* kTriedOnOne = "Tried on one recording.";
constexpr const char* kOneScene = "Chosen on one synthetic scene.";
constexpr const char* kTwoScenes = "Chosen on two synthetic scenes.";

using Rec = ReconstructionSettings;
using Map = VoxelMapSettings;
using Fuse = FusionSettings;
using Seg = SegmentationSettings;
using Frame = SegmentSettings;
using Edge = EdgeSettings;
using Fold = FoldSettings;
using Gain = GainSettings;
using Refl = ReflectanceStageSettings;
using Refine = ReflectanceSettings;
using Obs = ObservationSettings;
using Track = TrackingSettings;
using Err = TrackErrors;
using Bound = TrackingBounds;
using Key = KeyframeStoreSettings;
using Spec = SpecularSettings;

// In the order of run.json.
constexpr std::array kRows = {
    number<&Map::voxel_m>("map.voxel_m", "m", 1e-4, 1, "Edge of a voxel of the surface."),
    number<&Map::limit_blocks>("map.capacity_blocks", "blocks", 0, kAnyCount,
                               "The pool of blocks of 8 x 8 x 8 voxels does not grow beyond this; 0 sets no limit."),
    number<&Fuse::truncation_m>("fusion.truncation_m", "m", 0, kFar_m,
                                "Half width of the band around the surface in which distances are fused, at depth 0; "
                                "it is at least 3 voxels."),
    number<&Fuse::truncation_slope>("fusion.truncation_slope", "m/m", 0, 10,
                                    "The band's half width grows by this with every metre of depth."),
    number<&Fuse::max_depth_m>("fusion.max_depth_m", "m", 0, kFar_m, "Farther readings are not fused."),
    number<&Fuse::max_weight>("fusion.max_weight", "samples", 1, 4095,
                              "After this many samples a voxel's distance becomes a sliding average; small values suit "
                              "poses that drift.",
                              kOneRecording),
    number<&Fuse::max_color_weight>("fusion.max_color_weight", "samples", 1, 65535,
                                    "After this many samples a voxel's colour becomes a sliding average."),
    number<&Fuse::settled_color_every>("fusion.settled_color_every", "frames", 1, 64,
                                       "A block whose surface has settled takes colour once in this many frames."),
    choice<&Fuse::color>("fusion.color", "Fuses colours; without it the map holds the surface alone."),
    number<&Fuse::allocation_stride_px>(
        "fusion.allocation_stride_px", "px", 1, 64,
        "Every N-th pixel in x and y allocates blocks, others in every frame. In the first frame "
        "all do, and in pictures of few pixels more."),
    number<&Fuse::seed>("fusion.seed", "", 0, kAnyCount,
                        "Seed of the chance by which fused colours are rounded up or down."),
    number<&DepthFilter::sigma_px>("input.sigma_px", "px", 0.001, 1000,
                                   "Width over which depth is smoothed in the picture, as a standard deviation."),
    number<&DepthFilter::sigma_floor_m>("input.sigma_floor_m", "m", 1e-4, 10,
                                        "Least depth difference that is smoothed, as a standard deviation."),
    number<&DepthFilter::sigma_linear>("input.sigma_linear", "m/m", 0, 10,
                                       "The smoothed depth difference grows by this with every metre of depth."),
    number<&DepthFilter::sigma_quadratic>("input.sigma_quadratic", "1/m", 0, 10,
                                          "The smoothed depth difference grows by this times the squared depth."),
    number<&DepthJump::floor_m>("input.jump_floor_m", "m", 0, 10,
                                "Neighbouring pixels lie on one surface if their depths differ by at most this, plus "
                                "input.jump_relative times the depth."),
    number<&DepthJump::relative>("input.jump_relative", "m/m", 0, 10,
                                 "Part of the depth that is added to input.jump_floor_m."),
    number<&Rec::near_m>("view.near_m", "m", 0, kFar_m, "Surface nearer to a camera than this is not seen in views."),
    choice<&Rec::view_every_frame>("view.every_frame",
                                   "Casts the map into every depth frame, as a live view needs it."),
    number<&Rec::remove_every>("map.remove_every", "frames", 0, kAnyCount,
                               "Blocks without surface are removed once in this many frames; 0 keeps them."),
    number<&Rec::around_m>("map.around_m", "m", 1, kFar_m,
                           "What lies farther from the camera throws no shadow until it comes near again; and where it "
                           "is not in view, its blocks may leave the device."),
    number<&Rec::resident_blocks>("map.resident_blocks", "blocks", 0, kAnyCount,
                                  "While more blocks are in use, those that are far away leave the device for the "
                                  "host's memory, and come back before they are seen; 0 keeps all."),
    number<&Rec::host_mib>(
        "map.host_mib", "MiB", 0, kAnyCount,
        "Host memory for what left the device, compressed: voxel blocks, and half of it for observed "
        "voxels where there are any. What exceeds it goes to a temporary file (TMPDIR, else "
        "/var/tmp). 0 sets no limit."),
    number<&Map::capacity_blocks>("map.initial_blocks", "blocks", 1, kAnyCount,
                                  "Blocks that the pool has room for at first; it grows when needed."),
    number<&Map::max_chunk_bytes>("map.max_chunk_bytes", "bytes", 2048, 4294967296.0,
                                  "Largest buffer that holds a part of the pool of blocks."),
    number<&Seg::limit_labels>("segmentation.capacity_labels", "labels", 0, SegmentTable::kMaxCapacity,
                               "The table of labels does not grow beyond this; 0 sets no limit but 65535."),
    number<&Frame::min_pixels>("segmentation.min_pixels", "px", 1, kAnyCount,
                               "Smaller connected parts of a frame are no segments."),
    number<&Frame::stride_px>("segmentation.stride_px", "px", 1, 64,
                              "Segments are found at every N-th pixel in x and y.", kTwoScenes),
    number<&Edge::crease_degrees>("segmentation.crease_degrees", "degrees", 0, 180,
                                  "A concave crease separates segments if it turns the normal by more than this."),
    number<&Edge::crease_sigmas>("segmentation.crease_sigmas", "sigmas", 0, 1000,
                                 "This many times the angle's noise is added to segmentation.crease_degrees."),
    number<&Edge::jump_m>("segmentation.jump_m", "m", 0, 10,
                          "Neighbouring pixels are connected if their depths differ by at most this, plus what a "
                          "surface inclined by segmentation.steepest_degrees changes."),
    number<&Seg::inherit_share>("segmentation.inherit_share", "", 0, 1,
                                "Part of a segment's pixels that a label must cover to become the segment's."),
    number<&Seg::inherit_pixels>("segmentation.inherit_pixels", "px", 0, kAnyCount,
                                 "Pixels of a segment that a label must cover to become the segment's."),
    number<&Seg::new_pixels>("segmentation.new_pixels", "px", 0, kAnyCount,
                             "Smaller segments get no label of their own."),
    number<&Seg::merge_share>("segmentation.merge_share", "", 0, 1,
                              "Part of a segment's pixels that its second label must cover to count as the same "
                              "object as the first."),
    number<&Seg::merge_frames>("segmentation.merge_frames", "frames", 0, kAnyCount,
                               "Two labels are merged after they counted as one object in this many more frames than "
                               "as two."),
    number<&Seg::merge_chroma>("segmentation.merge_chroma", "", 0, 2,
                               "Labels whose mean chromaticities differ by more are not merged."),
    number<&Seg::merge_brightness>("segmentation.merge_brightness", "", 1, 1e6,
                                   "Labels whose diffuse albedos have a larger ratio of luminance are not merged."),
    number<&Seg::merge_ks>("segmentation.merge_ks", "", 0, 1,
                           "Labels whose specular albedos differ by more in any channel are not merged."),
    number<&Seg::merge_alpha>("segmentation.merge_alpha", "", 1, 1e6,
                              "Labels whose roughnesses have a larger ratio are not merged."),
    number<&Seg::split_chroma>(
        "segmentation.split_chroma", "", 0, 2,
        "A label is split when its colours are two whose chromaticities differ by at least this; "
        "0: never."),
    number<&Seg::prune_voxels>("segmentation.prune_voxels", "voxels", 0, kAnyCount,
                               "Labels with fewer voxels are given up when they are not seen."),
    number<&Seg::prune_frames>("segmentation.prune_frames", "frames", 0, kAnyCount,
                               "A small label is given up when it was not seen for this many frames."),
    choice<&Seg::given>("segmentation.given",
                        "Uses the frames' own labels instead of finding segments; patina run sets it by --labels."),
    number<&Seg::capacity_labels>("segmentation.initial_labels", "labels", 2, SegmentTable::kMaxCapacity,
                                  "Labels that the table has room for at first, label 0 included; it grows when "
                                  "needed."),
    number<&Frame::capacity>("segmentation.frame_segments", "segments", 1, gpu::kMaxFrameSegments,
                             "Segments that one frame can have; others are left out."),
    number<&DepthNoise::floor_m>("segmentation.noise_floor_m", "m", 0, 10,
                                 "Standard deviation of a depth reading at depth 0."),
    number<&DepthNoise::per_m>("segmentation.noise_per_m", "1/m", 0, 10,
                               "The standard deviation of a depth reading grows by this times the squared depth."),
    number<&Edge::steepest_degrees>("segmentation.steepest_degrees", "degrees", 0, 89,
                                    "Surface inclined by more than this counts as a jump of depth."),
    number<&Edge::reach_m>("segmentation.reach_m", "m", 0, 10,
                           "Normals come from pixels this far apart on a surface seen head-on."),
    number<&Edge::min_reach_px>("segmentation.min_reach_px", "px", 1, 1000,
                                "Normals come from pixels at least this far apart."),
    number<&Edge::max_reach_px>("segmentation.max_reach_px", "px", 1, 1000,
                                "Normals come from pixels at most this far apart."),
    number<&Edge::step_m>("segmentation.step_m", "m", 0, 10,
                          "A step between parallel surfaces separates segments if it is higher than this."),
    number<&Edge::step_sigmas>("segmentation.step_sigmas", "sigmas", 0, 1000,
                               "This many times the depth's noise is added to segmentation.step_m.", kTwoScenes),
    number<&Edge::cut_chroma>("segmentation.cut_chroma", "", 0, 10,
                              "A change of chromaticity separates segments if it is larger than this."),
    number<&Edge::cut_light>("segmentation.cut_light", "", 0, 10,
                             "This over the brightness is added to segmentation.cut_chroma, as dark colours have more "
                             "noise."),
    number<&Edge::claim_m>("segmentation.claim_m", "m", 0, 10,
                           "A pixel at an edge joins a segment whose tangent plane is nearer than this."),
    number<&Edge::claim_sigmas>("segmentation.claim_sigmas", "sigmas", 0, 1000,
                                "This many times the depth's noise is added to segmentation.claim_m."),
    number<&Edge::claim_reach_px>("segmentation.claim_reach_px", "px", 0, 1000,
                                  "A pixel at an edge joins a segment that is at most this far away in x or y."),
    number<&Edge::color_reach_px>("segmentation.color_reach_px", "px", 0, 1000,
                                  "Colours are compared this far on both sides of a pixel."),
    number<&Fold::strong_chroma>("segmentation.strong_chroma", "", 0, 10,
                                 "Parts are joined across a crease only if both colours are farther from grey than "
                                 "this."),
    number<&Fold::same_hue_degrees>("segmentation.same_hue_degrees", "degrees", 0, 90,
                                    "Parts are joined across a crease only if their hues differ by at most this.",
                                    kOneScene),
    number<&Fold::same_saturation>("segmentation.same_saturation", "", 0, 10,
                                   "Parts are joined across a crease only if their distances from grey differ by at "
                                   "most this."),
    number<&Fold::least_weight>("segmentation.least_weight", "px", 0, kManyPixels,
                                "Parts are joined across a crease only if its pixels times the squared distance from "
                                "grey are more than this."),
    number<&Seg::sample_every>("segmentation.sample_every", "frames", 0, kAnyCount,
                               "The records that stand for a segment are chosen anew once in this many frames; 0 "
                               "never chooses any."),
    number<&Seg::sample_observations>(
        "segmentation.sample_observations", "", 0, 30,
        "Records with fewer observations stand for a segment only where there are too few others."),
    number<&Seg::sample_seed>("segmentation.sample_seed", "", 0, kAnyCount,
                              "Seed of the choice of records that stand for a segment."),
    number<&Gain::reduction>("gains.reduction", "px", 1, 64,
                             "Frame and map are compared at every N-th pixel of the colour picture in x and y."),
    number<&Gain::max_angle_degrees>(
        "gains.max_angle_degrees", "degrees", 0, 90,
        "Surface is not compared if its normal is turned away from the camera by more than "
        "this.",
        kTriedOnOne),
    number<&Gain::min_samples>("gains.min_samples", "px", 1, 1e9,
                               "With fewer pixels to compare, a channel keeps the gain of the frame before.",
                               kTriedOnOne),
    number<&Gain::leak>("gains.leak", "1/frame", 0, 1,
                        "Part of each gain's logarithm that is lost per frame, so that errors are forgotten.",
                        kTriedOnOne),
    number<&Refl::voxel_m>("reflectance.voxel_m", "m", 0, 4,
                           "Edge of an observed voxel: 4 or 2 times map.voxel_m; 0: whichever is nearer to 0.02."),
    number<&Refl::limit_blocks>("reflectance.capacity_blocks", "blocks", 0, kAnyCount,
                                "The pool of observed blocks does not grow beyond this; 0 sets no limit."),
    number<&Refl::reclaim_every>("reflectance.reclaim_every", "frames", 0, kAnyCount,
                                 "After this many frames, when segments choose their records anew, a quarter of the "
                                 "observed voxels is checked for surface that went; 0 keeps all."),
    number<&Refl::limit_records>("reflectance.capacity_records", "records", 0, kAnyCount,
                                 "The pool of observed voxels does not grow beyond this; 0 sets no limit."),
    number<&Refl::resident_records>("reflectance.resident_records", "records", 0, kAnyCount,
                                    "While more observed voxels are in use, those that are far away leave the device "
                                    "for the host's memory (map.host_mib), and come back before they are seen; 0 keeps "
                                    "all."),
    choice<&Refl::detail>("reflectance.detail",
                          "Pictures show detail that is finer than the observed voxels, restored from the fused "
                          "colour."),
    choice<&Refine::shadows>("reflectance.shadows",
                             "Finds which lights reach a surface; without it every light reaches every surface."),
    number<&Refine::first_marched_records>("reflectance.first_marched_records", "records", 1, kAnyCount,
                                           "About this many new records a frame have their shadows found."),
    number<&Refine::marched_records>("reflectance.marched_records", "records", 1, kAnyCount,
                                     "About this many records a frame whose surface moved have their shadows found "
                                     "again."),
    number<&Refine::refreshed_records>("reflectance.refreshed_records", "records", 1, kAnyCount,
                                       "About this many other records a frame are computed again in turn."),
    number<&Refine::gathered_rays>(
        "reflectance.gathered_rays", "rays", 0, 12,
        "Rays of each observed voxel whose shadows are found, by which it gathers the light "
        "that walls and things around it send it, 8 times as many at the end; 0: lamps and the "
        "ambient term are all."),
    number<&Refl::mirrored_rays>("reflectance.mirrored_rays", "rays", 0, 256,
                                 "Rays of a glossy pixel by which pictures mirror what is around, of a specular albedo "
                                 "of 0.5 or more; of others in "
                                 "proportion; 0: gloss shows the mean of it."),
    number<&Refl::capacity_blocks>("reflectance.initial_blocks", "blocks", 1, kAnyCount,
                                   "Observed blocks that the pool has room for at first; it grows when needed."),
    number<&Refl::capacity_records>("reflectance.initial_records", "records", 1, kAnyCount,
                                    "Observed voxels that the pool has room for at first; it grows when needed."),
    number<&Refl::capacity_labels>("reflectance.initial_labels", "labels", 1, SegmentMaterials::kMaxCapacity,
                                   "Materials that the table has room for, where no segments are found; else it is as "
                                   "large as the table of labels."),
    choice<&Refine::albedo>("reflectance.albedo", "Estimates albedo; without it only shadows are found."),
    number<&Obs::stride_px>(
        "observe.stride_px", "px", 1, 64,
        "Every N-th pixel in x and y observes, others in every frame. In the first frame all do, and in "
        "pictures of few pixels more."),
    number<&Obs::max_distance_m>("observe.max_distance_m", "m", 0, kFar_m, "Farther surface is not observed."),
    number<&Obs::max_angle_degrees>("observe.max_angle_degrees", "degrees", 0, 90,
                                    "Surface is not observed if its normal is turned away from the camera by more than "
                                    "this."),
    number<&Obs::depth_tolerance_m>("observe.depth_tolerance_m", "m", 0, 1,
                                    "A reading this far from the fused surface is still an observation of it."),
    number<&Obs::edge_margin_px>("observe.edge_margin_px", "px", 0, 16,
                                 "Pixels this near to an edge of the depth picture do not observe."),
    number<&Obs::max_blur_px>("observe.max_blur_px", "px", 0, kManyPixels,
                              "Pixels that motion smears by more than this do not observe.", kOneRecording),
    number<&Obs::smeared_observations>("observe.smeared_observations", "observations", 0, 30,
                                       "Voxels with fewer observations take smeared ones, too."),
    number<&Obs::rest_px>("observe.rest_px", "px", 0, kManyPixels,
                          "Where the picture moved by less than this since the frame before, a quarter of the pixels "
                          "observe."),
    number<&Obs::depth_tolerance_per_m2>("observe.depth_tolerance_per_m2", "1/m", 0, 1,
                                         "This times the squared depth is added to observe.depth_tolerance_m."),
    number<&Obs::merge_angle_degrees>("observe.merge_angle_degrees", "degrees", 0, 90,
                                      "Samples of a voxel from directions this near to each other are averaged."),
    number<&Track::levels>("tracking.levels", "", 1, 6,
                           "Levels of the picture pyramids, the camera's own pixels included."),
    number<&Track::finest>("tracking.finest", "", 0, 5,
                           "Finest level that is compared, below tracking.levels; 0 is the camera's own pixels."),
    number<&Track::iterations>("tracking.iterations", "", 1, 50, "Iterations on each level but the finest."),
    number<&Track::finest_iterations>("tracking.finest_iterations", "", 1, 50, "Iterations on the finest level."),
    choice<&Track::photometric>("tracking.photometric", "Compares brightness too, where the map has colours."),
    choice<&Track::hide_highlights>("tracking.hide_highlights",
                                    "Leaves brightness out at highlights, where materials are known."),
    number<&Track::damping>("tracking.damping", "", 0, 1,
                            "Part of the last motion that is expected to go on; 0 expects the camera to rest."),
    number<&Err::noise_floor_m>("tracking.noise_floor_m", "m", 1e-4, 10,
                                "Standard deviation of a depth reading at depth 0, errors of the map included."),
    number<&Err::noise_per_m>("tracking.noise_per_m", "1/m", 0, 10,
                              "The standard deviation of a depth reading grows by this times the squared depth."),
    number<&Err::robust_sigmas>("tracking.robust_sigmas", "sigmas", 0.001, 1e6,
                                "A pair this far apart has a quarter of its weight, on the finest level."),
    number<&Err::gate_m>("tracking.gate_m", "m", 1e-4, kFar_m,
                         "Frame and map are not compared where they are farther apart than this, on the finest level "
                         "and at depth 0."),
    number<&Err::gate_slope>("tracking.gate_slope", "m/m", 0, 10,
                             "The largest distance that is compared grows by this with every metre of depth."),
    number<&Err::shade_sigma>("tracking.shade_sigma", "", 0, 1000,
                              "Standard deviation of a difference of brightness, which runs from 0 to 1; 0 compares "
                              "none."),
    number<&Err::robust_shade>("tracking.robust_shade", "", 1e-4, 1000,
                               "A difference of brightness this large has a quarter of its weight."),
    number<&Bound::least_pairs>("tracking.least_pairs", "px", 0, kAnyCount,
                                "A frame is lost if fewer pixels of the finest level lie on the map."),
    number<&Bound::weak_share>("tracking.weak_share", "", 0, 1,
                               "A frame is weak if a smaller part of its readings lies on the map."),
    number<&Bound::lost_share>("tracking.lost_share", "", 0, 1,
                               "A frame is lost if a smaller part of its readings lies on the map."),
    number<&Bound::weak_sigmas>("tracking.weak_sigmas", "sigmas", 0, 1e6,
                                "A frame is weak if its readings are farther from the map, as a root mean square."),
    number<&Bound::lost_sigmas>("tracking.lost_sigmas", "sigmas", 0, 1e6,
                                "A frame is lost if its readings are farther from the map, as a root mean square."),
    number<&Bound::held_share>("tracking.held_share", "", 0, 1,
                               "A direction of motion that the surface fixes less than this makes a frame weak, and "
                               "the pose is held in it."),
    number<&Bound::weak_step_m>("tracking.weak_step_m", "m", 0, kFar_m,
                                "A frame is weak if the last iteration still moved it by more than this."),
    number<&Bound::weak_step_degrees>("tracking.weak_step_degrees", "degrees", 0, 360,
                                      "A frame is weak if the last iteration still turned it by more than this."),
    number<&Bound::jump_share>("tracking.jump_share", "", 0, 1,
                               "Part of a frame's readings that must lie on the map to be found again after a loss."),
    number<&Bound::lost_motion_m>("tracking.lost_motion_m", "m", 0, kFar_m,
                                  "A frame is lost if it is farther from where it was expected."),
    number<&Bound::lost_motion_degrees>("tracking.lost_motion_degrees", "degrees", 0, 360,
                                        "A frame is lost if it is turned by more from how it was expected."),
    number<&Key::capacity>("keyframes.capacity", "keyframes", 1, KeyframeStore::kMaxCapacity,
                           "Keyframes that can be kept; further ones are refused and counted."),
    number<&Key::seed>("keyframes.seed", "", 0, kAnyCount, "Seed of the pixels that keyframes are compared at."),
    number<&Key::least_depth_m>("keyframes.least_depth_m", "m", 0.001, kFar_m,
                                "Least depth that separates keyframes, below keyframes.most_depth_m."),
    number<&Key::most_depth_m>("keyframes.most_depth_m", "m", 0.001, kFar_m, "Largest depth that separates keyframes."),
    number<&Key::least_dissimilarity>("keyframes.least_dissimilarity", "", 0, 1,
                                      "A frame becomes a keyframe if it differs from all others by more than this."),
    number<&Key::near_m>("keyframes.near_m", "m", 0, kFar_m,
                         "A frame also becomes a keyframe if no other one is this near."),
    number<&Key::near_degrees>("keyframes.near_degrees", "degrees", 0, 180,
                               "A keyframe that is turned by more than this is not near."),
    number<&KeyframeSettings::candidates>("keyframes.candidates", "keyframes", 1, gpu::kMostMatches,
                                          "A lost camera is looked for at the poses of this many keyframes."),
    choice<&KeyframeSettings::tests>("keyframes.tests",
                                     "Compares colour and depth (all), or depth alone (depth), which patina run sets "
                                     "where it estimates gains."),
    number<&Spec::segments_per_frame>("specular.segments_per_frame", "segments", 1, kAnyCount,
                                      "Materials of at most this many segments are estimated in a frame."),
    number<&Spec::memory>("specular.memory", "", 0, 0.999,
                          "Part of a segment's earlier fits that is kept when it is fitted again."),
    number<&Spec::seed>("specular.seed", "", 0, kAnyCount, "Seed of the choice of voxels that the network is shown."),
    choice<&Spec::fit>("specular.fit", "Fits Ward's model to the observations; patina run sets it by --specular."),
    number<&Rec::seed>("random.seed", "", 0, kLargestSeed,
                       "Changes all other seeds; 0 leaves them. patina run sets it by --seed, which also changes the "
                       "noise of synthetic scenes."),
};

// What follows notices a field without a row.

struct AnyField {
    template <class Field>
    operator Field() const;
};

/// The number of fields of an aggregate: the most values that it can be made from.
template <class Part, class... Fields>
consteval size_t field_count(Fields... fields) {
    if constexpr (requires { Part{Fields{}..., AnyField{}}; })
        return field_count<Part>(fields..., AnyField{});
    else
        return sizeof...(Fields);
}

template <class Part>
consteval size_t row_count() {
    size_t rows = 0;
    for (const SettingRow& row : kRows)
        if (row.owner == owner_name<Part>()) ++rows;
    return rows;
}

/// Whether all fields of a struct have a row, but for `structs` that hold settings of their own.
template <class Part>
consteval bool is_covered(size_t structs = 0) {
    return field_count<Part>() == row_count<Part>() + structs;
}

static_assert(is_covered<VoxelMapSettings>());
static_assert(is_covered<FusionSettings>());
static_assert(is_covered<InputSettings>(2));
static_assert(is_covered<DepthFilter>());
static_assert(is_covered<DepthJump>());
static_assert(is_covered<SegmentationSettings>(1));
static_assert(is_covered<SegmentSettings>(2));
static_assert(is_covered<EdgeSettings>(1));
static_assert(is_covered<DepthNoise>());
static_assert(is_covered<FoldSettings>());
static_assert(is_covered<GainSettings>());
static_assert(is_covered<ReflectanceStageSettings>(2));
static_assert(is_covered<ReflectanceSettings>());
static_assert(is_covered<ObservationSettings>());
static_assert(is_covered<TrackingSettings>(2));
static_assert(is_covered<TrackErrors>());
static_assert(is_covered<TrackingBounds>());
static_assert(is_covered<KeyframeSettings>(1));
static_assert(is_covered<KeyframeStoreSettings>());
static_assert(is_covered<SpecularSettings>());

/// field_count() does not see through std::optional. A network is a file, given by --network, and has no row.
[[maybe_unused]] void notice_fields(const ReconstructionSettings& settings) {
    const auto& [map, fusion, input, near_m, remove_every, around_m, resident_blocks, host_mib, gains, reflectance,
                 segmentation, specular, network, tracking, keyframes, seed, view_every_frame] = settings;
    static_assert(row_count<ReconstructionSettings>() == 7,
                  "near_m, remove_every, around_m, resident_blocks, host_mib, seed and view_every_frame");
    (void)map;
}

}  // namespace

std::span<const SettingRow> setting_rows() { return kRows; }

}  // namespace patina
