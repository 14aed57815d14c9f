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

/// What Table 1 of the paper compares, in its order; "before" is before the albedo refinement.
enum class Quantity : uint8_t { kKdBefore, kKd, kKs, kAlpha, kRgbBefore, kRgb };

inline constexpr std::array kQuantities = {Quantity::kKdBefore, Quantity::kKd,        Quantity::kKs,
                                           Quantity::kAlpha,    Quantity::kRgbBefore, Quantity::kRgb};

/// One value per quantity.
template <class Value>
class PerQuantity {
  public:
    Value& operator[](Quantity quantity) { return values_[static_cast<size_t>(quantity)]; }
    const Value& operator[](Quantity quantity) const { return values_[static_cast<size_t>(quantity)]; }

  private:
    std::array<Value, kQuantities.size()> values_{};
};

/// The name of a quantity in text and JSON: "kd_before", "kd", "ks", "alpha", "rgb_before", "rgb".
const char* name_of(Quantity quantity);

/// 1 for alpha, 3 for the others.
int channels_of(Quantity quantity);

/// The metrics of one comparison, over pixels and channels.
struct Scores {
    double mad = 0;      ///< mean absolute deviation; the paper's L1
    double rmse = 0;     ///< root mean square error; the paper's L2
    double psnr_db = 0;  ///< for a range of 1; infinite where nothing differs
    double ssim = 0;     ///< structural similarity, for a range of 1
};

/// An object's scores for one quantity: in one frame, averaged over frames, or averaged over objects.
struct Comparison {
    double coverage = 0;           ///< filled pixels / region, which is what is scored of the object
    std::optional<Scores> filled;  ///< over the filled pixels; empty where there is none
    Scores unfilled_as_zero;       ///< over the region, unfilled pixels being 0
};

/// One point of the plots over time (paper, Figures 4 and 5). Scalars fill all three channels of the means.
struct FramePoint {
    uint32_t frame = 0;
    glm::dvec3 truth_mean{0};            ///< over the region
    std::optional<glm::dvec3> run_mean;  ///< over the filled pixels; empty where there is none
    Comparison comparison;               ///< Figure 5's L1 error is comparison.filled->mad
};

/// One object, one quantity.
struct ObjectQuantity {
    Comparison mean;                 ///< averaged over `frames`; filled over those frames that have it
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

struct ObjectResult {
    uint32_t id = 0;
    std::string name;                                       ///< from materials.json, else "object ID"
    uint64_t pixels = 0;                                    ///< of its region, over all evaluated frames
    PerQuantity<std::optional<ObjectQuantity>> quantities;  ///< empty where the run lacks the quantity, or no frame
                                                            ///< sees enough of the object
    std::optional<ObjectSegmentation> segmentation;         ///< empty where the run has no labels
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

/// Everything measured. What the run or the sequence does not have is empty.
struct Evaluation {
    std::string sequence;  ///< folder, as given
    std::string run;       ///< folder, as given
    Extent2D extent;
    std::vector<uint32_t> frames;  ///< evaluated: those that truth/frames and the run's frames have in common
    size_t truth_frames = 0;
    size_t run_frames = 0;
    uint32_t seen_frames = 1;  ///< regions hold the pixels whose surface had been seen in so many frames by then
    double seen_share = 1;     ///< of the objects' pixels, those
    std::vector<ObjectResult> objects;                    ///< by id; those that truth shows in some frame
    PerQuantity<std::optional<Comparison>> object_means;  ///< over the objects that have the quantity
    std::optional<PixelErrors> depth_mm;
    std::optional<PixelErrors> normal_deg;
    std::optional<SegmentationResult> segmentation;
    std::optional<TrajectoryErrors> trajectory;
    std::string no_trajectory;          ///< why there is none, in a sentence; empty where there is one
    std::optional<FrameStates> states;  ///< of the run's tracking; empty where its poses were given
    std::optional<LightErrors> lights;
};

/// An object is left out of frames in which its region has fewer pixels.
inline constexpr size_t kSmallestRegion = 64;

/// With fewer common poses no rotation follows from positions, and the trajectories are not compared.
inline constexpr size_t kFewestPoses = 3;

/// What an infinite PSNR counts in a mean of finite ones.
inline constexpr double kPsnrCap_db = 100;

/// A run label counts towards over-segmentation from this share of the object's pixels on.
inline constexpr double kLabelShare = 0.05;

}  // namespace patina::eval
