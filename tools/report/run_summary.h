#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "patina/reconstruction.h"
#include "patina/scene.h"
#include "patina/source.h"
#include "sensor/truth.h"
#include "tools/report/live_summary.h"
#include "tools/report/picture_score.h"
#include "tools/report/tracking_summary.h"

namespace patina {

/// The Vulkan device a run used.
struct DeviceSummary {
    std::string name;
    std::string type;            ///< "discrete", "integrated", "virtual", "software"
    std::string vulkan_version;  ///< "1.3.250"
    std::string driver;          ///< name and version
};

/// What became of the frames that were due: read is used plus skipped, dropped, repeated and undone.
struct FrameLedger {
    uint64_t read = 0;  ///< arrived from the source, skipped ones included
    uint64_t used = 0;  ///< fused into the model
    std::vector<Skipped> skipped;
    uint64_t dropped = 0;   ///< a live source had newer ones
    uint64_t repeated = 0;  ///< the same picture and depth as the one before, or the same time
    uint64_t undone = 0;    ///< fused, and forgotten again as the user asked
};

/// How full the pool of voxel blocks was at the end.
struct VoxelPoolSummary {
    uint64_t blocks_used = 0;
    uint64_t blocks_capacity = 0;
    uint64_t blocks_refused = 0;  ///< block requests that found the pool full
};

/// How full the pool of observed voxels was at the end.
struct ObservationPoolSummary {
    uint64_t records_used = 0;
    uint64_t records_capacity = 0;
    uint64_t records_refused = 0;  ///< voxels that found the pool full
    uint64_t blocks_refused = 0;   ///< blocks of voxels that found theirs full
};

/// One pool of device memory; `used` and `capacity` count its elements.
struct MemorySummary {
    std::string name;
    uint64_t bytes = 0;
    uint64_t used = 0;
    uint64_t capacity = 0;
};

/// Where values lie.
struct ValueRange {
    double min = 0, median = 0, max = 0;
};

/// What held-out pictures say of a finished model, in medians over them.
struct HeldOutSummary {
    size_t pictures = 0;
    PictureScore mean_color;                    ///< of the fused colour, as if it were painted on
    std::optional<PictureScore> reflectance{};  ///< of the re-rendering, where the model has reflectance
    /// The same after a gain per channel of each picture's own (gain_between()).
    PictureScore mean_color_own_gain{};
    std::optional<PictureScore> reflectance_own_gain{};
    std::optional<PictureScore> records{};  ///< of the re-rendering by records alone, without detail of pictures
};

/// A segment that the run told apart.
struct SegmentSummary {
    uint32_t id = 0;
    std::string name;
    SegmentReflectance reflectance;
};

/// Everything that run.json and report.html say about a finished run. Durations belong into `passes`, `times_s`
/// and `live` only: all the rest is equal between two runs of the same input on the same device.
struct RunSummary {
    std::string version;               ///< of Patina
    std::string id{};                  ///< of the run, run_id(); empty where it is not known yet
    bool finished = true;              ///< false: the run was stopped before its last frame
    std::string ended{};               ///< by what it was stopped, as "interrupted after 12 of 60 frames"
    std::vector<std::string> files{};  ///< all that the run wrote, itself too, by names relative to its folder
    DeviceSummary device;
    uint64_t seed = 0;
    nlohmann::ordered_json settings = nlohmann::ordered_json::object();  ///< as given and defaulted, in reading order
    nlohmann::ordered_json detail = nlohmann::ordered_json::object();    ///< the level, and why; empty: not told
    nlohmann::ordered_json lights = nlohmann::ordered_json::object();    ///< which there are, and how they were found
    SequenceInfo sequence;
    FrameLedger frames;
    VoxelPoolSummary voxel_pool;
    std::optional<ObservationPoolSummary> observation_pool{};  ///< empty without reflectance
    std::vector<MemorySummary> memory;
    std::vector<std::pair<std::string, uint64_t>> totals;  ///< counts of what was made, as {"triangles", 1200}
    std::optional<LiveSummary> live{};                     ///< of a live source; empty of a recording
    std::vector<TrackedFrame> tracking{};                  ///< each frame that was read; empty where poses were given
    std::vector<ValueRange> color_gains;     ///< of red, green and blue over the frames; empty where there are none
    std::optional<HeldOutSummary> held_out;  ///< empty where no picture was held out
    glm::dvec3 world_offset_m{0};  ///< of the scene's coordinates, to be added for those of the recording's world
    nlohmann::ordered_json gltf = nlohmann::ordered_json::object();  ///< how the world was put into scene.glb
    glm::dvec3 ambient{0};     ///< for report.html: irradiance over pi that every surface receives
    std::vector<Light> lamps;  ///< like the segments for report.html: they have files of their own
    std::vector<SegmentSummary> segments;
    std::string materials_missing;        ///< why materials are not all that they could be, and what to give
    std::vector<std::string> shortfalls;  ///< of what was asked for: the run ended with exit code 3
    std::vector<std::string> warnings;
    std::vector<PassTime> passes;                         ///< in the order of execution
    std::vector<std::pair<std::string, double>> times_s;  ///< wall times in seconds, as {"reading", 1.5}
};

/// The text of run.json: two-space indented JSON whose keys keep one order. All durations stand in the top-level
/// objects "passes", "times" and "live"; without these, the text is equal between two runs that did the same. Numbers
/// that are not finite become null; text that is not UTF-8 has its bad bytes replaced.
std::string run_json(const RunSummary& summary);

/// The run's id, 16 hexadecimal digits: of the summary without id, durations and memory, and of OutputFolder::digest()
/// of the files it wrote. Runs that did the same have the same id, others another.
std::string run_id(const RunSummary& summary, uint64_t files_digest);

}  // namespace patina
