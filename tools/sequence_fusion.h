#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/vulkan/device.h"
#include "passes/reconstruction.h"
#include "sensor/inspect.h"
#include "sensor/ledger.h"
#include "sensor/source.h"
#include "sensor/synthetic/synthetic_source.h"
#include "tools/export/tracking_record.h"
#include "tools/export/trajectory.h"
#include "tools/held_out.h"
#include "tools/interrupt.h"
#include "tools/lights.h"
#include "tools/run_truth.h"

namespace patina::tools {

/// Whether each frame's colours are brought to the first one's exposure and white balance.
enum class GainMode {
    kAuto,  ///< where the recording does not tell the exposure
    kOn,
    kOff
};

/// Where the frames' poses come from.
enum class PoseMode {
    kAuto,   ///< given where the sequence has any, else tracked
    kGiven,  ///< by the sequence
    kTrack,  ///< by tracking; of given ones the first alone is used
    kPrior   ///< by tracking that starts from the given motion from frame to frame
};

/// What a sequence is reconstructed with.
struct SequenceOptions {
    std::string sequence;  ///< folder of a recording, or "synthetic:SCENE"
    std::string format;    ///< of the recording; empty: recognised
    uint32_t frames = 0;   ///< at most so many frames of the sequence; 0 takes all (120 of a synthetic scene)
    bool quiet = false;
    std::filesystem::path lights;  ///< lights.json: with it reflectance is estimated too
    /// Where else lights are found: a sequence as find_lights takes it, in whose low-exposure frames they are; "self":
    /// in what they light in the main sequence; "none": no lights, and no reflectance. Empty: in the lighting sequence
    /// that the main sequence has, if it has one.
    std::string lighting;
    std::string labels = "geometry";  ///< segments: "off", "geometry", or "truth", those of the sequence's truth/labels
    /// What needs reflectance, such as "--show kd", for the message that there is none without lights; empty: nothing.
    std::string reflectance_for{};
    bool truth_materials = false;  ///< ks and alpha are those of truth/materials.json, by label
    /// How specular materials are estimated: "fit", "hemicnn", "both" or "off"; empty: both where there is a network.
    std::string specular;
    std::filesystem::path settings_file;  ///< that settings were read from; empty: none
    std::filesystem::path network;        ///< weights; empty: those that ship with the program
    GainMode gains = GainMode::kAuto;
    PoseMode poses = PoseMode::kAuto;
    /// Of everything that is drawn at random: ReconstructionSettings::seed, and of a synthetic scene noise and samples;
    /// empty: 0, and what the scene says.
    std::optional<uint64_t> seed{};
    uint32_t hold_out = 0;  ///< the colours of every so many-th frame are kept out of the model; 0: of none
    vulkan::DeviceOptions device;
    ReconstructionSettings settings;
};

/// One sentence on a pool that could not grow: what it holds, how much, and what kept it from growing.
std::string full_pool_warning(const PoolState& pool);

struct LightOfRun;

/// A sequence with all that belongs to it, and the reconstruction that its frames are fused into.
class SequenceFusion {
  public:
    /// Opens the sequence and looks at its first frames, finds the lights, chooses the device. A world far from its
    /// origin is moved there (world_offset_m). Throws Error for what cannot be read or met. The options and the guard
    /// must outlive this.
    SequenceFusion(const SequenceOptions& options, const InterruptGuard& interrupt);

    /// Fuses all frames, calls `after_frame` after each that was fused, and waits for the device. Throws Error when no
    /// frame could be used, Interrupted when the user stopped it; the device has finished then.
    void fuse_all(const std::function<void(const sensor::Frame&)>& after_frame);

    /// Throws Interrupted when the user stopped it; the device has finished then.
    void stop_if_interrupted();

    Reconstruction& reconstruction() { return *reconstruction_; }
    vulkan::Device& device() { return *device_; }
    const sensor::SequenceInfo& info() const { return info_; }  ///< its frames: those that are to be fused
    const ReconstructionSettings& settings() const { return reconstruction_->settings(); }
    const std::vector<PointLight>& lights() const { return lights_; }
    const Illumination& illumination() const { return illumination_; }  ///< the lights, and how they were found
    /// Why materials are not all that they could be, and what to give; empty where nothing is missing.
    const std::string& materials_missing() const { return materials_missing_; }
    /// What the search for lights, or what was asked of materials without any, fell short of.
    const std::vector<std::string>& shortfalls() const { return shortfalls_; }
    /// What is implausible about the frames that were read (sensor::inspect), and what the settings leave out of them.
    std::vector<std::string> warnings() const;
    /// What was taken from all positions, metres: those of poses(), lights() and the reconstruction lack it.
    glm::dvec3 world_offset_m() const { return world_offset_m_; }
    const RunTruth& truth() const { return *truth_; }
    const sensor::Ledger& ledger() const { return ledger_; }
    const std::vector<TimedPose>& poses() const { return poses_; }  ///< of the depth camera, in frames that were fused
    std::vector<TimedPose> world_poses() const;                     ///< the same in the recording's world
    /// The colour gains of the frames that were fused, as lines "index red green blue"; complete after fuse_all().
    std::string gains_text();
    const HeldOut& held_out() const { return held_out_; }
    uint32_t blocks_used();
    /// How full the pools are, and what keeps them from growing; waits. Of a device that was lost what the host knows.
    std::vector<PoolState> pools();
    /// Says that surfaces are left out that fusion.max_depth_m and the sequence would have, where that is so.
    std::optional<std::string> reach_warning() const;
    /// How each frame that was read was tracked; empty where poses are given.
    const std::vector<TrackedFrame>& tracked() const { return tracked_; }

  private:
    bool tracks() const { return settings().tracking.has_value(); }
    bool add(RgbdFrame& rgbd, sensor::Frame& frame);
    void take_light(LightOfRun light);
    void prepare_reflectance(ReflectanceModel& reflectance);
    void fuse(sensor::Frame& frame, const std::function<void(const sensor::Frame&)>& after_frame);

    const SequenceOptions& options_;
    const InterruptGuard& interrupt_;
    std::optional<vulkan::Device> device_;  // outlives the source, which may compute on it
    std::unique_ptr<sensor::Source> source_;
    std::optional<RunTruth> truth_;
    sensor::SequenceInfo info_;
    glm::dvec3 world_offset_m_{0};
    Illumination illumination_;
    std::vector<PointLight> lights_;
    std::string materials_missing_;
    std::vector<std::string> shortfalls_;
    std::optional<sensor::Inspector> inspector_;  ///< empty for a synthetic scene
    std::optional<Reconstruction> reconstruction_;
    sensor::Ledger ledger_;
    std::vector<TimedPose> poses_;
    std::vector<TrackedFrame> tracked_;
    std::optional<RigidTransform> first_given_;  ///< of the first frame that has a pose
    std::vector<uint32_t> used_;                 ///< indices of the frames that were fused
    HeldOut held_out_;
};

}  // namespace patina::tools
