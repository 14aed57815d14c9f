// How well surfaces are known: what was observed of the records around each point.

#include "passes/shading/sample_coverage.h"

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/shading/shading_rig.h"
#include "tests/reference/shading/sample_coverage.h"

namespace patina::sample_coverage_test {
namespace {

const RigidTransform kPose{1.0};
constexpr double kWallM = 1.003;

class SampleCoverage : public GpuTest {
  protected:
    const reference::DistanceField wall_ = reference::half_space({0, 0, -1}, -kWallM);

    ShadingRig rig(uint32_t times) {
        ShadingRig rig(device(), runner(), 0.02f);
        for (uint32_t i = 0; i < times; ++i) {
            RigidTransform pose = kPose;
            pose[3].x = 0.05 * i;  // from elsewhere, so that it is another observation
            rig.see(wall_, pose);
        }
        return rig;
    }
};

TEST_F(SampleCoverage, AnEvenlyKnownWallHasItsCertaintyAndWhatIsNotSeenHasNone) {
    ShadingRig rig = this->rig(1);
    rig.paint([](const RecordPlace&) {
        reference::ShadedRecord record;
        record.certainty = {0.75, 0.5, 1};
        return record;
    });
    const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
    size_t hits = 0;
    for (size_t i = 0; i < view.coverage.pixels().size(); ++i) {
        const glm::vec4 got = view.coverage.pixels()[i];
        if (view.position_m.pixels()[i].w == 0) {
            EXPECT_EQ(got, glm::vec4(0));
            continue;
        }
        EXPECT_EQ(got.a, 1);
        if (got.r == 0) continue;  // beside what was observed
        ASSERT_NEAR(got.g, 0.5, 2e-3) << "10 bits, then a half float";
        ASSERT_LE(got.r, 1);
        hits += got.r > 0.999f;  // records at the border were not observed, and lower the mean
    }
    EXPECT_GT(hits, view.coverage.pixels().size() / 2);
}

TEST_F(SampleCoverage, AgreesWithTheReference) {
    ShadingRig rig = this->rig(3);
    std::map<std::array<int, 3>, reference::Coverage> records;
    rig.paint([&](const RecordPlace& place) {
        reference::ShadedRecord record;
        record.certainty = glm::dvec3(place.voxel[0] % 2 == 0 ? 0.25 : 0.75);
        records[place.voxel] = {static_cast<double>(place.observations), record.certainty.r};
        return record;
    });
    const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
    uint32_t most = 0;
    size_t compared = 0;
    for (size_t i = 0; i < view.coverage.pixels().size(); i += 7) {
        const glm::vec4 point = view.position_m.pixels()[i], got = view.coverage.pixels()[i];
        if (point.w == 0) continue;
        const reference::Coverage expected = reference::sample_coverage(records, 0.02, glm::dvec3(point));
        // Half floats round at 2^-11; where shares are small, the position's own rounding decides which records count.
        ASSERT_NEAR(got.r, expected.observations, 0.02) << i;
        ASSERT_NEAR(got.g, expected.certainty, 4e-3) << i;
        most = std::max(most, static_cast<uint32_t>(expected.observations));
        ++compared;
    }
    EXPECT_GT(compared, 100u);
    EXPECT_GE(most, 2u) << "several observations are told apart from one";
}

}  // namespace
}  // namespace patina::sample_coverage_test
