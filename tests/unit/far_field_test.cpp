// What arrives from far away, of sums by direction.

#include "reconstruction/far_field.h"

#include <vector>

#include <gtest/gtest.h>

namespace patina::far_field_test {
namespace {

gpu::SurroundingsSums sums_of(glm::vec3 radiance, uint32_t samples) {
    const glm::uvec3 steps(radiance * float(samples) * gpu::kSurroundingsSteps + 0.5f);
    return {samples, steps.r, steps.g, steps.b};
}

class FarField : public testing::Test {
  protected:
    /// Of the texel in column 3 and row 5.
    glm::vec4 texel() const { return far_field_of(sky_, openings_).at(3, 5); }
    gpu::FarFieldTexel& sky() { return sky_[5 * gpu::kFarFieldEdge + 3]; }
    gpu::SurroundingsLight& opening(uint32_t x, uint32_t y) {
        return openings_[(10 + y) * gpu::kOpeningEdge + 6 + x].light;
    }

    std::vector<gpu::FarFieldTexel> sky_{gpu::kFarFieldTexels};
    std::vector<gpu::OpeningTexel> openings_{gpu::kOpeningTexels};
};

TEST_F(FarField, NobodyLookedNothingIsKnown) { EXPECT_EQ(texel().a, 0.0f); }

TEST_F(FarField, ASkyIsTheMeanOfItsPixels) {
    sky().sums = {1024, 2048, 512, 4};
    EXPECT_EQ(texel(), glm::vec4(0.25f, 0.5f, 0.125f, 1));
}

TEST_F(FarField, AWindowIsAsBrightAsLowExposureShowsIt) {
    sky().sums = {4096, 4096, 4096, 4};
    opening(0, 0) = {.usual = sums_of(glm::vec3(0.95f), 8), .low = sums_of({3, 4, 6}, 4)};
    EXPECT_EQ(texel(), glm::vec4(3, 4, 6, 1));
    opening(0, 0).usual = sums_of(glm::vec3(0.5f), 8);
    EXPECT_EQ(texel(), glm::vec4(0.5f, 0.5f, 0.5f, 1)) << "the usual exposure shows it well";
    opening(0, 0).usual = {};
    EXPECT_EQ(texel(), glm::vec4(3, 4, 6, 1));
}

TEST_F(FarField, WindowsAreFinerAndKnownInPart) {
    opening(0, 0).low = sums_of(glm::vec3(2), 4);
    opening(1, 1).low = sums_of(glm::vec3(4), 400);
    opening(0, 1).low = sums_of(glm::vec3(9), gpu::kLeastSurroundingsSamples - 1);
    EXPECT_EQ(texel(), glm::vec4(3, 3, 3, 1)) << "each direction counts alike; two pixels may be noise";
}

}  // namespace
}  // namespace patina::far_field_test
