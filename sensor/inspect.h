#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/source.h"

namespace patina::sensor {

/// What the depth pictures of the sampled frames hold.
struct DepthStatistics {
    double valid_share = 0;  ///< of all pixels; without any valid one the percentiles are 0
    double p5_m = 0;
    double median_m = 0;
    double p95_m = 0;
};

/// What the colour pictures of the sampled frames hold.
struct ColorStatistics {
    bool linear = false;       ///< linear radiance, else sRGB codes of 0 to 255
    glm::dvec3 mean{0};        ///< RGB
    double clipped_share = 0;  ///< pixels with a channel at 255; 0 for linear pictures
};

/// A change between a frame and the one before, at its largest.
struct LargestStep {
    double value = 0;
    uint32_t frame = 0;  ///< the later of the two
};

struct PoseStatistics {
    uint32_t frames = 0;  ///< with a pose
    double path_length_m = 0;
    LargestStep translation_m;              ///< between neighbouring indices
    LargestStep rotation_deg;               ///< between neighbouring indices
    double worst_defect = 0;                ///< Frame::pose_defect
    glm::dvec3 first_m{0};                  ///< where the first camera with a pose stands
    std::optional<std::string> convention;  ///< PoseConventionCheck::complaint(), where it is on
};

/// How often something was seen, and where first.
struct Occurrences {
    uint32_t count = 0;
    uint32_t first_frame = 0;
};

/// What a sequence holds, and what about it is implausible.
struct SequenceReport {
    SequenceInfo info;
    uint32_t usable_frames = 0;
    std::vector<Skipped> skipped;
    double duration_s = 0;         ///< last timestamp minus first
    glm::dvec2 color_view_deg{0};  ///< horizontal and vertical field of view, distortion left aside
    glm::dvec2 depth_view_deg{0};
    uint32_t sampled_frames = 0;  ///< that the pixel statistics come from
    DepthStatistics depth;
    ColorStatistics color;
    PoseStatistics poses;
    Occurrences repeated_color;  ///< pictures equal to the one before
    Occurrences repeated_depth;
    Occurrences backward_timestamps;    ///< not later than the one before
    std::vector<std::string> warnings;  ///< one sentence each
};

/// Whether poses are held against the depth (PoseConventionCheck).
enum class ConventionCheck : bool { kOff, kOn };

/// Inspects readings as they come. Poses, timestamps and repetitions are taken from every frame, pixel statistics from
/// at most about 50 of info.frames, evenly spread.
class Inspector {
  public:
    explicit Inspector(const SequenceInfo& info, ConventionCheck convention = ConventionCheck::kOn);
    ~Inspector();
    Inspector(Inspector&&) noexcept;
    Inspector& operator=(Inspector&&) noexcept;

    void add(const Reading& reading);
    /// The last frame that was added; null before the first.
    const Frame* last() const;
    /// Of the readings so far.
    SequenceReport report() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Inspects a source to its end. Throws what the source throws.
SequenceReport inspect(Source& source);

/// The report for a person to read: lines of text, warnings last.
std::string format_report(const SequenceReport& report);

}  // namespace patina::sensor
