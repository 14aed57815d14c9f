// Records whose reflectance is painted on the geometry: what a camera sees is what was painted, under the lights.

#include "tests/reference/shading/predict_radiance.h"

#include <algorithm>
#include <numbers>
#include <random>
#include <utility>

#include <glm/gtc/packing.hpp>

#include "shared/shading/predict_radiance.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/shading/shading_rig.h"

namespace patina::predict_radiance_test {
namespace {

using reference::ShadedRecord;
using reference::Ward;

constexpr double kWallM = 1.003;
constexpr double kHalf = 1.0 / 1024;  // rgba16f rounds at 2^-11; twice that for what was computed from it
constexpr uint64_t kAllLights = ~uint64_t{0};
const RigidTransform kPose{1.0};
const glm::dvec3 kAmbient(0.05, 0.04, 0.03);
const Light kLamp{{0.4f, -0.5f, 0.1f}, {1.5f, 1.0f, 0.8f}};

ShadedRecord painted(glm::dvec3 kd, uint32_t label = 0, uint64_t reached = kAllLights) {
    ShadedRecord record;
    record.kd = kd;
    record.label = label;
    record.reached = reached;
    return record;
}

double max_of(glm::dvec3 v) { return std::max({v.x, v.y, v.z}); }
double off(glm::vec4 got, glm::dvec3 expected) { return max_of(glm::abs(glm::dvec3(got) - expected)); }

class PredictRadiance : public GpuTest {
  protected:
    const reference::DistanceField wall_ = reference::half_space({0, 0, -1}, -kWallM);  // z = 1.003, free before it

    ShadingRig rig(const reference::DistanceField& field, float voxel_m = 0.02f,
                   const std::vector<RigidTransform>& poses = {kPose}) {
        ShadingRig rig(device(), runner(), voxel_m);
        for (const RigidTransform& pose : poses) rig.see(field, pose);
        rig.lights.set(std::vector{kLamp}, glm::dvec3(kAmbient));
        return rig;
    }

    /// Calls check(x, y, i) for each pixel that shows a surface, but for those within `margin` of the image's border:
    /// records beyond it may not have been seen.
    template <class Check>
    size_t for_each_hit(const ShadedView& view, uint32_t margin, const Check& check) {
        const Extent2D extent = view.kd.extent();
        size_t hits = 0;
        for (uint32_t y = margin; y + margin < extent.height; ++y) {
            for (uint32_t x = margin; x + margin < extent.width; ++x) {
                if (view.position_m.at(x, y).w == 0 || HasFailure()) continue;
                check(x, y);
                ++hits;
            }
        }
        return hits;
    }
};

TEST_F(PredictRadiance, AWallOfOneKdUnderALampIsEquation6) {
    for (const float voxel_m : {0.02f, 0.01f}) {
        ShadingRig rig = this->rig(wall_, voxel_m);
        const Ward gloss{{0.5, 0.25, 0.125}, glm::dvec3(0.125), 0.25};
        rig.materials.set(3, glm::vec3(gloss.ks), static_cast<float>(gloss.alpha));
        rig.paint([&](const RecordPlace&) { return painted(gloss.kd, 3); });
        const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
        double brightest = 0;
        const size_t hits = for_each_hit(view, 0, [&](uint32_t x, uint32_t y) {
            const glm::dvec3 point(view.position_m.at(x, y));
            // At the image's border the model has no normal: the records' does, which is kept with 8 bits.
            const bool known = view.normal.at(x, y) != glm::vec4(0);
            // Halves, which some devices cut off: its length is 1 only nearly.
            const glm::dvec3 normal = known ? glm::normalize(glm::dvec3(view.normal.at(x, y))) : glm::dvec3(0, 0, -1);
            const glm::dvec3 offset = glm::dvec3(kLamp.position_m) - point, to_light = glm::normalize(offset);
            const glm::dvec3 received =
                glm::dvec3(kLamp.intensity) * std::max(glm::dot(normal, to_light), 0.0) / glm::dot(offset, offset);
            const glm::dvec3 diffuse = gloss.kd * (kAmbient + received / std::numbers::pi);
            const glm::dvec3 expected =
                gloss.kd * kAmbient + received * reference::ward(gloss, normal, to_light, glm::normalize(-point));
            ASSERT_EQ(view.kd.at(x, y).a, 1);
            ASSERT_LT(off(view.kd.at(x, y), gloss.kd), kHalf) << x << ' ' << y;
            ASSERT_EQ(view.rgb.at(x, y).a, 1);
            ASSERT_LT(off(view.rgb.at(x, y), expected), (known ? kHalf : 0.05) * max_of(expected)) << x << ' ' << y;
            ASSERT_LT(off(view.light.at(x, y), diffuse / gloss.kd),
                      (known ? kHalf : 0.05) * max_of(diffuse / gloss.kd));
            ASSERT_NEAR(view.light.at(x, y).a, 1, kHalf) << "nothing is in shadow";
            ASSERT_EQ(view.ks_alpha.at(x, y), glm::vec4(gloss.ks, gloss.alpha));
            ASSERT_EQ(view.label.at(x, y), 3u);
            brightest = std::max(brightest, max_of(expected / diffuse));
        });
        EXPECT_EQ(hits, view.kd.pixels().size());
        EXPECT_GT(brightest, 1.5) << "the highlight is in the picture";
    }
}

// What records gathered takes the ambient term's place, and a gloss reflects ks of it.
TEST_F(PredictRadiance, GatheredLightIsReceivedAndReflected) {
    ShadingRig rig = this->rig(wall_, 0.02f);
    rig.lights.set({}, kAmbient);
    const Ward gloss{{0.5, 0.25, 0.125}, glm::dvec3(0.125), 0.25};
    rig.materials.set(3, glm::vec3(gloss.ks), static_cast<float>(gloss.alpha));
    const glm::dvec3 around(0.5, 0.25, 0.75);
    rig.incident = reference::GatheredRays{around, 48, 16};
    rig.paint([&](const RecordPlace&) { return painted(gloss.kd, 3); });
    const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
    const glm::dvec3 received = 0.75 * around + 0.25 * kAmbient, expected = (gloss.kd + gloss.ks) * received;
    const size_t hits = for_each_hit(view, 0, [&](uint32_t x, uint32_t y) {
        ASSERT_LT(off(view.rgb.at(x, y), expected), kHalf * max_of(expected)) << x << ' ' << y;
        ASSERT_LT(off(view.light.at(x, y), received), kHalf * max_of(received));
    });
    EXPECT_GT(hits, 0u);
}

// Of unsure records kd comes from their segment, too. Pictures do not: what the light is off by, kd is off by as much.
TEST_F(PredictRadiance, UnderGatheredLightPicturesShowWhatTheRecordsHave) {
    const glm::dvec3 around(0.5, 0.25, 0.75), left(0.25, 0.25, 0.25), right(0.75, 0.75, 0.75);
    for (const bool gathers : {true, false}) {
        ShadingRig rig = this->rig(wall_, 0.02f);
        rig.lights.set({}, around);
        rig.materials.set(3, glm::vec3(0), 0.25f);
        if (gathers) rig.incident = reference::GatheredRays{around, 64, 0};
        rig.paint([&](const RecordPlace& place) {
            reference::ShadedRecord record = painted(place.point_m.x < 0 ? left : right, 3);
            record.certainty = glm::dvec3(0.5);
            return record;
        });
        const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
        const size_t hits = for_each_hit(view, 0, [&](uint32_t x, uint32_t y) {
            const float at = view.position_m.at(x, y).x;
            if (std::abs(at) < 0.05f) return;
            const glm::dvec3 own = at < 0 ? left : right, kd(view.kd.at(x, y));
            // An even record, 0.05 off, beside a segment that its records differ from by 0.1: a fifth of the segment.
            ASSERT_LT(off(view.kd.at(x, y), 0.8 * own + 0.2 * 0.5 * (left + right)), 0.02) << x << ' ' << y;
            ASSERT_LT(off(view.rgb.at(x, y), (gathers ? own : kd) * around), 4 * kHalf) << x << ' ' << y;
        });
        EXPECT_GT(hits, 0u);
    }
}

// 0.05 is the deviation of a record that is half sure, and 0.015 that from the albedo around: 9 % is the record's own.
TEST_F(PredictRadiance, TheAlbedoAroundOutweighsWhatARecordIsNotSureOf) {
    const glm::dvec3 own(0.25, 0.5, 0.75), around(0.5, 0.75, 0.25);
    for (const bool of_picture : {false, true}) {
        ShadingRig rig = this->rig(wall_, 0.02f);
        rig.of_picture = of_picture;
        rig.paint([&](const RecordPlace&) {
            reference::ShadedRecord record = painted(own, 0);
            record.certainty = glm::dvec3(0.5);
            record.around = around;
            return record;
        });
        const double weight = 0.05 * 0.05 / (0.015 * 0.015);
        const glm::dvec3 expected = of_picture ? own : (own + weight * around) / (1 + weight);
        const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
        const size_t hits = for_each_hit(view, 0, [&](uint32_t x, uint32_t y) {
            ASSERT_LT(off(view.kd.at(x, y), expected), 0.005) << x << ' ' << y;
        });
        EXPECT_GT(hits, 0u);
    }
}

// Records that reflect more than they receive, as under light that was found too weak.
TEST_F(PredictRadiance, APictureIsItsKdTimesLightAndHighlights) {
    const glm::dvec3 own(1.5, 0.5, 2.5), light(0.25, 0.5, 0.125);
    ShadingRig rig = this->rig(wall_, 0.02f);
    rig.incident = reference::GatheredRays{light, 64, 0};
    rig.lights.set({}, light);
    rig.materials.set(3, glm::vec3(0.1f), 0.25f);
    rig.paint([&](const RecordPlace&) {
        reference::ShadedRecord record = painted(own, 3);
        record.certainty = glm::dvec3(0.3);
        record.around = glm::dvec3(0.5);
        return record;
    });
    for (const bool of_picture : {false, true}) {
        rig.of_picture = of_picture;
        const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
        const size_t hits = for_each_hit(view, 0, [&](uint32_t x, uint32_t y) {
            const glm::dvec3 kd(view.picture_kd.at(x, y)), received(view.light.at(x, y)), rgb(view.rgb.at(x, y));
            ASSERT_LT(off(view.picture_kd.at(x, y), own), 0.02) << x << ' ' << y;
            ASSERT_EQ(view.kd.at(x, y) == view.picture_kd.at(x, y), of_picture) << "else around counts";
            ASSERT_LT(glm::length(rgb - kd * received - 0.1 * received), 0.005) << x << ' ' << y;
        });
        EXPECT_GT(hits, 0u);
    }
}

TEST_F(PredictRadiance, AKdThatVariesLinearlyDoesSoBetweenTheRecords) {
    const auto ramp = [](glm::dvec3 p) {
        return glm::dvec3(0.5 + 0.5 * p.x, 0.4 - 0.4 * p.y, 0.5 + 0.3 * (p.x + p.y));
    };
    ShadingRig rig = this->rig(wall_);
    rig.paint([&](const RecordPlace& place) { return painted(ramp(place.point_m)); });
    const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
    for_each_hit(view, 8, [&](uint32_t x, uint32_t y) {
        const glm::dvec3 expected = ramp(glm::dvec3(view.position_m.at(x, y)));
        // A shared exponent keeps 9 bits.
        ASSERT_LT(off(view.kd.at(x, y), expected), 1.0 / 1024 + kHalf) << x << ' ' << y;
    });
}

TEST_F(PredictRadiance, SurfacesBackToBackDoNotMix) {
    // Its sides lie in voxels next to each other, so that either is among the eight around the other.
    const auto plate = reference::box({0, 0, 1.006}, {0.3, 0.3, 0.01});
    const RigidTransform behind = reference::look_at({0, 0, 2}, {0, 0, 1});
    ShadingRig rig = this->rig(plate, 0.02f, {kPose, behind});
    const glm::dvec3 front(0.75, 0.125, 0.125), back(0.125, 0.125, 0.75);
    rig.paint([&](const RecordPlace& place) { return place.normal.z < 0 ? painted(front, 1) : painted(back, 2); });
    for (const bool is_behind : {false, true}) {
        const ShadedView view = rig.predict(ShadingRig::camera(), is_behind ? behind : kPose);
        const size_t hits = for_each_hit(view, 0, [&](uint32_t x, uint32_t y) {
            const glm::vec4 at = view.position_m.at(x, y);
            if (std::max(std::abs(at.x), std::abs(at.y)) > 0.27f) return;
            ASSERT_EQ(view.kd.at(x, y).a, 1);
            ASSERT_LT(off(view.kd.at(x, y), is_behind ? back : front), kHalf) << x << ' ' << y;
            ASSERT_EQ(view.label.at(x, y), is_behind ? 2u : 1u);
        });
        EXPECT_GT(hits, 5000u);
    }
}

TEST_F(PredictRadiance, WhatIsUnknownIsFilledFromAVoxelAway) {
    ShadingRig rig = this->rig(wall_);
    const glm::dvec3 kd(0.5, 0.25, 0.75);
    constexpr int kFirstKnown = 3;  // voxels from x = 6 cm on
    rig.paint([&](const RecordPlace& place) {
        ShadedRecord record = painted(kd);
        // What is unknown may hold anything.
        if (place.voxel[0] < kFirstKnown) {
            record = painted({0.1, 0.9, 0.1});
            record.certainty = glm::dvec3(0);
            record.marched = false;
        }
        return record;
    });
    const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
    size_t filled = 0, unknown = 0;
    for_each_hit(view, 8, [&](uint32_t x, uint32_t y) {
        // Centres of known voxels are at least half a voxel beyond the border; the eight around a point reach one
        // voxel, one more two.
        const double voxels = double{view.position_m.at(x, y).x} / 0.02 - kFirstKnown;
        if (std::abs(voxels + 1.5) < 0.01) return;
        const bool known = voxels > -1.5;
        ASSERT_EQ(view.kd.at(x, y).a, known ? 1 : 0) << x << ' ' << y;
        ASSERT_LT(off(view.kd.at(x, y), known ? kd : glm::dvec3(0)), kHalf) << x << ' ' << y;
        ASSERT_EQ(view.rgb.at(x, y).a, known ? 1 : 0);
        ASSERT_EQ(view.rgb.at(x, y).g > 0, known);
        filled += known && voxels < -0.5;
        unknown += !known;
    });
    EXPECT_GT(filled, 200u);
    EXPECT_GT(unknown, 4000u);
}

TEST_F(PredictRadiance, ASideThatNoRecordKnowsIsFilledFromTheNearestOther) {
    const auto crate = reference::box({0, 0, 1.1}, {0.15, 0.15, 0.1});
    const RigidTransform aside = reference::look_at({0.6, 0, 0.8}, {0, 0, 1.1});
    ShadingRig rig = this->rig(crate, 0.02f, {kPose, aside});
    const glm::dvec3 kd(0.5, 0.25, 0.75);
    rig.paint([&](const RecordPlace& place) {
        ShadedRecord record = painted(kd, 1);
        if (place.normal.z < -0.9) return record;
        record = painted({0.1, 0.9, 0.1});
        record.certainty = glm::dvec3(0);
        return record;
    });
    const ShadedView view = rig.predict(ShadingRig::camera(), aside);
    size_t filled = 0;
    for_each_hit(view, 0, [&](uint32_t x, uint32_t y) {
        const glm::vec4 at = view.position_m.at(x, y);
        if (view.normal.at(x, y).x < 0.99f || at.z > 1.015f || std::abs(at.y) > 0.12f) return;
        ASSERT_EQ(view.kd.at(x, y).a, 1) << x << ' ' << y;
        ASSERT_LT(off(view.kd.at(x, y), kd), 2 * kHalf) << x << ' ' << y;
        ASSERT_EQ(view.label.at(x, y), 1u);
        ++filled;
    });
    EXPECT_GT(filled, 50u);
}

TEST_F(PredictRadiance, LightsThatWereNotMarchedYetReachTheSurface) {
    ShadingRig rig = this->rig(wall_);
    rig.paint([&](const RecordPlace&) {
        ShadedRecord record = painted(glm::dvec3(0.5), 0, 0);
        record.marched = false;
        return record;
    });
    const ShadedView view = rig.predict(ShadingRig::camera(), kPose),
                     without = rig.predict(ShadingRig::camera(), kPose, false);
    for_each_hit(view, 8, [&](uint32_t x, uint32_t y) {
        ASSERT_EQ(view.rgb.at(x, y), without.rgb.at(x, y));
        ASSERT_EQ(view.light.at(x, y).a, gpu::kNotMarched) << "and says so";
        // Hardware may cut halves off.
        ASSERT_NEAR(without.light.at(x, y).a, 1, device().caps().software() ? 0 : kHalf)
            << "the paper's model knows of no shadows";
    });
}

TEST_F(PredictRadiance, WhatNoRecordKnowsIsWhatTheRestOfTheSegmentHas) {
    ShadingRig rig = this->rig(wall_);
    const glm::dvec3 left(0.25, 0.5, 0.75), right(0.75, 0.5, 0.125);
    rig.paint([&](const RecordPlace& place) {
        const bool is_left = place.voxel[0] < 0;
        ShadedRecord record = painted(is_left ? left : right, is_left ? 1 : 2);
        if (place.voxel[1] < 0) record = painted({0.9, 0.9, 0.1}, record.label);
        if (place.voxel[1] < 0) record.certainty = glm::dvec3(0);
        return record;
    });
    const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
    size_t unknown = 0;
    for_each_hit(view, 8, [&](uint32_t x, uint32_t y) {
        const glm::vec4 at = view.position_m.at(x, y);
        if (std::abs(at.x) < 0.03f) return;
        ASSERT_EQ(view.kd.at(x, y).a, 1);
        ASSERT_LT(off(view.kd.at(x, y), at.x < 0 ? left : right), 2 * kHalf) << x << ' ' << y;
        unknown += at.y < -0.06f;
    });
    EXPECT_GT(unknown, 4000u);
}

TEST_F(PredictRadiance, AChannelCountsByItsOwnCertainty) {
    ShadingRig rig = this->rig(wall_);
    rig.paint([&](const RecordPlace& place) {
        ShadedRecord record = painted({0.5, 0.25, 0.5});
        const bool odd = (place.voxel[0] + place.voxel[1]) % 2 != 0;
        if (odd) record.kd.r = 0.875;
        if (odd) record.certainty = {0, 1, 1};
        return record;
    });
    const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
    for_each_hit(view, 8, [&](uint32_t x, uint32_t y) {
        ASSERT_LT(off(view.kd.at(x, y), {0.5, 0.25, 0.5}), kHalf) << x << ' ' << y;
    });
}

TEST_F(PredictRadiance, TheEdgeOfAShadowIsOneVoxelWide) {
    ShadingRig rig = this->rig(wall_);
    const glm::dvec3 kd(0.5);
    rig.paint([&](const RecordPlace& place) { return painted(kd, 0, place.voxel[0] < 0 ? 1 : 0); });
    const ShadedView view = rig.predict(ShadingRig::camera(), kPose),
                     without = rig.predict(ShadingRig::camera(), kPose, false);
    for_each_hit(view, 8, [&](uint32_t x, uint32_t y) {
        const double lit = std::clamp(0.5 - double{view.position_m.at(x, y).x} / 0.02, 0.0, 1.0);
        const glm::dvec3 ambient = kAmbient * kd, direct = glm::dvec3(without.rgb.at(x, y)) - ambient;
        ASSERT_GT(direct.r, 0.01);
        ASSERT_NEAR(view.light.at(x, y).a, lit, 2 * kHalf);
        ASSERT_LT(off(view.rgb.at(x, y), ambient + lit * direct), 2 * kHalf * max_of(ambient + direct))
            << x << ' ' << y;
    });
}

TEST_F(PredictRadiance, ManyLightsEachReachWhatTheyReach) {
    ShadingRig rig = this->rig(wall_);
    std::vector<Light> lights;
    for (uint32_t i = 0; i < gpu::kMaxPointLights; ++i) {
        const float angle = 0.3f * static_cast<float>(i);
        lights.push_back({{std::cos(angle), std::sin(angle), 0.2f}, {i % 3 == 0, i % 3 == 1, i % 3 == 2}});
    }
    rig.lights.set(lights);
    for (const uint64_t reached : {uint64_t{1}, uint64_t{1} << 31, uint64_t{1} << 32, uint64_t{1} << 63}) {
        rig.paint([&](const RecordPlace&) { return painted(glm::dvec3(0.5), 0, reached); });
        const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
        const reference::ShadedScene scene = rig.scene();
        for_each_hit(view, 8, [&](uint32_t x, uint32_t y) {
            const auto expected = reference::predict_radiance(scene, glm::dvec3(view.position_m.at(x, y)),
                                                              glm::dvec3(view.normal.at(x, y)), glm::dvec3(0));
            ASSERT_GT(max_of(expected.rgb), 0);
            ASSERT_LT(off(view.rgb.at(x, y), expected.rgb), kHalf * max_of(expected.rgb)) << x << ' ' << y;
        });
    }
}

TEST_F(PredictRadiance, SegmentsMeetBetweenTheirVoxels) {
    ShadingRig rig = this->rig(wall_);
    rig.materials.set(1, glm::vec3(0.25f), 0.5f);
    // A column of voxels without a label takes it from where the next one is nearest; label 2 has no material.
    rig.paint([&](const RecordPlace& place) {
        return painted(glm::dvec3(0.5), place.voxel[0] == 0 ? 0 : place.voxel[0] < 0 ? 1 : 2);
    });
    const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
    for_each_hit(view, 8, [&](uint32_t x, uint32_t y) {
        const double border = double{view.position_m.at(x, y).x} / 0.02 - 0.5;
        if (std::abs(border) < 0.01) return;
        const bool left = border < 0;
        ASSERT_EQ(view.label.at(x, y), left ? 1u : 2u) << x << ' ' << y;
        ASSERT_EQ(view.ks_alpha.at(x, y), left ? glm::vec4(0.25f, 0.25f, 0.25f, 0.5f) : glm::vec4(0));
    });
}

// A frame in a mirror's segment is no mirror.
TEST_F(PredictRadiance, WhatHasADiffusePartIsNoMetalThoughItsSegmentIs) {
    ShadingRig rig = this->rig(wall_);
    rig.materials.set(3, glm::vec3(0.8f), 0.25f);
    for (const float mirror : {1.0f, 0.0f}) {
        rig.mirrors[3] = mirror;
        for (const auto& [kd, ks] : {std::pair{0.0, 0.8}, {0.03, 0.8}, {0.075, 0.4}, {0.12, 0.0}, {0.5, 0.0}}) {
            rig.paint([&](const RecordPlace&) { return painted(glm::dvec3(kd), 3); });
            const ShadedView view = rig.predict(ShadingRig::camera(), kPose);
            const double expected = mirror == 1 ? ks : 0.8;
            const size_t hits = for_each_hit(view, 4, [&](uint32_t x, uint32_t y) {
                ASSERT_NEAR(view.ks_alpha.at(x, y).r, expected, 0.03) << mirror << ' ' << kd;
                ASSERT_EQ(view.ks_alpha.at(x, y).a, 0.25f);
            });
            EXPECT_GT(hits, 1000u);
        }
    }
}

TEST_F(PredictRadiance, GlossThatIsApartIsWhatThePictureLacks) {
    ShadingRig rig = this->rig(wall_);
    const glm::dvec3 ks(0.5, 0.25, 0.125), around(0.25, 0.5, 0.125);
    rig.materials.set(3, glm::vec3(ks), 0.25f);
    rig.incident = reference::GatheredRays{around, 64, 0};
    rig.paint([&](const RecordPlace&) { return painted(glm::dvec3(0.3), 3); });
    const ShadedView whole = rig.predict(ShadingRig::camera(), kPose);
    rig.gloss_apart = true;
    const ShadedView apart = rig.predict(ShadingRig::camera(), kPose);
    ASSERT_EQ(apart.glossy.size(), apart.rgb.extent().area());
    const size_t hits = for_each_hit(apart, 0, [&](uint32_t x, uint32_t y) {
        const gpu::GlossyPixel& pixel = apart.glossy[y * apart.rgb.extent().width + x];
        const glm::vec4 gloss(glm::unpackHalf2x16(pixel.ks_alpha.x), glm::unpackHalf2x16(pixel.ks_alpha.y));
        ASSERT_EQ(gloss, glm::vec4(glm::vec3(ks), 0.25f));
        const glm::dvec2 first(glm::unpackHalf2x16(pixel.indirect.x)), last(glm::unpackHalf2x16(pixel.indirect.y));
        ASSERT_LT(max_of(glm::abs(glm::dvec3(first, last.x) - around)), kHalf);
        ASSERT_LT(off(whole.rgb.at(x, y) - apart.rgb.at(x, y), ks * around), 2 * kHalf);
    });
    EXPECT_GT(hits, 1000u);
}

TEST_F(PredictRadiance, AgreesWithTheReferenceOnRandomRecords) {
    for (const float voxel_m : {0.02f, 0.01f}) {
        const auto field = [](glm::dvec3 p) {
            return std::min(reference::sphere({0.05, 0, 0.9}, 0.2)(p),
                            reference::box({-0.2, 0.1, 1}, glm::dvec3(0.15))(p));
        };
        const RigidTransform poses[] = {kPose, reference::look_at({0.5, -0.3, 0.1}, {0, 0, 1})};
        ShadingRig rig = this->rig(field, voxel_m, {poses[0], poses[1]});
        std::vector<Light> lights = {
            kLamp, {{-0.5f, -0.5f, 0}, {0.5f, 1, 1}, 0, {0.8, 0.6, 0}}, {{0, -1, 0.8f}, {1, 1, 1}}};
        rig.lights.set(lights, glm::dvec3(kAmbient));
        rig.materials.set(1, glm::vec3(0.1f), 0.2f);
        rig.materials.set(2, glm::vec3(0.05f), 0.4f);
        std::mt19937 random(1);
        std::uniform_real_distribution<double> share(0, 1);
        rig.paint([&](const RecordPlace&) {
            ShadedRecord record = painted({share(random), share(random), share(random)}, random() % 3, random());
            record.certainty = random() % 3 == 0 ? glm::dvec3(0) : glm::dvec3(0.3 + 0.7 * share(random));
            record.marched = random() % 4 != 0;
            if (random() % 3 == 0) record.around = {share(random), share(random), share(random)};
            return record;
        });
        reference::ShadedScene scene = rig.scene();
        scene.materials = {{1, {{}, glm::dvec3(0.1f), 0.2f}}, {2, {{}, glm::dvec3(0.05f), 0.4f}}};
        // Which record draws which numbers differs from run to run: shares are taken over all pixels, not over few.
        size_t compared = 0, same = 0;
        for (const Extent2D extent : {Extent2D{1, 1}, {13, 7}, {65, 33}, {160, 120}}) {
            const double focal = 0.9 * extent.width;
            const Intrinsics camera{extent, focal, focal, 0.5 * (extent.width - 1.0), 0.5 * (extent.height - 1.0), {}};
            const ShadedView view = rig.predict(camera, poses[0]);
            const size_t before = compared;
            for_each_hit(view, 0, [&](uint32_t x, uint32_t y) {
                const glm::dvec3 normal(view.normal.at(x, y));
                if (normal == glm::dvec3(0)) return;
                const auto expected =
                    reference::predict_radiance(scene, glm::dvec3(view.position_m.at(x, y)), normal, glm::dvec3(0));
                const bool agrees = (view.kd.at(x, y).a == 1) == expected.known &&
                                    view.label.at(x, y) == expected.label &&
                                    off(view.kd.at(x, y), expected.kd) < 0.02 &&
                                    off(view.rgb.at(x, y), expected.rgb) < 0.02 * std::max(max_of(expected.rgb), 0.1);
                same += agrees;
                ++compared;
            });
            EXPECT_TRUE(extent.width == 1 || compared - before > extent.area() / 10) << extent;
        }
        // Surfaces are packed to 8 bits: where a record is barely another surface's, or as near as another one, random
        // neighbours differ.
        EXPECT_GE(static_cast<double>(same), 0.98 * static_cast<double>(compared));
    }
}

}  // namespace
}  // namespace patina::predict_radiance_test
