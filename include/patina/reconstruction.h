#pragma once

#include <cstdint>
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
        Image<glm::vec4> kd;                               ///< diffuse albedo; a = 1 where it is known
        Image<glm::vec4> ks_alpha;                         ///< of the segment
        Image<uint32_t> label;                             ///< 0: none
        Image<glm::vec4> rgb;                              ///< linear re-rendering; a = 1 where kd is known
        Image<glm::vec4> light;                            ///< what kd multiplies in rgb; a: the part shadows leave
        std::vector<std::optional<glm::vec3>> segment_kd;  ///< by label: the mean albedo of the whole segment
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
struct ReconstructionStatistics {
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

/// Fuses RGB-D frames into a volume with materials, and extracts the scene from it. Frames are submitted without waiting
/// for the device, two in flight. One thread. Whoever has a source rather than frames uses Session.
class Reconstruction {
  public:
    /// Poses are tracked where `settings` has any setting of tracking, else each frame brings its own. Without light
    /// there is no reflectance. Throws Error for settings that cannot be met, or lack of memory. The device must outlive
    /// this.
    explicit Reconstruction(Device& device, const Settings& settings = {}, const Lighting& lighting = {});
    ~Reconstruction();
    Reconstruction(const Reconstruction&) = delete;
    Reconstruction& operator=(const Reconstruction&) = delete;

    /// Fuses a frame; the first one places the volume around its camera. Its pixels are not needed afterwards. Throws
    /// Error when a picture is not its camera's size, or the device was lost.
    FrameResult add(const RgbdFrame& frame);

    /// Casts the model into a pinhole camera (lens distortion is left out). Ready two frames later, or after wait().
    PendingView view(const Intrinsics& camera, const RigidTransform& world_from_camera);

    /// Fuses what waits to be, and waits for the device.
    void wait();

    /// Counters as of at most two frames ago; exact after wait(). Does not wait.
    ReconstructionStatistics statistics();

    /// The scene of what was fused so far: surface, materials, lights; waits. Frames may be added after it.
    Scene finish();

  private:
    friend struct Access;
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace patina
