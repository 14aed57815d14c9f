// A room of known albedo under light that no frame showed.

#include <cmath>
#include <numbers>

#include "tests/gpu/reflectance/radiant_room.h"
#include "tests/reference/reflectance/recolor_surfaces.h"

namespace patina::relight_test {
namespace {

constexpr double kKd = 0.5;          // of the room that sends grey() under this light
constexpr double kAmbient = 0.8;     // irradiance over pi
constexpr double kRoundedTo = 0.01;  // a voxel's colour around 1, in steps of its square root

class RelightTest : public RadiantRoomTest {
  protected:
    std::unique_ptr<Model> observed(std::span<const glm::dvec3> directions) {
        auto model = fused(grey, directions);
        model->reflectance.lights.set({}, glm::dvec3(kAmbient));
        model->reflectance.update_all({});
        return model;
    }

    /// The voxel in the middle of a record.
    static glm::ivec3 voxel_of(const RefinedRecord& record, const reference::Volume& volume) {
        return glm::ivec3(glm::floor((glm::dvec3(record.voxel) + 0.5) * (0.02 / volume.voxel_m)));
    }

    /// The mean colour of voxels at the records that `takes`.
    static double mean_color(Model& model, const std::function<bool(const RefinedRecord&)>& takes) {
        const reference::Volume volume = model.observations.fusion().volume();
        double sum = 0;
        uint32_t count = 0;
        for (const RefinedRecord& record : model.reflectance.records()) {
            const reference::Voxel* voxel = volume.find(voxel_of(record, volume));
            if (!takes(record) || !voxel || !voxel->colored) continue;
            sum += voxel->color.g;
            ++count;
        }
        EXPECT_GT(count, 10u);
        return sum / std::max(count, 1u);
    }

    static constexpr uint32_t kRays = 64;
    static inline const std::vector<Light> kLamp{{{0, 0, 0}, glm::dvec3(1), 0}};
};

bool in_the_middle(const RefinedRecord& record) {
    const glm::dvec3 away = glm::abs(record.point_m);
    return on_wall(record) && away.x + away.y + away.z < kHalf_m + 0.03;
}

TEST_F(RelightTest, ALampLightsTheWallsByTheirAlbedo) {
    const auto model = observed(kAll);
    EXPECT_NEAR(mean_color(*model, in_the_middle), 0.4, kColorStep) << "as frames showed it";
    model->reflectance.lights.set(kLamp);
    model->reflectance.relight({.finds_visibility = true});
    EXPECT_NEAR(mean_color(*model, in_the_middle), kKd / (std::numbers::pi * kHalf_m * kHalf_m), 0.03);
}

bool observed_at_all(const RefinedRecord& record) { return record.observations > 0; }

// In a closed room of one albedo as much of the light is left after each bounce, whatever the room's shape.
TEST_F(RelightTest, EachTurnWithRaysIsABounce) {
    const auto model = observed(kAll);
    model->reflectance.lights.set(kLamp);
    model->reflectance.relight({.finds_visibility = true});
    const double direct = mean_color(*model, observed_at_all);
    model->reflectance.relight({.gathered_rays = kRays});
    EXPECT_NEAR(mean_color(*model, observed_at_all) / direct, 1 + kKd, 0.06);
    model->reflectance.relight({.gathered_rays = kRays});
    EXPECT_NEAR(mean_color(*model, observed_at_all) / direct, 1 + kKd + kKd * kKd, 0.08);
}

TEST_F(RelightTest, WhatRecordsGatheredBeforeCountsNoLonger) {
    const auto model = observed(kAll);
    model->reflectance.lights.set(kLamp);
    model->reflectance.relight({.finds_visibility = true});
    model->reflectance.relight({.gathered_rays = kRays});
    model->reflectance.lights.set({});
    model->reflectance.relight({.finds_visibility = true});
    model->reflectance.relight({.gathered_rays = kRays});
    EXPECT_LT(mean_color(*model, on_wall), 1e-3) << "no lamp is left";
}

TEST_F(RelightTest, LightFromAfarComesInWhereNothingWasSeen) {
    const std::array<glm::dvec3, 1> one_wall{glm::dvec3(0, 0, 1)};
    const auto model = observed(one_wall);
    model->reflectance.lights.set({});
    const std::vector<glm::vec3> sky(gpu::kFarFieldTexels, glm::vec3(1.5f));
    model->reflectance.change([&](graph::FrameGraph& frame, ReflectanceStateIds& state) {
        ReflectanceState::replace_surroundings(frame, state, sky);
    });
    model->reflectance.relight({.finds_visibility = true});
    model->reflectance.relight({.gathered_rays = kRays});
    const auto open = [](const RefinedRecord& record) {
        return record.observations > 0 && glm::distance(record.point_m, {0, 0, kHalf_m}) < 0.15;
    };
    EXPECT_NEAR(mean_color(*model, open), kKd * 1.5, 0.03);
}

TEST_F(RelightTest, AFieldOfAnotherSizeIsRefused) {
    const auto model = observed(std::array{glm::dvec3(0, 0, 1)});
    const std::vector<glm::vec3> few(7, glm::vec3(1));
    EXPECT_THROW(model->reflectance.change([&](graph::FrameGraph& frame, ReflectanceStateIds& state) {
        ReflectanceState::replace_surroundings(frame, state, few);
    }),
                 Error);
}

TEST_F(RelightTest, ColoursAreThoseOfTheReference) {
    const auto model = observed(kAll);
    const std::vector<Light> lamps{{{0.1, -0.15, 0.05}, {0.6, 0.4, 0.2}, 0},
                                   {{-0.2, 0.1, 0.2}, {0.1, 0.2, 0.3}, 0, {0.6, 0, -0.8}}};
    model->reflectance.lights.set(lamps);
    model->reflectance.relight({.finds_visibility = true});
    model->reflectance.relight({.gathered_rays = kRays});
    const reference::Volume volume = model->observations.fusion().volume();
    uint32_t compared = 0, off = 0;
    for (const RefinedRecord& record : model->reflectance.records()) {
        const reference::Voxel* voxel = volume.find(voxel_of(record, volume));
        if (!on_wall(record) || !voxel) continue;
        ASSERT_TRUE(voxel->colored);
        reference::KnownSurface surface{
            record.point_m, record.normal, record.kd, record.certainty, record.around, {}, {}};
        for (size_t i = 0; i < lamps.size(); ++i) surface.lit.push_back((record.visible >> i & 1) != 0);
        surface.around = record.incident.mean;
        const glm::dvec3 expected = reference::sent_by(surface, lamps);
        off += glm::length(voxel->color - expected) > kRoundedTo;
        ++compared;
    }
    EXPECT_GT(compared, 1500u);
    EXPECT_EQ(off, 0u);
}

}  // namespace
}  // namespace patina::relight_test
