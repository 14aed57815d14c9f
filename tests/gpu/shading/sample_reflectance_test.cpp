#include "passes/shading/sample_reflectance.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "passes/reflectance/average_segments.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/shading/shading_rig.h"
#include "tests/reference/scenes/analytic_scene.h"

namespace patina::sample_reflectance_test {

namespace {

using reference::ShadedRecord;

const RigidTransform kPose{1.0};
const glm::vec3 kTowardsCamera(0, 0, -1);
const float kWallM = 1.003f;

double off(glm::vec4 got, glm::dvec3 expected) {
    const glm::dvec3 d = glm::abs(glm::dvec3(got) - expected);
    return std::max({d.x, d.y, d.z});
}

class SampleReflectance : public GpuTest {
  protected:
    /// A wall seen from the front, and points on it.
    ShadingRig wall(float voxel_m = 0.02f) {
        ShadingRig rig(device(), runner(), voxel_m);
        rig.see(reference::half_space({0, 0, -1}, -kWallM), kPose);
        return rig;
    }
    static std::vector<glm::vec3> points_on_wall(size_t count) {
        std::mt19937 random(3);
        std::uniform_real_distribution<float> at(-0.25f, 0.25f);
        std::vector<glm::vec3> points(count);
        for (glm::vec3& point : points) point = {at(random), at(random), kWallM};
        return points;
    }
};

TEST_F(SampleReflectance, AKdThatVariesLinearlyDoesSoBetweenTheRecords) {
    const auto ramp = [](glm::dvec3 p) { return glm::dvec3(0.5 + 0.5 * p.x, 0.4 - 0.4 * p.y, 0.5 + 0.3 * p.x); };
    for (const float voxel_m : {0.02f, 0.01f}) {
        ShadingRig rig = wall(voxel_m);
        rig.paint([&](const RecordPlace& place) {
            ShadedRecord record;
            record.kd = ramp(place.point_m);
            record.label = 7;
            record.certainty =
                glm::dvec3(0.5);  // a variance of 0.05 squared, that about the segment's mean is 0.1 squared
            return record;
        });
        const glm::dvec3 mean(*kd_of(rig.average_segments()[7]));
        for (const size_t count : {1u, 64u, 65u, 1000u}) {
            const std::vector<glm::vec3> points = points_on_wall(count);
            const auto samples = rig.sample(points, std::vector<glm::vec3>(count, kTowardsCamera));
            ASSERT_EQ(samples.size(), count);
            for (size_t i = 0; i < count; ++i) {
                EXPECT_EQ(samples[i].kd.a, 1);
                EXPECT_EQ(samples[i].label, 7u);
                // A shared exponent keeps 9 bits of the records.
                const glm::dvec3 expected = 0.8 * ramp(glm::dvec3(points[i])) + 0.2 * mean;
                ASSERT_LT(off(samples[i].kd, expected), 1.5 / 1024) << i;
            }
        }
    }
}

TEST_F(SampleReflectance, TellsWhatRecordsKnowFromWhatTheirSegmentKnows) {
    ShadingRig rig = wall();
    const glm::dvec3 kd(0.25, 0.5, 0.75);
    rig.paint([&](const RecordPlace& place) {
        ShadedRecord record;
        record.kd = kd;
        record.label = place.voxel[0] < 0 ? 1 : 0;
        record.certainty = glm::dvec3(place.voxel[1] < 0 ? 0 : 1);
        return record;
    });
    const std::vector<glm::vec3> points{{-0.1f, 0.1f, kWallM}, {-0.1f, -0.1f, kWallM}, {0.1f, -0.1f, kWallM}};
    const auto samples = rig.sample(points, std::vector<glm::vec3>(3, kTowardsCamera));
    EXPECT_EQ(samples[0].kd.a, 1.0f);
    EXPECT_EQ(samples[1].kd.a, 0.5f) << "no record, but the segment";
    EXPECT_LT(off(samples[1].kd, kd), 2e-3);
    EXPECT_EQ(samples[1].label, 1u);
    EXPECT_EQ(samples[2].kd, glm::vec4(0)) << "neither";
    EXPECT_EQ(samples[2].label, 0u);
}

TEST_F(SampleReflectance, KnowsNothingFarFromTheSurfaceBehindItAndWithoutANormal) {
    ShadingRig rig = wall();
    rig.paint([](const RecordPlace&) { return ShadedRecord{.kd = glm::dvec3(0.5), .label = 1}; });
    const glm::vec3 on(0, 0, kWallM);
    const auto samples = rig.sample({on - glm::vec3(0, 0, 0.1f), {50, 0, 0}, on, on},
                                    {kTowardsCamera, kTowardsCamera, -kTowardsCamera, glm::vec3(0)});
    for (const auto& sample : samples) {
        EXPECT_EQ(sample.kd, glm::vec4(0));
        EXPECT_EQ(sample.label, 0u);
    }
}

TEST_F(SampleReflectance, AgreesWithTheReferenceOnRandomRecords) {
    const reference::DistanceField ball = reference::sphere({0.05, 0, 0.9}, 0.2);
    ShadingRig rig(device(), runner(), 0.02f);
    rig.see(ball, kPose);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> share(0, 1);
    rig.paint([&](const RecordPlace&) {
        ShadedRecord record;
        record.kd = {share(random), share(random), share(random)};
        record.label = random() % 3;
        record.certainty = random() % 3 == 0 ? glm::dvec3(0) : glm::dvec3(0.3 + 0.7 * share(random));
        if (random() % 3 == 0) record.around = {share(random), share(random), share(random)};
        return record;
    });
    std::vector<glm::vec3> points, normals;
    while (points.size() < 3000) {
        const glm::dvec3 direction(2 * share(random) - 1, 2 * share(random) - 1, -share(random));
        if (glm::length(direction) < 0.1) continue;
        normals.emplace_back(glm::normalize(direction));
        points.push_back(glm::vec3(0.05f, 0, 0.9f) + 0.2f * normals.back());
    }
    const auto samples = rig.sample(points, normals);
    const reference::ShadedScene scene = rig.scene();
    size_t same = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        const auto expected =
            reference::predict_radiance(scene, glm::dvec3(points[i]), glm::dvec3(normals[i]), glm::dvec3(0));
        same += (samples[i].kd.a > 0) == expected.known && samples[i].label == expected.label &&
                off(samples[i].kd, expected.kd) < 0.02;
    }
    // Surfaces are packed to 8 bits: where a record is barely another surface's, random neighbours differ.
    EXPECT_GE(static_cast<double>(same), 0.98 * static_cast<double>(points.size()));
}

}  // namespace
}  // namespace patina::sample_reflectance_test
