#include "passes/reflectance/average_segments.h"

#include <random>

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/shading/shading_rig.h"

namespace patina::average_segments_test {
namespace {

using reference::ShadedRecord;

class AverageSegments : public GpuTest {
  protected:
    AverageSegments() { rig_.see(reference::half_space({0, 0, -1}, -1.003), RigidTransform(1.0)); }

    ShadingRig rig_{device(), runner(), 0.02f};
};

TEST_F(AverageSegments, IsTheMeanOfWhatItsRecordsAreSureOf) {
    // Half of segment 1 is dark, half bright; what is uncertain may hold anything. Segment 2 knows nothing.
    size_t dark = 0, bright = 0, unknown = 0, observations = 0;
    rig_.paint([&](const RecordPlace& place) {
        ShadedRecord record;
        record.label = place.voxel[1] < 0 ? 1 : 2;
        record.kd = glm::dvec3(place.voxel[0] < 0 ? 0.25 : 0.75);
        if (record.label == 1) ++(place.voxel[0] < 0 ? dark : bright);
        if (record.label == 2) record.certainty = glm::dvec3(0);
        unknown += record.label == 2;
        if (record.label == 1) observations += place.observations;
        return record;
    });
    const auto sums = rig_.average_segments();
    EXPECT_EQ(sums[1].kd.w, dark + bright);
    EXPECT_EQ(sums[2].kd.w, unknown) << "all records count";
    EXPECT_GT(observations, 0u);
    EXPECT_EQ(sums[1].weight.w, observations);
    const auto kd = kd_of(sums[1]);
    ASSERT_TRUE(kd);
    const double expected = (0.25 * dark + 0.75 * bright) / (dark + bright);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR((*kd)[c], expected, 0.5 / gpu::kAlbedoSteps);
    EXPECT_FALSE(kd_of(sums[2]));
    EXPECT_EQ(sums[0].kd, glm::uvec4(0)) << "what has no label is no segment";
}

TEST_F(AverageSegments, AgreesWithTheReferenceAndWithItself) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0, 1);
    rig_.paint([&](const RecordPlace&) {
        ShadedRecord record;
        record.kd = {share(random), share(random), share(random)};
        record.certainty = {share(random), share(random), share(random)};
        record.label = random() % 5;
        return record;
    });
    const auto sums = rig_.average_segments(), again = rig_.average_segments();
    const auto expected = reference::average_segments(rig_.scene().records);
    ASSERT_EQ(expected.size(), 4u);
    for (uint32_t label = 0; label < sums.size(); ++label) {
        EXPECT_EQ(sums[label].kd, again[label].kd);
        const auto kd = kd_of(sums[label]);
        ASSERT_EQ(kd.has_value(), expected.contains(label)) << label;
        for (int c = 0; kd && c < 3; ++c) EXPECT_NEAR((*kd)[c], expected.at(label)[c], 2e-3) << label;
    }
}

}  // namespace
}  // namespace patina::average_segments_test
