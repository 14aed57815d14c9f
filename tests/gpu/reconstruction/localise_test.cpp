#include "reconstruction/session/localise.h"

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/scenes/small_office.h"

namespace patina {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr uint32_t kFrames = 30;

/// Some frames of a sequence as one of their own.
class ChosenFrames : public Source {
  public:
    ChosenFrames(const SmallOffice& office, std::vector<uint32_t> indices, bool with_poses)
        : office_(office), info_(office.info), indices_(std::move(indices)) {
        info_.frames = static_cast<uint32_t>(indices_.size());
        info_.has_poses = with_poses;
    }

    const SequenceInfo& info() const override { return info_; }

    std::optional<Reading> next() override {
        if (next_ == info_.frames) return std::nullopt;
        Frame frame = office_.frames[indices_[next_]];
        frame.index = next_++;
        frame.timestamp_s = frame.index / info_.fps;
        if (!info_.has_poses) {
            frame.world_from_camera.reset();
            frame.color = Image<SrgbPixel>(info_.color.extent);  // so low an exposure that all is black
        }
        return frame;
    }

  private:
    const SmallOffice& office_;
    SequenceInfo info_;
    std::vector<uint32_t> indices_;
    uint32_t next_ = 0;
};

std::vector<uint32_t> from_to(uint32_t first, uint32_t last) {
    std::vector<uint32_t> indices{first};
    while (indices.back() != last) indices.push_back(first < last ? indices.back() + 1 : indices.back() - 1);
    return indices;
}

class Localise : public GpuTest {
  protected:
    static const SmallOffice& office() {
        static const SmallOffice frames(device(), kFrames);
        return frames;
    }

    static patina::LocaliseOptions options() {
        patina::LocaliseOptions options;
        options.settings.map.voxel_m = 0.02f;
        options.settings.map.capacity_blocks = 16384;
        options.settings.fusion.truncation_m = 0.06f;
        options.settings.tracking.emplace();
        options.settings.tracking->finest = 0;  // the pictures are small
        return options;
    }

    /// Where frames `indices` are found in the room of the first ten.
    static patina::FoundPoses found(const std::vector<uint32_t>& indices) {
        ChosenFrames main(office(), from_to(0, 9), true), dark(office(), indices, false);
        return patina::localise(device(), main, dark, options());
    }
};

TEST_F(Localise, ADarkSequenceIsFoundForwardsAndBackwardsFromWhatTheMainOneShows) {
    // Its first frames show what the main sequence does not; they are reached from the later ones.
    const std::vector<uint32_t> indices = from_to(16, 4);
    const patina::FoundPoses poses = found(indices);
    ASSERT_EQ(poses.size(), indices.size());
    for (size_t i = 0; i < poses.size(); ++i) {
        ASSERT_TRUE(poses[i]) << i;
        const PoseError error = pose_error(*poses[i], office().frames[indices[i]]);
        EXPECT_LT(error.translation_m, 0.02) << i;
        EXPECT_LT(error.rotation_degrees, 0.7) << i;
    }
    EXPECT_EQ(found(indices), poses);
}

TEST_F(Localise, WhatShowsAnotherPlaceIsNotFound) {
    EXPECT_THAT(
        [&] { found(from_to(26, 29)); },
        ThrowsMessage<Error>(HasSubstr("none of the 4 frames of 'office' was found in the main sequence's room")));
}

}  // namespace
}  // namespace patina
