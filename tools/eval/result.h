#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "patina/camera.h"
#include "patina/image.h"
#include "sensor/truth.h"
#include "tools/eval/frame_states.h"

namespace patina::eval {

/// What Table 1 of the paper compares, in its order, where "before" is before the albedo refinement; then the albedo
/// and the picture that a user is shown, with restored detail and fused colour.
enum class Quantity : uint8_t { kKdBefore, kKd, kKs, kAlpha, kRgbBefore, kRgb, kKdShown, kRgbShown };

inline constexpr std::array kQuantities = {Quantity::kKdBefore, Quantity::kKd,        Quantity::kKs,
                                           Quantity::kAlpha,    Quantity::kRgbBefore, Quantity::kRgb,
                                           Quantity::kKdShown,  Quantity::kRgbShown};

/// One value per quantity.
template <class Value>
class PerQuantity {
  public:
    Value& operator[](Quantity quantity) { return values_[static_cast<size_t>(quantity)]; }
    const Value& operator[](Quantity quantity) const { return values_[static_cast<size_t>(quantity)]; }

  private:
    std::array<Value, kQuantities.size()> values_{};
};

/// The name of a quantity in text and JSON: "kd_before", "kd", "ks", "alpha", "rgb_before", "rgb", "kd_shown",
/// "rgb_shown".
const char* name_of(Quantity quantity);

/// 1 for alpha, 3 for the others.
int channels_of(Quantity quantity);

/// The metrics of one comparison, over pixels and channels.
struct Scores {
    double mad = 0;                        ///< mean absolute deviation; the paper's L1
    double rmse = 0;                       ///< root mean square error; the paper's L2
    double psnr_db = 0;                    ///< for a range of 1; infinite where nothing differs
    double ssim = 0;                       ///< structural similarity, for a range of 1
    std::optional<double> psnr_srgb_db{};  ///< as psnr_db, of sRGB-encoded values; for RGB alone
};

/// Which of an object's pixels scores are over.
enum class Pixels : uint8_t {
    kAll,     ///< all that truth shows; where the run has no value, it counts as 0
    kFilled,  ///< of these, those where the run has a value
    kSeen     ///< of these, those whose surface the sequence's depth camera had seen in enough frames by then
};

inline constexpr std::array kPixels = {Pixels::kAll, Pixels::kFilled, Pixels::kSeen};

/// "all", "filled", "seen".
const char* name_of(Pixels pixels);

/// An object's scores for one quantity: in one frame, averaged over frames, or averaged over objects.
struct Comparison {
    double coverage = 0;           ///< filled pixels / all of the object
    Scores all;                    ///< Pixels::kAll
    std::optional<Scores> filled;  ///< Pixels::kFilled; empty where there is none
    std::optional<Scores> seen;    ///< Pixels::kSeen; likewise

    /// Null where there is no such pixel.
    const Scores* over(Pixels pixels) const;
};

/// What an average is over.
enum class Period : uint8_t {
    kAllFrames,  ///< that show the object
    kLastFrames  ///< the last tenth of them: what the estimate came to
};

/// One point of the plots over time (paper, Figures 4 and 5). Scalars fill all three channels of the means.
struct FramePoint {
    uint32_t frame = 0;
    glm::dvec3 truth_mean{0};            ///< over the object's pixels
    std::optional<glm::dvec3> run_mean;  ///< over the filled ones; empty where there is none
    Comparison comparison;               ///< Figure 5's L1 error is comparison.all.mad
};

/// Averages over both periods.
struct Averages {
    Comparison mean;    ///< Period::kAllFrames
    Comparison at_end;  ///< Period::kLastFrames

    const Comparison& over(Period period) const { return period == Period::kAllFrames ? mean : at_end; }
};

/// One object, one quantity.
struct ObjectQuantity : Averages {
    std::vector<FramePoint> frames;  ///< in time; frames that see less than kSmallestRegion of the object are gaps
};

/// How the run's labels cut up one object; all pixels of all frames pooled.
struct ObjectSegmentation {
    std::optional<uint32_t>
        best_label;               ///< of the run, largest overlap by IoU; empty where no label touches the object
    double iou = 0;               ///< intersection over union of the object and its best label
    double best_label_share = 0;  ///< of the object's pixels that carry its best label
    uint32_t labels = 0;          ///< over-segmentation: run labels on at least 5 % of the object's pixels
    double foreign_share = 0;     ///< under-segmentation: of the best label's pixels, how many lie on other objects
};

/// How many true values lie within intervals: three channels an albedo, one an alpha.
struct IntervalHits {
    uint32_t within = 0;
    uint32_t values = 0;
    double width = 0;  ///< sum over the values

    /// Only where there are values.
    double mean_width() const { return width / values; }
};

/// The same of each quantity, for intervals of one probability.
struct IntervalCounts {
    double probability = 0;
    IntervalHits kd, ks, alpha;
};

/// Whether an object's true material lies in the intervals of its segment.
struct ObjectIntervals {
    std::optional<double> confidence;    ///< that the run has in ks and alpha
    std::vector<IntervalCounts> levels;  ///< by rising probability
};

struct ObjectResult {
    uint32_t id = 0;
    std::string name;                                       ///< from materials.json, else "object ID"
    uint64_t pixels = 0;                                    ///< over all evaluated frames
    uint64_t seen_pixels = 0;                               ///< of these, those that had been seen often enough
    PerQuantity<std::optional<ObjectQuantity>> quantities;  ///< empty where the run lacks the quantity, or no frame
                                                            ///< sees enough of the object
    std::optional<ObjectSegmentation> segmentation;         ///< empty where the run has no labels
    std::optional<ObjectIntervals> intervals{};             ///< empty where no segment is the object's, or has any
};

/// Averages over the objects.
struct SegmentationResult {
    double iou = 0;
    double best_label_share = 0;
    double labels = 0;
    double foreign_share = 0;
};

/// Spread of an error over all pixels valid in both, of all frames.
struct PixelErrors {
    uint64_t pixels = 0;
    double coverage = 0;  ///< pixels / those that are valid in truth
    double median = 0;
    double mean = 0;  ///< of the absolute error
    double p90 = 0;   ///< 90 % of the pixels have at most this
    double rmse = 0;
};

/// Relative pose error: motion over a fixed step, compared between truth and run.
struct RelativePoseError {
    size_t pairs = 0;
    double step_s = 0;  ///< mean time between the poses of a pair
    double translation_rmse_m = 0;
    double translation_median_m = 0;
    double translation_max_m = 0;
    double rotation_rmse_deg = 0;
    double rotation_median_deg = 0;
    double rotation_max_deg = 0;
};

struct TrajectoryErrors {
    size_t truth_poses = 0;
    size_t run_poses = 0;
    size_t poses = 0;       ///< of the run that have a true one at their time
    double ate_rmse_m = 0;  ///< absolute trajectory error after rigid alignment
    double ate_max_m = 0;   ///< likewise
    double unaligned_rmse_m = 0;
    std::optional<RelativePoseError> per_frame;   ///< empty with less than two poses
    std::optional<RelativePoseError> per_second;  ///< empty where the trajectory is shorter than a second
};

/// A true light and the light of the run that stands for it.
struct LightMatch {
    size_t truth = 0;  ///< index into LightErrors::truth
    size_t run = 0;    ///< index into LightErrors::run
    double position_error_m = 0;
    glm::dvec3 intensity_error{0};               ///< |run - truth| / truth per channel
    glm::dvec3 intensity_error_after_factor{0};  ///< likewise, the run's intensity divided by the common factor
};

struct LightErrors {
    double radius_m = 0;  ///< farther apart, two lights are not matched
    std::vector<Light> truth;
    std::vector<Light> run;           ///< in truth's world
    std::vector<LightMatch> matches;  ///< in the order of `truth`
    std::vector<size_t> missed;       ///< indices into `truth`
    std::vector<size_t> invented;     ///< indices into `run`
    double common_factor = 1;         ///< run / truth: geometric mean over the matches and channels; 1 without any
};

/// What was measured of pictures that no part of the sequence has. Pixels::kSeen are as Pixels::kFilled.
struct Views {
    std::vector<uint32_t> frames;  ///< the views that truth and pictures have in common
    std::vector<ObjectResult> objects;
    PerQuantity<std::optional<Averages>> object_means;
    std::optional<PixelErrors> depth_mm;
    std::optional<PixelErrors> normal_deg;
};

/// Everything measured. What the run or the sequence does not have is empty.
struct Evaluation {
    std::string sequence;  ///< folder, as given
    std::string run;       ///< folder, as given
    Extent2D extent;
    std::vector<uint32_t> frames;  ///< evaluated: those that truth/frames and the run's frames have in common
    size_t truth_frames = 0;
    size_t run_frames = 0;
    uint32_t seen_frames = 1;  ///< Pixels::kSeen are those whose surface had been seen in so many frames by then
    double seen_share = 1;     ///< of the objects' pixels, those
    std::vector<ObjectResult> objects;                  ///< by id; those that truth shows in some frame
    PerQuantity<std::optional<Averages>> object_means;  ///< over the objects that have the quantity
    std::optional<PixelErrors> depth_mm;
    std::optional<PixelErrors> normal_deg;
    std::optional<SegmentationResult> segmentation;
    std::vector<IntervalCounts> intervals;  ///< over the objects; empty where none has any
    std::optional<TrajectoryErrors> trajectory;
    std::string no_trajectory;          ///< why there is none, in a sentence; empty where there is one
    std::optional<FrameStates> states;  ///< of the run's tracking; empty where its poses were given
    std::optional<LightErrors> lights;
    std::optional<Views> finished;  ///< the finished model in the views of `frames`
    std::optional<Views> novel;     ///< re-renderings of views that were never recorded: truth/novel
    std::optional<Views> relit;     ///< the same under lamps that never shone: truth/relit
    std::string no_views;           ///< why there are none, in a sentence; empty where the sequence has none
};

/// An object is left out of frames that show fewer pixels of it; and of the scores of those that were seen, where those
/// are fewer.
inline constexpr size_t kSmallestRegion = 64;

/// Period::kLastFrames: of the frames that show an object, one in so many, rounded up.
inline constexpr size_t kLastShare = 10;

/// With fewer common poses no rotation follows from positions, and the trajectories are not compared.
inline constexpr size_t kFewestPoses = 3;

/// What an infinite PSNR counts in a mean of finite ones.
inline constexpr double kPsnrCap_db = 100;

/// A run label counts towards over-segmentation from this share of the object's pixels on.
inline constexpr double kLabelShare = 0.05;

}  // namespace patina::eval
