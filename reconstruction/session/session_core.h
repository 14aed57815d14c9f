#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/vulkan/device.h"
#include "patina/session.h"
#include "reconstruction/pipeline.h"
#include "reconstruction/session/detail.h"
#include "reconstruction/session/find_lights.h"
#include "reconstruction/session/sequence_truth.h"
#include "reconstruction/session/surroundings.h"
#include "reconstruction/session/tracked_frame.h"
#include "reconstruction/store/map_file.h"
#include "reconstruction/store/state_files.h"
#include "sensor/inspect.h"
#include "sensor/ledger.h"

namespace patina {

struct SessionLight;

namespace scenes {
class SyntheticSource;
}

/// What a program keeps in a session's map beside the session's own state.
using MoreState = std::function<void(graph::StateVisitor& visitor, MapFile& map)>;

/// One sentence on a pool that could not grow: what it holds, how much, and what kept it from growing.
std::string full_pool_warning(const PoolState& pool);

/// What is behind a Session: a source with all that belongs to it, and the pipeline that its frames are fused into.
/// Every choice that the options leave open is decided by the constructor.
class SessionCore {
  public:
    /// Opens options.sequence where `source` is null, looks at its first frames, and finds the lights. A world far from
    /// its origin is moved there (world_offset_m). Before a source without a length, which does not wait, the device
    /// builds what it needs (warm_up). Throws Error for what cannot be read or met, Interrupted when the
    /// caller stops it. The device must outlive this.
    SessionCore(vulkan::Device& device, const SessionOptions& options, std::unique_ptr<Source> source = nullptr);

    /// Takes one reading from the source: fuses it, or notes why not. False at the source's end. Throws Interrupted
    /// when the caller stops it; the device has finished then.
    bool step();

    /// Writes the state to the map (SessionOptions::map) in place of the one before, whole or not at all. Waits. Throws
    /// Error where the file cannot be written, or there is to be none.
    void checkpoint(const MoreState& more = {});

    /// The same where there is a map and it is due: every checkpoint_every frames, and once the source has ended. A
    /// failure is a shortfall: the session goes on, and the state before stays in the map.
    void checkpoint_if_due(const MoreState& more = {});

    /// Why the last checkpoint that was due could not be written; empty where it was.
    const std::string& checkpoint_problem() const { return checkpoint_problem_; }

    /// Brings back what a program kept in the map beside the session's state; where the session went on from one.
    void bring_back(const MoreState& more);

    /// Keeps the model as it is now in `map`, in place of what that holds; for go_back() of this session alone. Waits.
    /// Throws Error where the file cannot be written.
    void keep_model(MapFile& map);

    /// Brings back a model that this session kept. The frames that were fused or held out since are forgotten and count
    /// as undone (sensor::Ledger); the source goes on with its next frame. A tracked camera is looked for in the
    /// model's keyframes; frames until it is found are lost. Without keyframes it is tracked from its last pose in the
    /// model. Throws Error where the map is damaged: nothing has changed then; or where memory runs out or the device
    /// was lost: the session is of no use then.
    void go_back(MapFile& map);

    /// Waits for the device. Throws Error when no frame could be used, or the source yielded another number of frames
    /// than it has.
    void end();

    /// Throws Error where no frame could be used so far.
    void expect_frames() const;

    /// Looks for light in all that the source showed; where it has ended, and once. A part of end().
    void look_for_last_light();

    /// The frame that the last step() fused, with its pose; null where it fused none.
    const Frame* fused() const { return fused_ ? &*fused_ : nullptr; }
    const std::optional<FrameResult>& last() const { return last_; }
    /// The frame of the last step() where it was held out (SessionOptions::hold_out), with its pose; else null.
    const Frame* held_out() const { return held_out_ ? &*held_out_ : nullptr; }

    /// How many frames were held out and count: without those that were undone.
    size_t held_out_frames() const { return held_out_indices_.size(); }

    /// Throws Interrupted when the caller stops it; the device has finished then.
    void stop_if_interrupted();

    Pipeline& pipeline() { return *pipeline_; }
    vulkan::Device& device() { return device_; }
    const SessionOptions& options() const { return options_; }
    const SequenceInfo& info() const { return info_; }  ///< its frames: those that are to be fused
    const DetailChoice& detail() const { return detail_; }
    const ReconstructionSettings& settings() const { return pipeline_->settings(); }
    const Illumination& illumination() const { return illumination_; }  ///< the lights, and how they were found
    Lighting lighting() const;                                          ///< the same, in the scene's world
    /// Why materials are not all that they could be, and what to give; empty where nothing is missing.
    std::string materials_missing() const;
    /// What the search for lights, or what was asked of materials without any, fell short of.
    const std::vector<std::string>& shortfalls() const { return shortfalls_; }
    /// What is implausible about the frames that were read (sensor::inspect), and what the settings leave out of them.
    std::vector<std::string> warnings() const;
    /// What was taken from all positions, metres: those of poses(), illumination() and the reconstruction lack it.
    glm::dvec3 world_offset_m() const { return world_offset_m_; }
    const SequenceTruth& truth() const { return *truth_; }
    const sensor::Ledger& ledger() const { return ledger_; }
    const std::vector<TimedPose>& poses() const { return poses_; }  ///< of the depth camera, in frames that were fused
    std::vector<TimedPose> world_poses() const;                     ///< the same in the recording's world
    /// The colour gains of the frames that were fused, as lines "index red green blue"; complete after end().
    std::string gains_text();
    /// How full the pools are, and what keeps them from growing; waits. Of a device that was lost what the host knows.
    std::vector<PoolState> pools();
    /// Says that surfaces are left out that fusion.max_depth_m and the sequence would have, where that or the voxel was
    /// asked for.
    std::optional<std::string> reach_warning() const;
    /// How each frame that was read was tracked; empty where poses are given.
    const std::vector<TrackedFrame>& tracked() const { return tracked_; }

    /// Surface, materials, lights and trajectory of what was fused so far; waits.
    Scene scene();
    /// The same in steps, so that a failure of one costs no other, and memory need not hold the surface: what does not
    /// depend on it, and the segments. Pipeline::give_surface has the surface.
    Scene scene_without_surface() const;
    void add_segments(Scene& scene);

  private:
    bool tracks() const { return settings().tracking.has_value(); }
    void open(std::unique_ptr<Source> given, const std::optional<glm::dvec3>& world_offset_m);
    void open_map();
    std::shared_ptr<MapFile> earlier_map() const;
    void extend(MapFile& earlier);
    void resume();
    void visit(graph::StateVisitor& visitor);
    void skip_readings();
    void forget_empty_map();
    void mark_ended();
    void take_light(SessionLight light);
    void start_pipeline(std::optional<NetworkDescription> network);
    void fuse(Frame frame);
    bool looks_for_light() const;
    bool is_light_assumed() const;
    std::optional<glm::dvec3> see_brightness(const Frame& frame);
    void assume_light(glm::dvec3 ambient);
    void look_for_light();
    bool is_unseen_light_due() const;
    void look_for_ambient_light();
    bool knows_brightness() const;
    bool shows_enough(const std::vector<gpu::LightSample>& drawn) const;
    std::optional<glm::dvec3> ambient_told_by(const std::vector<gpu::LightSample>& drawn);
    void look_for_unseen_light();
    void hold_out(Frame frame);
    bool add(RgbdFrame& rgbd, Frame& frame);
    void skip(uint32_t index, std::string reason);
    std::optional<std::string> repeats_last(const Reading& reading) const;
    void repeat(uint32_t index, std::string reason);
    void report_progress();
    std::vector<std::string> segment_names() const;

    vulkan::Device& device_;  // outlives the source, which may compute on it
    SessionOptions options_;
    std::unique_ptr<Source> source_;
    scenes::SyntheticSource* scene_ = nullptr;  ///< the source, where it is one
    std::shared_ptr<MapFile> map_;              ///< null until there is something in it
    bool made_map_ = false;                     ///< there was no file
    std::optional<uint32_t> kept_after_;  ///< frames read when the state in it was; empty: it is another session's
    std::string checkpoint_problem_;
    bool ended_ = false;        ///< the source has
    bool looked_last_ = false;  ///< look_for_last_light() has
    DetailChoice detail_;
    std::optional<SequenceTruth> truth_;
    SequenceInfo info_;
    glm::dvec3 world_offset_m_{0};
    Illumination illumination_;
    std::optional<SurroundingsSeen> seen_;  ///< of a camera, while nothing else tells what is around
    std::string no_light_because_;
    std::vector<std::string> shortfalls_;
    std::optional<sensor::Inspector> inspector_;  ///< empty for a synthetic scene
    std::optional<Pipeline> pipeline_;
    sensor::Ledger ledger_;
    std::optional<Frame> fused_, held_out_;
    std::optional<FrameResult> last_;
    std::vector<TimedPose> poses_;
    std::vector<TrackedFrame> tracked_;
    std::optional<RigidTransform> first_given_;  ///< of the first frame that has a pose
    std::vector<uint32_t> used_;                 ///< indices of the frames that were fused
    std::vector<uint32_t> held_out_indices_;     ///< and of those that were held out
    std::vector<uint32_t> repeated_;             ///< and of those that repeat the one before
    std::vector<uint32_t> undone_indices_;       ///< of used and held out ones, those that go_back() forgot
    std::set<std::string> full_pools_;           ///< those that were reported
    std::string stream_problem_;                 ///< Pipeline::stream_problem(), the first that was reported
};

}  // namespace patina
