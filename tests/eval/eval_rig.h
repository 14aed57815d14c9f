#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"
#include "sensor/pose.h"
#include "sensor/truth.h"
#include "tests/export/temporary_folder.h"
#include "tools/eval/evaluate.h"

namespace patina::test {

/// All channels of a frame in truth/frames or a run's frames.
struct EvalFrame {
    Image<glm::vec3> kd, kd_segment, kd_shown, ks, rgb, rgb_segment, rgb_shown, normal;
    Image<float> alpha, depth, label, valid;
};

/// Writes a frame without the groups of channels named in `without`.
void write_frame(const std::filesystem::path& file, const EvalFrame& frame, const std::set<std::string>& without = {});

/// A small sequence of 40 frames at 30 Hz with exact truth, of which every tenth is in truth/frames, and a run that
/// repeats the truth, for tests to change. Object 1 ("floor") fills the picture below a background, object 2 ("box",
/// textured) covers part of it and is out of sight in frame 20, object 3 has less than 64 pixels.
class EvalRig {
  public:
    static constexpr Extent2D kExtent{48, 40};
    static constexpr uint32_t kEvery = 10;
    static constexpr uint32_t kFrames = 40;

    /// Writes sequence and run.
    EvalRig();

    std::filesystem::path sequence() const { return folder_ / "sequence"; }
    std::filesystem::path run() const { return folder_ / "run"; }
    std::filesystem::path run_frame(uint32_t index) const;

    /// The true frame as the run repeats it.
    static EvalFrame frame(uint32_t index);
    static std::vector<sensor::StampedPose> trajectory();
    static std::vector<Light> lights();

    /// Writes the run's frames anew, each changed by `change`, without some groups of channels.
    void change_frames(const std::function<void(EvalFrame&)>& change, const std::set<std::string>& without = {}) const;

    /// Over every pixel: there are no pictures whose surface could be counted.
    eval::Evaluation evaluate() const { return eval::evaluate(sequence(), run(), {.seen_frames = 1}); }

  private:
    TemporaryFolder folder_;
};

/// Calls change(pixel of picture) where the frame's label is `object`.
template <class Pixel, class Change>
void change_object(const EvalFrame& frame, float object, Image<Pixel>& picture, Change change) {
    for (size_t i = 0; i < picture.pixels().size(); ++i) {
        if (frame.label.pixels()[i] == object) change(picture.pixels()[i]);
    }
}

}  // namespace patina::test
