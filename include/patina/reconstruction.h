#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/device.h"
#include "patina/frame.h"
#include "patina/lighting.h"
#include "patina/scene.h"
#include "patina/settings.h"

namespace patina {

/// How sure a frame's pose is. Only frames that track are fused.
enum class TrackingState : uint8_t { kTracking, kWeak, kLost };

/// What became of one frame.
struct FrameResult {
    bool fused = false;
    TrackingState state = TrackingState::kTracking;  ///< kTracking where poses are given
    std::string reason{};                            ///< why it was not fused, in a few words; empty where it was
    RigidTransform world_from_depth{1.0};            ///< of a lost frame: where it was expected
};

/// What a camera sees of the model; all pictures have its extent.
struct ModelView {
    Image<glm::vec4> position_m;  ///< world; w: depth along the optical axis, 0 where nothing was hit
    Image<glm::vec4> normal;      ///< world, unit length; 0 where nothing was hit
    Image<glm::vec4> color;       ///< linear; a = 0 where there is none
    Image<uint32_t> label{};      ///< segment of the map, 0: none; empty without segmentation

    /// What the model reflects, where it has reflectance (shading/predict_radiance.h).
    struct Reflectance {
        Image<glm::vec4> kd;         ///< diffuse albedo; a = 1 where it is known
        Image<glm::vec4> ks_alpha;   ///< of the segment
        Image<uint32_t> label;       ///< 0: none
        Image<glm::vec4> rgb;        ///< linear re-rendering; a = 1 where kd is known
        Image<glm::vec4> light;      ///< what kd multiplies in rgb; a: the part shadows leave
        Image<glm::vec4> model_kd;   ///< as kd, without detail of pictures or of the fused colour
        Image<glm::vec4> model_rgb;  ///< as rgb, of model_kd; nowhere what pictures saw
        /// By label: the albedo of the whole segment before refinement, as the fit or the network has it; of materials
        /// that are given, the mean of the segment's.
        std::vector<std::optional<glm::vec3>> segment_kd;
    };
    std::optional<Reflectance> reflectance{};
};

/// How full a pool of device memory is.
struct PoolUse {
    std::string name;
    uint64_t used = 0, capacity = 0;
    uint64_t refused = 0;  ///< requests that did not fit; what they asked for is left out
};

/// The time of one pass or of the host's part of a frame, over all frames so far.
struct PassTime {
    std::string name;
    uint64_t count = 0;
    double min_ms = 0, median_ms = 0, max_ms = 0;
};

/// How a reconstruction is doing.
struct Statistics {
    uint32_t frames = 0;  ///< that were fused
    uint32_t visible_blocks = 0;
    uint32_t segments = 0;
    std::vector<PoolUse> pools;
    std::vector<PassTime> passes;
};

/// A view on its way from the device.
class PendingView {
  public:
    PendingView(PendingView&&) noexcept;
    PendingView& operator=(PendingView&&) noexcept;
    ~PendingView();

    bool ready() const;
    /// Throws Error before it is ready.
    ModelView get() const;

  private:
    friend struct Access;
    struct State;
    explicit PendingView(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// Where segments come from.
enum class Labels {
    kGeometry,  ///< found
    kOff,       ///< there are none
    kTruth      ///< the sequence's own (truth/labels), or each frame's (RgbdFrame::labels)
};

/// Where the specular materials of segments come from.
enum class Materials {
    kAuto,     ///< kBoth where there is a network and a lamp, else kFit; without a lamp kOff
    kFit,      ///< Ward's model, fitted to the observations
    kNetwork,  ///< the network
    kBoth,     ///< the network where observations do not suffice
    kOff,      ///< all is diffuse
    kTruth     ///< truth/materials.json of the sequence, by label; for sessions alone
};

/// Where the frames' poses come from.
enum class Poses {
    kAuto,   ///< given where the source has any, else tracked
    kGiven,  ///< by the source
    kTrack,  ///< by tracking; of given ones the first alone is used
    kPrior   ///< by tracking that starts from the given motion from frame to frame
};

/// Whether each frame's colours are brought to the first one's exposure and white balance.
enum class Gains {
    kAuto,  ///< where the source does not know the exposure
    kOn,
    kOff
};

/// What a reconstruction is made with. The choices are a session's; what is left open is decided once, when it is made.
struct ReconstructionOptions {
    Lighting lighting{};                ///< without light there are geometry, colours and segments, but no materials
    Labels labels = Labels::kGeometry;  ///< kOff saves the time of segments; materials are diffuse alone then
    Materials materials = Materials::kAuto;
    Poses poses = Poses::kAuto;       ///< kAuto: given by each frame, unless a setting of tracking is set
    Gains gains = Gains::kAuto;       ///< kAuto: colours are taken as they are, unless a setting of gains is set
    std::filesystem::path network{};  ///< weights; empty: those that ship with Patina
    std::optional<uint64_t> seed{};   ///< of everything that is drawn at random; empty: the fixed ones
    Settings settings{};
};

/// Fuses RGB-D frames into a volume with materials, and extracts the scene from it. Frames are submitted without
/// waiting for the device, two in flight. One thread. Whoever has a source rather than frames uses Session.
class Reconstruction {
  public:
    /// With light, segments and their materials are found. Throws Error for choices or settings that cannot be met, a
    /// network that cannot be read, or lack of memory. The device must outlive this.
    explicit Reconstruction(Device& device, const ReconstructionOptions& options = {});
    ~Reconstruction();
    Reconstruction(const Reconstruction&) = delete;
    Reconstruction& operator=(const Reconstruction&) = delete;

    /// Whether frames' poses are tracked; else each frame brings its own.
    bool tracks() const;

    /// Fuses a frame; the first one places the volume around its camera. Its pixels are not needed afterwards. Throws
    /// Error when a picture is not its camera's size, a pose is not rigid, or the device was lost.
    FrameResult add(const RgbdFrame& frame);

    /// Casts the model into a pinhole camera (lens distortion is left out). Ready two frames later, or after wait().
    /// Throws Error for a camera without pixels or focal length, or a pose that is not rigid.
    PendingView view(const Intrinsics& camera, const RigidTransform& world_from_camera);

    /// Fuses what waits to be, and waits for the device.
    void wait();

    /// Counters as of at most two frames ago; exact after wait(). Does not wait.
    Statistics statistics();

    /// The scene of what was fused so far: surface, materials, lights; waits. Frames may be added after it.
    Scene finish();

  private:
    friend struct Access;
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace patina
