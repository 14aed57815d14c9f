#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "patina/device.h"
#include "patina/error.h"
#include "patina/frame.h"
#include "patina/lighting.h"
#include "patina/reconstruction.h"
#include "patina/scene.h"
#include "patina/settings.h"
#include "patina/source.h"

namespace patina {

/// Lights are looked for in the lighting sequence that the main sequence has (lighting/). Without one, what arrives
/// from around is gathered, and lamps and a sun are looked for in what they light while the session goes on.
struct LightsBeside {};
/// No light: geometry and colours alone.
struct NoLights {};
/// The lights of a lights.json.
struct LightsFromFile {
    std::filesystem::path file;
};
/// Lights are looked for in a sequence of low exposure (paper, Section 3.2), or in the lighting/ of one.
struct LightsFromSequence {
    std::string sequence;
    /// The sequence in whose world it is looked at; empty: the session's own. For a session over a source that plays a
    /// recording, which has no sequence.
    std::string main{};
};
/// Lights are looked for in what they light in the main sequence, which is read twice for that.
struct LightsFromMain {};

/// Where a session's lights come from.
using LightingChoice =
    std::variant<LightsBeside, NoLights, LightsFromFile, LightsFromSequence, LightsFromMain, Lighting>;

/// How fine the surface is that a session makes: voxels and the band around the surface in which readings are fused,
/// observed voxels, and how far readings are used. docs/guide/running.md has the values.
enum class Detail {
    kAuto,  ///< by the depth and picture size of a recording's first frames; of other sources kNormal; a map that is
            ///< gone on from keeps its own
    kFine,
    kNormal,
    kCoarse
};

/// How far a session is with one of its tasks.
struct SessionProgress {
    std::string_view task;          ///< "frames", "lamps", "lights"
    uint32_t done = 0;              ///< frames
    std::optional<uint32_t> total;  ///< empty: the source says when it ends
    std::string detail;             ///< a few words for a person
};

/// What a session calls while it works, on the thread that called it. Any may be empty.
struct SessionCallbacks {
    std::function<void(const SessionProgress&)> progress;
    std::function<void(const std::string&)> message;  ///< one line for a person
    std::function<bool()> stop;                       ///< whether to stop: the session throws Interrupted then
};

/// A program's own options for what sentences of a session ask for, such as "--lights FILE": they follow in brackets.
struct SessionHints {
    std::string lights;   ///< to give lights, or have them looked for
    std::string network;  ///< to give the network's weights
    std::string track;    ///< to have the camera tracked
    std::string resume;   ///< to go on from a map
};

/// What a session is made with. Whatever is left open is decided once, when it is made.
struct SessionOptions {
    std::string sequence;  ///< folder of a recording, or "synthetic:SCENE"; empty where a source is given
    std::string format;    ///< of the recording; empty: recognised
    uint32_t frames = 0;   ///< at most so many frames; 0 takes all (120 of a synthetic scene)
    LightingChoice lighting = LightsBeside{};
    /// Albedo of bright surfaces, above 0 and at most 1. It fixes how bright the light is where no lamp is known, or
    /// lamps are found in what they light: the recording itself tells the product of both.
    float white_albedo = 0.8f;
    Labels labels = Labels::kGeometry;
    Materials materials = Materials::kAuto;
    Poses poses = Poses::kAuto;
    Gains gains = Gains::kAuto;
    Detail detail = Detail::kAuto;  ///< settings that are given go before it
    std::filesystem::path network;  ///< weights; empty: those that ship with Patina
    /// Of everything that is drawn at random, of a synthetic scene noise and samples too; empty: the fixed ones.
    std::optional<uint64_t> seed;
    /// Every so many-th frame is kept out of the model: its colours, depth and labels; 0: none. With tracking, its pose
    /// is found. At least 2.
    uint32_t hold_out = 0;
    /// A file that keeps the session's state, a map: a session that was stopped or killed goes on from it, and what
    /// comes out is the same. Empty: none. One that holds a session which has come to its end is replaced.
    std::filesystem::path map;
    uint32_t checkpoint_every = 0;  ///< the state is written to the map every so many frames, and at the end; 0: by
                                    ///< Session::checkpoint() alone
    /// As `checkpoint_every`: at the end alone. A session that does not come to it leaves the file as it was.
    static constexpr uint32_t kAtEnd = UINT32_MAX;
    /// The map of another session, which this one begins from, such as one of the same room on another day: its model,
    /// its world and its lights (`lighting` is not used). Given poses must be in that world. A camera that is tracked
    /// is looked for in the map's keyframes; frames until it is found are lost. Options that the model depends on must
    /// be those of that session. The file is only read. Empty: none.
    std::filesystem::path extends;
    bool resume = false;  ///< goes on from the state in the map. All other options must be those that it was made with,
                          ///< but for lighting, which it holds. A source is read from its beginning again.
    /// What needs reflectance, such as "the viewer": without light that is an error that names it. Empty: nothing does.
    std::string reflectance_for;
    SessionHints hints;
    Settings settings;
    SessionCallbacks callbacks;
};

/// A reconstruction of all that a source yields.
class Session {
  public:
    /// Opens options.sequence, looks at its first frames, and finds the lights. Throws Error for what cannot be read or
    /// met, Interrupted where the caller stops it. The device must outlive this.
    Session(Device& device, const SessionOptions& options);

    /// The same with a source of one's own, such as a camera. Lights cannot be looked for in it before.
    Session(Device& device, std::unique_ptr<Source> source, const SessionOptions& options);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Takes one frame: fuses it, or notes why not (last()). False when the source has ended. Writes a checkpoint where
    /// one is due; one that fails is a shortfall. Throws Error when the
    /// device was lost, Interrupted where the caller stops it; what was fused so far is still there.
    bool step();

    /// Writes the state to SessionOptions::map, in place of the one before; whatever happens, one of the two is whole.
    /// Waits. Throws Error where no map was named, or it cannot be written.
    void checkpoint();

    /// What became of the last frame; empty before the first one.
    const std::optional<FrameResult>& last() const;

    const SequenceInfo& info() const;
    Lighting lighting() const;  ///< those in use, in the scene's world

    /// Casts the model into a camera, as Reconstruction::view() does, with the same errors.
    PendingView view(const Intrinsics& camera, const RigidTransform& world_from_camera);
    void wait();

    Statistics statistics();

    /// What the result falls short of so far: pools that are full, lights that were not found, frames that were not
    /// used; a sentence each.
    std::vector<std::string> shortfalls();

    /// The scene of what was fused so far; waits. Once the source has ended, light that nobody gave is looked for in
    /// all that it showed. Throws Error where no frame could be used.
    Scene finish();

  private:
    friend struct Access;
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace patina
