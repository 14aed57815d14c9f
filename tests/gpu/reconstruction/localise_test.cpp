#include "reconstruction/session/localise.h"

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/scenes/small_office.h"

namespace patina::localise_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr uint32_t kFrames = 30;

/// Frames without poses, of so low an exposure that all is black.
class DarkFrames : public ChosenFrames {
  public:
    DarkFrames(const SmallOffice& office, std::vector<uint32_t> indices)
        : ChosenFrames(office, std::move(indices), false) {}

    std::optional<Reading> next() override {
        std::optional<Reading> reading = ChosenFrames::next();
        if (reading) std::get<Frame>(*reading).color = Image<SrgbPixel>(info().color.extent);
        return reading;
    }
};

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
        ChosenFrames main(office(), from_to(0, 9), true);
        DarkFrames dark(office(), indices);
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
}  // namespace patina::localise_test
