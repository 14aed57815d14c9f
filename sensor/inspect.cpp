#include "sensor/inspect.h"

#include <algorithm>
#include <cmath>

#include "sensor/plausibility.h"
#include "sensor/pose_convention.h"
#include "sensor/repeated.h"
#include "sensor/report_lines.h"

namespace patina::sensor {
namespace {

constexpr uint32_t kSampledFrames = 50;
constexpr uint32_t kLiveFrames = 1000;  // samples of a source without a known length spread over so many, and go on
/// Percentiles use every 7th valid reading: millions remain, and 7 shares no factor with the grids that registered
/// depth shows.
constexpr size_t kReadingStride = 7;

double quantile(std::vector<float>& values, double q) {
    if (values.empty()) return 0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// Gathers pixels of the sampled frames.
class PixelSampler {
  public:
    explicit PixelSampler(double metres_per_unit) : metres_per_unit_(metres_per_unit) {}

    void add(const Frame& frame) {
        ++frames_;
        std::visit([&](const auto& image) { add_depth(image); }, frame.depth);
        std::visit([&](const auto& image) { add_color(image); }, frame.color);
    }

    uint32_t frames() const { return frames_; }

    DepthStatistics depth() const {
        std::vector<float> depths_m = depths_m_;
        const double share = depth_pixels_ == 0 ? 0 : static_cast<double>(valid_) / static_cast<double>(depth_pixels_);
        return {share, quantile(depths_m, 0.05), quantile(depths_m, 0.5), quantile(depths_m, 0.95)};
    }

    ColorStatistics color() const {
        if (color_pixels_ == 0) return {};
        const auto count = static_cast<double>(color_pixels_);
        return {linear_, color_sum_ / count, static_cast<double>(clipped_) / count};
    }

  private:
    double metres(uint16_t units) const { return units * metres_per_unit_; }
    static double metres(float depth_m) { return depth_m; }

    template <class Unit>
    void add_depth(const Image<Unit>& image) {
        depth_pixels_ += image.pixels().size();
        for (const Unit reading : image.pixels()) {
            const double z = metres(reading);
            if (!(z > 0) || !std::isfinite(z)) continue;
            if (valid_++ % kReadingStride == 0) depths_m_.push_back(static_cast<float>(z));
        }
    }

    template <class Pixel>
    void add_color(const Image<Pixel>& image) {
        linear_ = std::is_same_v<Pixel, glm::vec3>;
        color_pixels_ += image.pixels().size();
        for (const Pixel& pixel : image.pixels()) {
            color_sum_ += glm::dvec3(pixel);
            if (!linear_ && (pixel.r == 255 || pixel.g == 255 || pixel.b == 255)) ++clipped_;
        }
    }

    double metres_per_unit_;
    uint32_t frames_ = 0;
    size_t depth_pixels_ = 0;
    size_t valid_ = 0;
    std::vector<float> depths_m_;
    bool linear_ = false;
    size_t color_pixels_ = 0;
    size_t clipped_ = 0;
    glm::dvec3 color_sum_{0};
};

void raise(LargestStep& largest, double value, uint32_t frame) {
    if (value > largest.value) largest = {value, frame};
}

void count(Occurrences& occurrences, uint32_t frame) {
    if (occurrences.count++ == 0) occurrences.first_frame = frame;
}

double rotation_between_deg(const RigidTransform& a, const RigidTransform& b) {
    const glm::dmat3 turn = glm::transpose(glm::dmat3(a)) * glm::dmat3(b);
    const double cosine = (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2;
    return glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
}

void add_pose(PoseStatistics& poses, const Frame& frame, const std::optional<Frame>& last) {
    if (!frame.world_from_camera) return;
    if (poses.frames++ == 0) poses.first_m = glm::dvec3((*frame.world_from_camera)[3]);
    poses.worst_defect = std::max(poses.worst_defect, frame.pose_defect);
    if (!last || !last->world_from_camera) return;
    const double step_m =
        glm::distance(glm::dvec3((*last->world_from_camera)[3]), glm::dvec3((*frame.world_from_camera)[3]));
    poses.path_length_m += step_m;
    if (frame.index != last->index + 1) return;  // a gap of skipped frames moves farther without being a jump
    raise(poses.translation_m, step_m, frame.index);
    raise(poses.rotation_deg, rotation_between_deg(*last->world_from_camera, *frame.world_from_camera), frame.index);
}

void compare_to_last(SequenceReport& report, const Frame& frame, const Frame& last) {
    if (same_pixels(last.color, frame.color)) count(report.repeated_color, frame.index);
    if (same_pixels(last.depth, frame.depth)) count(report.repeated_depth, frame.index);
    if (frame.timestamp_s <= last.timestamp_s) count(report.backward_timestamps, frame.index);
    report.duration_s += frame.timestamp_s - last.timestamp_s;
}

}  // namespace

struct Inspector::State {
    State(const SequenceInfo& info, ConventionCheck check)
        : pixels(info.metres_per_unit),
          sample_every(std::max(1u, (info.frames.value_or(kLiveFrames) + kSampledFrames - 1) / kSampledFrames)) {
        if (check == ConventionCheck::kOn) convention.emplace(info);
        report.info = info;
        report.color_view_deg = field_of_view_deg(info.color);
        report.depth_view_deg = field_of_view_deg(info.depth);
    }

    SequenceReport report;
    PixelSampler pixels;
    std::optional<PoseConventionCheck> convention;
    uint32_t sample_every;
    std::optional<Frame> last;
};

Inspector::Inspector(const SequenceInfo& info, ConventionCheck convention)
    : state_(std::make_unique<State>(info, convention)) {}
Inspector::~Inspector() = default;
Inspector::Inspector(Inspector&&) noexcept = default;
Inspector& Inspector::operator=(Inspector&&) noexcept = default;

void Inspector::add(const Reading& reading) {
    SequenceReport& report = state_->report;
    if (const auto* skipped = std::get_if<Skipped>(&reading)) {
        if (!skipped->dropped) report.skipped.push_back(*skipped);
        return;
    }
    const Frame& frame = std::get<Frame>(reading);
    if (report.usable_frames++ % state_->sample_every == 0) state_->pixels.add(frame);
    add_pose(report.poses, frame, state_->last);
    if (state_->convention) state_->convention->add(frame);
    if (state_->last) compare_to_last(report, frame, *state_->last);
    state_->last = frame;
}

const Frame* Inspector::last() const { return state_->last ? &*state_->last : nullptr; }

SequenceReport Inspector::report() const {
    SequenceReport report = state_->report;
    report.sampled_frames = state_->pixels.frames();
    report.depth = state_->pixels.depth();
    report.color = state_->pixels.color();
    if (state_->convention) report.poses.convention = state_->convention->complaint();
    report.warnings = implausibilities(report);
    return report;
}

SequenceReport inspect(Source& source) {
    Inspector inspector(source.info());
    while (const std::optional<Reading> reading = source.next()) inspector.add(*reading);
    return inspector.report();
}

}  // namespace patina::sensor
