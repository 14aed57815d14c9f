// Records made up from known materials and lights: what comes out is what went in.

#include "tests/reference/reflectance/refine_albedo.h"

#include <numbers>
#include <random>

#include <glm/gtc/packing.hpp>

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/reflectance/reflectance_rig.h"
#include "tools/bench/filled_records.h"

namespace patina::refine_albedo_test {
namespace {

using reference::ReceivedLight;
using reference::SurfacePoint;
using reference::Ward;

constexpr int kViews = 30;
constexpr double kPacking = 1.0 / 512;  // of colours and of kd: a shared exponent keeps 9 bits

const std::vector<Light> kLights = {{{1.0f, -2.0f, 0.5f}, {3, 2.5f, 2}},
                                    {{-1.5f, -1.8f, -1.0f}, {2, 2, 2.5f}},
                                    {{0.2f, -2.2f, 1.5f}, {1, 1.5f, 1}, 0, {0.6, 0.8, 0}}};

std::vector<ReceivedLight> received(const Lights& lights) {
    std::vector<ReceivedLight> result;
    for (const gpu::PointLight& light : lights.point_lights())
        result.push_back({.position_m = glm::dvec3(light.position_m),
                          .intensity = glm::dvec3(light.intensity),
                          .axis = glm::dvec3(light.axis)});
    return result;
}

glm::dvec3 random_direction(std::mt19937& random, glm::dvec3 normal, double least_cosine) {
    std::normal_distribution<double> gauss;
    for (;;) {
        const glm::dvec3 direction = glm::normalize(glm::dvec3(gauss(random), gauss(random), gauss(random)));
        if (glm::dot(direction, normal) > least_cosine) return direction;
    }
}

class RefineAlbedoTest : public GpuTest {
  protected:
    RefineAlbedoTest() {
        graph::FrameGraph frame = runner().begin();
        voxel_map_.reset(frame, glm::dvec3(0));
        map_.reset(frame, glm::dvec3(0));
        run(std::move(frame));
        rig_.lights.set(kLights, ambient_);
    }

    /// The surface point that a record keeps.
    SurfacePoint kept(const FilledRecord& record) const {
        return {glm::dvec3(kept_point_m(map_, record)), glm::dvec3(record.normal)};
    }

    /// Looks at a record's surface from random directions.
    void observe(FilledRecord& record, const Ward& material, int views = kViews) {
        for (int i = 0; i < views; ++i) {
            const glm::dvec3 direction = random_direction(random_, glm::dvec3(record.normal), 0.3);
            const glm::dvec3 rgb = reference::shade(material, kept(record), received(rig_.lights), ambient_, direction);
            record.observations.push_back({glm::vec3(direction), glm::vec3(rgb), {}});
        }
    }

    /// A record of a floor or of a sphere about the origin.
    FilledRecord random_record(uint32_t label) {
        std::uniform_real_distribution<float> meters(-0.6f, 0.6f);
        const bool on_floor = random_() % 2 == 0;
        const glm::vec3 normal =
            on_floor ? glm::vec3(0, -1, 0) : glm::vec3(random_direction(random_, glm::dvec3(0, -1, 0), 0.2));
        return {on_floor ? glm::vec3(meters(random_), 0.003f, meters(random_)) : 0.4f * normal, normal, label, {}};
    }

    std::vector<RefinedRecord> refine(const std::vector<FilledRecord>& records) {
        ReflectanceSettings settings;
        settings.shadows = false;
        settings.first_marched_records = 1u << 20;
        const auto counts = rig_.update(settings, [&](graph::FrameGraph& frame, ObservationMapIds& ids) {
            add_fill_records(frame, map_, ids, records);
            return add_list_records(frame, static_cast<uint32_t>(records.size()));
        });
        EXPECT_EQ(counts.refined, records.size());
        return rig_.records(static_cast<uint32_t>(records.size()));
    }
    RefinedRecord refine(const FilledRecord& record) { return refine(std::vector{record}).front(); }

    /// What the reference makes of a record, whose colours it takes as they are stored.
    reference::RefinedAlbedo expected(const FilledRecord& record, const Ward& material,
                                      const reference::GatheredRays& gathered = {}, double mirror = 0,
                                      glm::dvec3 low = glm::dvec3(0)) const {
        std::vector<reference::SeenColor> observations;
        for (const FilledObservation& seen : record.observations) {
            observations.push_back({glm::dvec3(seen.to_viewer),
                                    glm::dvec3(glm::unpackF3x9_E1x5(glm::packF3x9_E1x5(seen.rgb))), seen.clipped});
        }
        return reference::refine_albedo(observations, kept(record), received(rig_.lights), ambient_, material, gathered,
                                        mirror, low);
    }

    std::mt19937 random_{1};
    glm::dvec3 ambient_{0.05f, 0.04f, 0.03f};
    VoxelMap voxel_map_{device(), {.capacity_blocks = 64}};
    // Several chunks of 256 records.
    ObservationMap map_{device(),
                        {.capacity_blocks = 64, .capacity_records = 768, .max_chunk_bytes = uint64_t{1} << 15}};
    ReflectanceRig rig_{device(), runner(), voxel_map_, map_};
};

double max_of(glm::dvec3 v) { return std::max({v.x, v.y, v.z}); }

TEST_F(RefineAlbedoTest, KdIsWhatTheSurfaceHasUnderManyLightsAndMaterials) {
    std::uniform_real_distribution<float> share(0, 1);
    std::vector<FilledRecord> records;
    std::vector<Ward> materials;
    for (uint32_t label = 1; label < 40; ++label) {
        const Ward gloss{{}, glm::dvec3(0.05 + 0.2 * share(random_)), 0.08 + 0.3 * share(random_)};
        rig_.materials.set(label, glm::vec3(gloss.ks), static_cast<float>(gloss.alpha));
        for (int i = 0; i < 10; ++i) {
            materials.push_back({{0.05 + 0.9 * share(random_), 0.05 + 0.9 * share(random_), share(random_)},
                                 glm::dvec3(glm::vec3(gloss.ks)),
                                 double{static_cast<float>(gloss.alpha)}});
            records.push_back(random_record(label));
            observe(records.back(), materials.back());
        }
    }
    const std::vector<RefinedRecord> refined = refine(records);
    for (size_t i = 0; i < records.size(); ++i) {
        const double off = max_of(glm::abs(refined[i].kd - materials[i].kd));
        EXPECT_LT(off, 1.5 * kPacking) << "record " << i;
        const reference::RefinedAlbedo reference = expected(records[i], materials[i]);
        EXPECT_LT(max_of(glm::abs(refined[i].kd - reference.kd)), kPacking) << "record " << i;
        EXPECT_LT(max_of(glm::abs(refined[i].certainty - reference.certainty)), 0.02) << "record " << i;
        EXPECT_GT(refined[i].certainty.r, 0.5) << "record " << i;
    }
}

TEST_F(RefineAlbedoTest, AMaterialThatIsNotKnownLeavesItsHighlightInKd) {
    const Ward material{{0.4, 0.3, 0.2}, {0.1, 0.1, 0.1}, 0.2};
    FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 5, {}};
    const SurfacePoint point = kept(record);
    const auto lights = received(rig_.lights);
    const glm::dvec3 ambient = ambient_,
                     direction = glm::reflect(glm::normalize(point.position_m - lights[0].position_m), point.normal);
    record.observations.push_back(
        {glm::vec3(direction), glm::vec3(reference::shade(material, point, lights, ambient, direction)), {}});
    const glm::dvec3 highlight = reference::shade({{}, material.ks, material.alpha}, point, lights, {}, direction);
    const glm::dvec3 irradiance = reference::shade({glm::dvec3(1), {}, 1}, point, lights, ambient, direction);
    EXPECT_LT(max_of(glm::abs(refine(record).kd - (material.kd + highlight / irradiance))), kPacking);
    EXPECT_GT(max_of(highlight / irradiance), 10 * kPacking);
    // Wrong by half: half of it stays.
    rig_.materials.set(5, glm::vec3(material.ks) / 2.0f, static_cast<float>(material.alpha));
    EXPECT_LT(max_of(glm::abs(refine(record).kd - (material.kd + 0.5 * highlight / irradiance))), 1.5 * kPacking);
}

TEST_F(RefineAlbedoTest, DarkClippedChannelsCountOnlyWhereThereIsNothingElse) {
    const Ward material{{0.6, 0.5, 0.4}, {}, 1};
    FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 0, {}};
    observe(record, material);
    const glm::vec3 whole = record.observations[0].rgb;
    for (size_t k = 0; k < record.observations.size() / 2; ++k) {
        record.observations[k].rgb.r = 0.6f * whole.r;
        record.observations[k].clipped = {true, false, false};
    }
    EXPECT_LT(max_of(glm::abs(refine(record).kd - material.kd)), 1.5 * kPacking);

    for (FilledObservation& seen : record.observations) {
        seen.rgb.r = 0.6f * whole.r;
        seen.clipped = {true, false, false};
    }
    const RefinedRecord refined = refine(record);
    EXPECT_LT(max_of(glm::abs(refined.kd - material.kd * glm::dvec3(0.6, 1, 1))), 1.5 * kPacking);
    EXPECT_LT(refined.certainty.r, 0.3);
    EXPECT_GT(refined.certainty.g, 0.9);
}

// White paper that is too bright for all pictures but one, in which it is blurred with what is beside it.
TEST_F(RefineAlbedoTest, ClippedChannelsThatAreBrighterThanTheOthersCount) {
    const Ward material{{0.9, 0.8, 0.7}, {}, 1};
    FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 0, {}};
    observe(record, material);
    for (size_t k = 1; k < record.observations.size(); ++k) record.observations[k].clipped = {true, false, false};
    record.observations[0].rgb.r *= 0.9f;
    EXPECT_LT(max_of(glm::abs(refine(record).kd - material.kd)), 2 * kPacking);
}

// Cream paper: red is clipped in all views, and all channels in one that shows a highlight.
TEST_F(RefineAlbedoTest, OneHighlightOverrulesNoClippedViews) {
    const Ward material{{0.9, 0.7, 0.6}, {}, 1};
    FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 0, {}};
    observe(record, material);
    for (FilledObservation& seen : record.observations) seen.clipped = {true, false, false};
    record.observations[0].rgb = glm::vec3(1.4f * record.observations[0].rgb.r);
    record.observations[0].clipped = {true, true, true};
    EXPECT_LT(max_of(glm::abs(refine(record).kd - material.kd)), 2 * kPacking);
}

// A patch of sun: nothing but low exposure tells how bright it is.
TEST_F(RefineAlbedoTest, WhatIsClippedInAllViewsIsAsBrightAsLowExposureShowedIt) {
    const Ward material{{0.5, 0.3, 0.2}, {}, 1};
    rig_.lights.set(kLights, glm::dvec3(6, 5, 4));
    FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 0, {}};
    const auto seen = [&] {
        return glm::vec3(
            reference::shade(material, kept(record), received(rig_.lights), glm::dvec3(6, 5, 4), {0, -1, 0}));
    };
    for (int k = 0; k < 8; ++k)
        record.observations.push_back({{0, -1, 0}, glm::min(seen(), 1.0f), {true, true, false}});
    ASSERT_GT(seen().g, 1.4f);
    ASSERT_LT(seen().b, 1.0f);
    rig_.set_bright({seen()});
    EXPECT_LT(max_of(glm::abs(refine(record).kd - material.kd)), 3 * kPacking);
    EXPECT_GT(refine(record).certainty.r, 0.5);
    // Another tint: one that low exposure shows in full is believed in all channels.
    rig_.set_bright({seen() * glm::vec3(1, 0.9f, 0.8f)});
    EXPECT_LT(max_of(glm::abs(refine(record).kd - material.kd * glm::dvec3(1, 0.9, 0.8))), 3 * kPacking);
    // Darker than what is clipped: it looked at something else.
    rig_.set_bright({glm::vec3(0.9f)});
    const RefinedRecord bounded = refine(record);
    const glm::dvec3 bound = bounded.kd;
    EXPECT_LT(bound.r, 0.7 * material.kd.r);
    EXPECT_LT(bounded.certainty.b, 0.1) << "what was not clipped is as doubtful, for its color";
    // One view that is not clipped says how bright the surface is.
    record.observations[0].clipped = {false, false, false};
    rig_.set_bright({seen()});
    EXPECT_LT(max_of(glm::abs(refine(record).kd - bound)), 3 * kPacking);
}

TEST_F(RefineAlbedoTest, ClippedRecordsAgreeWithTheReference) {
    std::uniform_real_distribution<float> share(0, 1);
    const Ward material{{0.5, 0.3, 0.4}, {}, 1};
    std::vector<FilledRecord> records;
    std::vector<glm::vec3> low;
    for (int i = 0; i < 200; ++i) {
        records.push_back(random_record(0));
        observe(records.back(), material, 6);
        std::array<bool, 3> always{};
        for (bool& clipped : always) clipped = share(random_) < 0.5f;
        for (FilledObservation& seen : records.back().observations) {
            seen.clipped = always;
            if (share(random_) < 0.05f) seen.clipped = {};
            for (int c = 0; c < 3; ++c) seen.rgb[c] *= seen.clipped[static_cast<size_t>(c)] ? 0.6f : 1.0f;
        }
        const glm::vec3 usual = records.back().observations.front().rgb;
        const glm::vec3 radiance = usual * (0.5f + 2.5f * glm::vec3(share(random_), share(random_), share(random_)));
        low.push_back(i % 3 == 0 ? glm::vec3(0) : glm::unpackF3x9_E1x5(glm::packF3x9_E1x5(radiance)));
    }
    rig_.set_bright(low);
    const std::vector<RefinedRecord> refined = refine(records);
    int sure = 0, doubtful = 0;
    for (size_t i = 0; i < records.size(); ++i) {
        const reference::RefinedAlbedo expected = this->expected(records[i], material, {}, 0, glm::dvec3(low[i]));
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(refined[i].kd[c], expected.kd[c], kPacking + 0.02 * expected.kd[c]) << i << ' ' << c;
            ASSERT_NEAR(refined[i].certainty[c], expected.certainty[c], 0.02) << i << ' ' << c;
        }
        ++(expected.certainty.b > 0.5 ? sure : doubtful);
    }
    EXPECT_GT(sure, 50);
    EXPECT_GT(doubtful, 30);
}

TEST_F(RefineAlbedoTest, OneWildObservationOfTenChangesNothing) {
    const Ward material{{0.3, 0.5, 0.2}, {}, 1};
    for (const float factor : {0.0f, 0.5f, 3.0f, 30.0f}) {
        FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 0, {}};
        observe(record, material);
        for (size_t k = 0; k < record.observations.size(); k += 10) record.observations[k].rgb *= factor;
        EXPECT_LT(max_of(glm::abs(refine(record).kd - material.kd)), 1.5 * kPacking) << factor;
    }
}

TEST_F(RefineAlbedoTest, WhatReceivesNoLightIsUnknown) {
    ambient_ = glm::dvec3(0.2f, 0, 0);
    rig_.lights.set(std::vector<Light>{{{0, 5, 0}, {9, 9, 9}}}, ambient_);  // below the floor
    const Ward material{{0.3, 0.5, 0.2}, {}, 1};
    FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 0, {}};
    observe(record, material);
    const RefinedRecord refined = refine(record);
    EXPECT_NEAR(refined.kd.r, material.kd.r, kPacking);
    EXPECT_GT(refined.certainty.r, 0.5);
    EXPECT_EQ(refined.certainty.g, 0);
    EXPECT_EQ(refined.certainty.b, 0);
}

// Light from all around takes the ambient term's place where rays met something, and adds to the lamps'.
TEST_F(RefineAlbedoTest, GatheredLightCountsBesideTheLamps) {
    const Ward material{{0.4, 0.3, 0.2}, {}, 1};
    const glm::dvec3 around(0.5, 0.25, 0.125), ambient = ambient_;
    for (const uint32_t missed : {0u, 32u, 64u}) {
        const double known = (64 - missed) / 64.0;
        ambient_ = known * around + (1 - known) * ambient;
        FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 0, {}};
        observe(record, material);
        rig_.set_incident(1, {around, 64 - missed, missed});
        EXPECT_LT(max_of(glm::abs(refine(record).kd - material.kd)), 1.5 * kPacking) << missed;
    }
}

TEST_F(RefineAlbedoTest, WhereNoAmbientLightIsKnownUnknownDirectionsAreAsBrightAsTheRest) {
    const Ward material{{0.4, 0.3, 0.2}, {}, 1};
    ambient_ = glm::dvec3(0.5, 0.25, 0.125);
    FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 0, {}};
    observe(record, material);
    rig_.lights.set(kLights, glm::dvec3(0));
    rig_.set_incident(1, {ambient_, 40, 24});
    EXPECT_LT(max_of(glm::abs(refine(record).kd - material.kd)), 1.5 * kPacking);
}

// A gloss reflects ks of what arrives from all around, as much to every viewer.
TEST_F(RefineAlbedoTest, ReflectedSurroundingsAreNotDiffuse) {
    const Ward material{{0.2, 0.3, 0.4}, {0.3, 0.2, 0.1}, 0.3};
    const glm::dvec3 around(0.5, 0.25, 0.25);
    ambient_ = around;
    FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 5, {}};
    observe(record, material);
    for (FilledObservation& seen : record.observations) seen.rgb += glm::vec3(material.ks * around);
    rig_.materials.set(5, glm::vec3(material.ks), static_cast<float>(material.alpha));
    rig_.set_incident(1, {around, 64, 0});
    EXPECT_LT(max_of(glm::abs(refine(record).kd - material.kd)), 2 * kPacking);
}

// Colours that scatter by more than their noise, 0.002 and 2 %, have 1.5 times the rest of their scatter reflected.
TEST_F(RefineAlbedoTest, WhatScattersWithTheViewIsReflectedWhereLightWasGathered) {
    const Ward material{glm::dvec3(0.4), {}, 1};
    ambient_ = glm::dvec3(0.5);
    rig_.lights.set({}, ambient_);
    for (const double scatter : {0.01, 0.2, 0.4}) {
        FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 0, {}};
        for (int k = 0; k < 20; ++k) {
            // All from one angle, so that all count alike.
            const double turn = 2 * std::numbers::pi * k / 20, bright = k % 2 == 0 ? 1 + scatter : 1 - scatter;
            const glm::vec3 direction(0.6 * std::cos(turn), -0.8, 0.6 * std::sin(turn));
            record.observations.push_back({direction, glm::vec3(0.2 * bright), {}});
        }
        rig_.set_incident(1, {});
        EXPECT_LT(max_of(glm::abs(refine(record).kd - material.kd)), 2 * kPacking)
            << "the mean, without gathered light";
        rig_.set_incident(1, {ambient_, 64, 0});
        const double reflected = 1.5 * std::max(scatter - 0.02 - 0.002 / 0.2, 0.0);
        EXPECT_LT(max_of(glm::abs(refine(record).kd - (1 - reflected) * material.kd)), 2 * kPacking) << scatter;
    }
}

TEST_F(RefineAlbedoTest, GatheredLightAgreesWithTheReference) {
    std::uniform_real_distribution<float> share(0, 1);
    const Ward material{{0.3, 0.4, 0.2}, {0.2, 0.1, 0.15}, 0.3};
    rig_.materials.set(5, glm::vec3(material.ks), static_cast<float>(material.alpha));
    const reference::GatheredRays around{glm::dvec3(0.25, 0.5, 0.125), 45, 19};
    std::vector<FilledRecord> records;
    for (int i = 0; i < 200; ++i) {
        records.push_back(random_record(5));
        observe(records.back(), material);
        for (FilledObservation& seen : records.back().observations) seen.rgb *= 0.8f + 0.4f * share(random_);
    }
    rig_.set_incident(200, around);
    const std::vector<RefinedRecord> refined = refine(records);
    int diffuse = 0;
    for (size_t i = 0; i < records.size(); ++i) {
        const reference::RefinedAlbedo expected = this->expected(records[i], material, around);
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(refined[i].kd[c], expected.kd[c], kPacking + 0.01 * expected.kd[c]) << i << ' ' << c;
            ASSERT_NEAR(refined[i].certainty[c], expected.certainty[c], 0.02) << i << ' ' << c;
        }
        diffuse += max_of(expected.kd) > 0.05;
    }
    EXPECT_GT(diffuse, 100);
}

// Of a mirror nothing that scatters is diffuse, and what is always clipped is unknown: a lamp or a window.
TEST_F(RefineAlbedoTest, AMirrorHasNoDiffusePartAndTellsNothingWhereItIsClipped) {
    ambient_ = glm::dvec3(0.5);
    rig_.lights.set({}, ambient_);
    rig_.materials.set(5, glm::vec3(0.9f), 0.05f);
    FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 5, {}};
    for (int k = 0; k < 20; ++k) {
        const double turn = 2 * std::numbers::pi * k / 20;
        const glm::vec3 direction(0.6 * std::cos(turn), -0.8, 0.6 * std::sin(turn));
        record.observations.push_back({direction, glm::vec3(k % 2 == 0 ? 0.9f : 0.6f), {}});
    }
    rig_.set_incident(1, {ambient_, 64, 0});
    EXPECT_GT(refine(record).kd.r, 0.2) << "what it shows beyond its gloss, while nobody knows better";
    rig_.set_mirror(5, 1);
    rig_.set_incident(1, {ambient_, 64, 0});
    const RefinedRecord mirror = refine(record);
    EXPECT_EQ(mirror.kd, glm::dvec3(0));
    EXPECT_GT(mirror.certainty.r, 0.5);
    for (FilledObservation& seen : record.observations) seen.clipped = {true, true, true};
    rig_.set_incident(1, {ambient_, 64, 0});
    EXPECT_EQ(refine(record).certainty, glm::dvec3(0));
}

// Of lamps, and of all around: as if the segment had as much less ks.
TEST_F(RefineAlbedoTest, GlossThatIsAGuessIsNotTakenFromKd) {
    const Ward material{glm::dvec3(0.4, 0.3, 0.2), glm::dvec3(0.2), 0.3}, half{{}, glm::dvec3(0.1), 0.3};
    FilledRecord record = random_record(5);
    observe(record, material);
    const reference::GatheredRays around{glm::dvec3(0.3), 64, 0};
    for (const float guess : {0.0f, 0.5f, 1.0f}) {
        rig_.materials.set(5, glm::vec3(0.2f), 0.3f);
        rig_.set_unobserved(5, guess);
        rig_.set_incident(1, around);
        const Ward taken = guess == 0 ? material : guess == 0.5f ? half : Ward{{}, glm::dvec3(0), 0.3};
        EXPECT_LT(max_of(glm::abs(refine(record).kd - expected(record, taken, around).kd)), 4 * kPacking) << guess;
    }
    EXPECT_GT(max_of(expected(record, half, around).kd - expected(record, material, around).kd), 0.02);
}

// What a mirror shows does not change while nobody moves. That a part of its segment is none shows once somebody does.
TEST_F(RefineAlbedoTest, AMirrorThatWasSeenFromOneSideHasNoDiffusePart) {
    ambient_ = glm::dvec3(0.5);
    rig_.lights.set({}, ambient_);
    rig_.materials.set(5, glm::vec3(0.5f), 0.05f);
    rig_.set_mirror(5, 1);
    const auto kd_of_views_within = [&](double angle) {
        FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 5, {}};
        for (int k = 0; k < 20; ++k) {
            const double turn = 0.5 + angle * k / 19;
            record.observations.push_back({glm::vec3(std::sin(turn), -std::cos(turn), 0), glm::vec3(0.75f), {}});
        }
        rig_.set_incident(1, {ambient_, 64, 0});
        return refine(record).kd.r;
    };
    EXPECT_EQ(kd_of_views_within(0.01), 0);
    EXPECT_GT(kd_of_views_within(0.3), 0.9) << "0.75 less 0.25 of gloss under 0.5";
    rig_.set_mirror(5, 0);
    EXPECT_GT(kd_of_views_within(0.01), 0.9);
}

TEST_F(RefineAlbedoTest, MirrorsAgreeWithTheReference) {
    std::uniform_real_distribution<float> share(0, 1);
    const Ward material{{0.3, 0.4, 0.2}, {0.2, 0.1, 0.15}, 0.3};
    rig_.materials.set(5, glm::vec3(material.ks), static_cast<float>(material.alpha));
    const reference::GatheredRays around{glm::dvec3(0.25, 0.5, 0.125), 45, 19};
    std::vector<FilledRecord> records;
    for (int i = 0; i < 100; ++i) {
        records.push_back(random_record(5));
        observe(records.back(), material);
        const glm::vec3 first = records.back().observations.front().to_viewer;
        for (FilledObservation& seen : records.back().observations) {
            if (i % 3 == 0) seen.to_viewer = glm::normalize(glm::mix(first, seen.to_viewer, 0.02f * share(random_)));
            seen.rgb *= 0.93f + 0.14f * share(random_);
            if (share(random_) < 0.2f) seen.clipped = {true, false, false};
        }
    }
    for (const float mirror : {0.3f, 1.0f}) {
        rig_.set_mirror(5, mirror);
        rig_.set_incident(100, around);
        const std::vector<RefinedRecord> refined = refine(records);
        int diffuse = 0;
        for (size_t i = 0; i < records.size(); ++i) {
            const reference::RefinedAlbedo expected = this->expected(records[i], material, around, double{mirror});
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(refined[i].kd[c], expected.kd[c], kPacking + 0.02 * expected.kd[c]) << i << ' ' << c;
                ASSERT_NEAR(refined[i].certainty[c], expected.certainty[c], 0.02) << i << ' ' << c;
            }
            diffuse += max_of(expected.kd) > 0.05;
        }
        EXPECT_GT(diffuse, 50) << mirror;
    }
}

TEST_F(RefineAlbedoTest, OneObservationIsEnough) {
    const Ward material{{0.3, 0.5, 0.2}, {}, 1};
    FilledRecord record{{0.1f, 0.003f, 0.1f}, {0, -1, 0}, 0, {}};
    observe(record, material, 1);
    EXPECT_LT(max_of(glm::abs(refine(record).kd - material.kd)), kPacking);
}

}  // namespace
}  // namespace patina::refine_albedo_test
