// Light that records gather in a room of known radiance.

#include "tests/reference/reflectance/gather_irradiance.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "tests/gpu/reflectance/radiant_room.h"

namespace patina::gather_irradiance_test {
namespace {

constexpr uint32_t kRaysAtTheEnd = 8, kRays = 8 * kRaysAtTheEnd;

/// One wall is red, the rest is dim.
glm::dvec3 one_red_wall(glm::dvec3 p) { return p.x < -0.98 * kHalf_m ? glm::dvec3(0.6, 0.1, 0.05) : glm::dvec3(0.1); }

class GatherIrradianceTest : public RadiantRoomTest {
  protected:
    /// Records near a place have their turns, and no others, whose rays would take most of the time.
    static void update_around(glm::dvec3 place_m, Model& model, ReflectanceSettings settings = {}) {
        settings.gathered_rays = kRays / kRaysAtTheEnd;
        model.reflectance.part.cube_m = glm::vec4(glm::vec3(place_m), 0.16f);
        model.reflectance.update_all(settings);
    }

    /// What records in the middle of the wall z = kHalf_m gathered: the mean of all rays that met something, and the
    /// share of those that met nothing.
    static std::pair<double, double> gathered_by_far_wall(Model& model) {
        update_around({0, 0, kHalf_m}, model);
        double sum = 0, met = 0, missed = 0;
        for (const RefinedRecord& record : model.reflectance.records()) {
            if (record.observations == 0 || glm::distance(record.point_m, {0, 0, kHalf_m}) > 0.08) continue;
            sum += record.gathered.met * record.gathered.mean.r;
            met += record.gathered.met;
            missed += record.gathered.missed;
        }
        EXPECT_GT(met + missed, 20.0 * kRays);
        return {sum / std::max(met, 1.0), missed / (met + missed)};
    }
};

/// What records in the middle of the wall x = kHalf_m gathered, on average.
double red_opposite(const std::vector<RefinedRecord>& records) {
    double sum = 0;
    uint32_t count = 0;
    for (const RefinedRecord& record : records) {
        const glm::dvec3 apart = record.point_m - glm::dvec3(kHalf_m, 0, 0);
        if (record.observations == 0 || glm::length(apart) > 0.06) continue;
        sum += record.gathered.mean.r;
        ++count;
    }
    EXPECT_GT(count, 10u);
    return sum / count;
}

TEST_F(GatherIrradianceTest, AFurnaceSendsItsRadianceToEveryPoint) {
    const auto model = fused(grey, kAll);
    ReflectanceSettings settings;
    settings.gathered_rays = kRays / kRaysAtTheEnd;
    model->reflectance.update_all(settings);
    uint32_t checked = 0, missed = 0;
    for (const RefinedRecord& record : model->reflectance.records()) {
        if (!on_wall(record)) continue;
        EXPECT_NEAR(record.gathered.mean.r, 0.4, kColorStep);
        EXPECT_EQ(record.gathered.met + record.gathered.missed, kRays);
        missed += record.gathered.missed;
        // What a point sends out is what arrives: it is white.
        EXPECT_NEAR(record.kd.r, 1, 0.02);
        ++checked;
    }
    EXPECT_GT(checked, 2000u);
    EXPECT_LT(missed, 0.03 * kRays * checked) << "the room is closed but for its seams";
}

// The map has one wall; of the other five the surroundings tell.
TEST_F(GatherIrradianceTest, WhatTheMapDoesNotShowComesFromTheSurroundings) {
    const std::array<glm::dvec3, 1> one_wall{glm::dvec3(0, 0, 1)};
    const auto alone = fused(grey, one_wall);
    EXPECT_GT(gathered_by_far_wall(*alone).second, 0.8) << "next to nothing faces the wall in the map";
    const auto model = fused(grey, one_wall);
    collect_surroundings(*model, grey);
    const auto [mean, missed] = gathered_by_far_wall(*model);
    EXPECT_NEAR(mean, 0.4, kColorStep);
    // Cells whose middle is less than 7.5 cm above the wall's own plane count as part of it, so that what lies up to
    // 12.5 cm above may be missed: sin^2(17 degrees) = 0.09 of the rays at 40 cm.
    EXPECT_LT(missed, 0.12);
}

// Behind a window in the wall z = -kHalf_m the world is far away: bright to the sides, less so straight ahead. From the
// far wall the whole window shows what the camera saw in its middle.
TEST_F(GatherIrradianceTest, AWindowShowsWhatIsFarBehindIt) {
    constexpr double kWindow_m = 0.25, kAhead = 0.7, kAside = 0.3, kLedge = 0.2;
    const auto far_away = [](glm::dvec3 d) { return std::abs(d.x) > kAside * std::abs(d.z) ? 3.0 : kAhead; };
    const auto is_window = [](glm::dvec3 p) {
        return p.z < -0.98 * kHalf_m && std::abs(p.x) < kWindow_m && std::abs(p.y) < kWindow_m;
    };
    const auto shows = [&](glm::dvec3 p) { return glm::dvec3(is_window(p) ? far_away(p) : kLedge); };
    const std::array<glm::dvec3, 1> one_wall{glm::dvec3(0, 0, 1)};
    const auto model = fused([](glm::dvec3) { return glm::dvec3(kLedge); }, one_wall);
    // Twice, so that all directions have their turn when the window was seen.
    for (int i = 0; i < 2; ++i) collect_surroundings(*model, shows, 0, is_window);
    const double found = gathered_by_far_wall(*model).first;

    // Midpoints of strata of the disc below the hemisphere: each has the same share of the irradiance.
    constexpr int kStrata = 400;
    double expected = 0, by_place = 0;
    for (int i = 0; i < kStrata; ++i) {
        for (int k = 0; k < kStrata; ++k) {
            const double radius = std::sqrt((i + 0.5) / kStrata), angle = 2 * std::numbers::pi * (k + 0.5) / kStrata;
            const glm::dvec3 d(radius * std::cos(angle), radius * std::sin(angle), -std::sqrt(1 - radius * radius));
            const glm::dvec3 in_plane = glm::dvec3(0, 0, kHalf_m) - 2 * kHalf_m / d.z * d;
            const bool through = is_window(in_plane);
            expected += (through ? far_away(d) : kLedge) / (kStrata * kStrata);
            by_place += (through ? far_away(in_plane) : kLedge) / (kStrata * kStrata);
        }
    }
    EXPECT_GT(by_place, expected + 0.1);
    // Directions count in steps of 3 degrees, and rays close to the wall are missed (see above).
    EXPECT_NEAR(found, expected, 0.05);
}

TEST_F(GatherIrradianceTest, WhatIsClippedIsAsBrightAsLowExposureShowsIt) {
    const std::array<glm::dvec3, 1> one_wall{glm::dvec3(0, 0, 1)};
    const auto clipped = [](glm::dvec3) { return glm::dvec3(0.95); };
    const auto low = [](glm::dvec3) { return glm::dvec3(0.375); };
    const auto model = fused(grey, one_wall);
    collect_surroundings(*model, clipped);
    collect_surroundings(*model, low, 8);
    EXPECT_NEAR(gathered_by_far_wall(*model).first, 3, 0.1) << "the map's own wall is grey";
    const auto dim = fused(grey, one_wall);
    collect_surroundings(*dim, grey);
    collect_surroundings(*dim, low, 8);
    EXPECT_NEAR(gathered_by_far_wall(*dim).first, 0.4, kColorStep) << "the usual exposure shows it well";
}

TEST_F(GatherIrradianceTest, TheMeanIsThatOfTheReference) {
    const auto model = fused(one_red_wall, kAll);
    ReflectanceSettings settings;
    settings.gathered_rays = kRays / kRaysAtTheEnd;
    model->reflectance.update_all(settings);
    const reference::Volume volume = model->observations.fusion().volume();
    glm::dvec3 bias(0);
    double squares = 0;
    uint32_t compared = 0, walls = 0;
    for (const RefinedRecord& record : model->reflectance.records()) {
        if (!on_wall(record) || walls++ % 16 != 0) continue;
        const auto expected =
            reference::gather_irradiance(volume, record.point_m, record.normal, 2.5 * volume.voxel_m, 2, 12);
        const glm::dvec3 off = record.gathered.mean - expected.mean;
        bias += off;
        squares += off.r * off.r;
        ++compared;
    }
    ASSERT_GT(compared, 100u);
    // A ray meets the red wall or not: 0.5 * sqrt(p (1 - p) / 64), p = 0.2, is 0.025; strata halve it.
    EXPECT_LT(std::sqrt(squares / compared), 0.025);
    EXPECT_LT(std::abs(bias.r) / compared, 0.004);
    EXPECT_LT(std::abs(bias.b) / compared, 0.002);
}

TEST_F(GatherIrradianceTest, RecordsOfOneSurfaceShareTheirRays) {
    const auto model = fused(one_red_wall, kAll);
    ReflectanceSettings settings;
    settings.gathered_rays = 2;
    model->reflectance.update_all(settings);
    const std::vector<RefinedRecord> records = model->reflectance.records();
    std::vector<reference::GatheringPlace> places;
    for (const RefinedRecord& record : records)
        places.push_back({record.voxel, record.point_m, record.normal, record.gathered});
    const std::vector<reference::GatheredRays> expected =
        reference::smooth_irradiance(places, model->observations.map().grid().voxel_m);
    uint32_t compared = 0, other = 0;
    double own2 = 0, smooth2 = 0;
    for (size_t i = 0; i < records.size(); ++i) {
        if (!on_wall(records[i])) continue;
        const reference::GatheredRays got = records[i].incident;
        // A normal at the limit may count on one side alone. Half floats round what the differences are made of.
        const bool same = std::abs(double(got.met) - expected[i].met) <= 2 &&
                          std::abs(double(got.missed) - expected[i].missed) <= 2 &&
                          glm::length(got.mean - expected[i].mean) < 1e-3;
        other += !same;
        ++compared;
        if (records[i].point_m.x < 0.9 * kHalf_m) continue;
        own2 += std::pow(records[i].gathered.mean.r - 0.2195, 2);
        smooth2 += std::pow(got.mean.r - 0.2195, 2);
    }
    EXPECT_GT(compared, 2000u);
    EXPECT_LE(other, compared / 200);
    EXPECT_LT(smooth2, 0.3 * own2) << "nine times the rays on the wall opposite the red one";
}

TEST_F(GatherIrradianceTest, OppositeTheRedWallAFifthOfTheLightIsItsOwn) {
    const auto model = fused(one_red_wall, kAll);
    update_around({kHalf_m, 0, 0}, *model);
    // From the middle of a wall the opposite one of a cube has a form factor of 0.239.
    EXPECT_NEAR(red_opposite(model->reflectance.records()), 0.1 + 0.239 * 0.5, 0.01);
}

TEST_F(GatherIrradianceTest, WhereNothingWasSeenTheAmbientLightArrives) {
    const std::array<glm::dvec3, 1> one{glm::dvec3(1, 0, 0)};
    const auto model = fused(grey, one);
    model->reflectance.lights.set({}, glm::dvec3(0.8));
    ReflectanceSettings settings;
    settings.gathered_rays = kRays / kRaysAtTheEnd;
    model->reflectance.update_all(settings);
    uint32_t checked = 0;
    for (const RefinedRecord& record : model->reflectance.records()) {
        if (!on_wall(record) || record.point_m.x < 0.38) continue;
        const double missed = record.incident.missed / double(record.incident.met + record.incident.missed);
        EXPECT_GT(missed, 0.3);
        EXPECT_NEAR(record.kd.g, 0.4 / (0.8 * missed + 0.4 * (1 - missed)), 0.02);
        ++checked;
    }
    EXPECT_GT(checked, 100u);
}

TEST_F(GatherIrradianceTest, ALampSendsNothingASecondTime) {
    const auto model = fused([](glm::dvec3 p) { return glm::dvec3(p.x < -0.98 * kHalf_m ? 1.0 : 0.2); }, kAll);
    ReflectanceSettings settings;
    settings.shadows = false;
    // As large as the bright wall, and too weak to matter.
    model->reflectance.lights.set(
        std::vector<Light>{{{-kHalf_m, 0, 0}, {1e-6f, 1e-6f, 1e-6f}, static_cast<float>(kHalf_m)}});
    update_around({kHalf_m, 0, 0}, *model, settings);
    EXPECT_NEAR(red_opposite(model->reflectance.records()), 0.2 * (1 - 0.239), 0.02);
}

TEST_F(GatherIrradianceTest, RaysAddUpToASlidingMean) {
    const auto model = fused(grey, kAll);
    ReflectanceSettings settings;
    settings.gathered_rays = 1;
    for (int i = 0; i < 26; ++i) model->reflectance.update_all(settings);
    uint32_t checked = 0;
    for (const RefinedRecord& record : model->reflectance.records()) {
        if (!on_wall(record)) continue;
        EXPECT_LE(record.gathered.met + record.gathered.missed, 193u);
        EXPECT_GE(record.gathered.met + record.gathered.missed, 190u);
        EXPECT_NEAR(record.gathered.mean.g, 0.4, kColorStep);
        ++checked;
    }
    EXPECT_GT(checked, 2000u);
}

}  // namespace
}  // namespace patina::gather_irradiance_test
