// Segments made up from known materials and lights: what comes out is what went in.
#include "passes/specular/fit_ward.h"

#include <algorithm>

#include "tests/gpu/observation/entered_records.h"
#include "tests/gpu/specular/fit_ward_rig.h"

namespace patina::fit_ward_test {
namespace {

using reference::Ward;

TEST_F(FitWardTest, FindsKsAndAlphaOfManyMaterials) {
    const std::vector<Ward> truth = {{{}, {0.1, 0.1, 0.1}, 0.1},   {{}, {0.05, 0.05, 0.05}, 0.2},
                                     {{}, {0.3, 0.2, 0.1}, 0.25},  {{}, {0.06, 0.06, 0.06}, 0.35},
                                     {{}, {0.1, 0.15, 0.2}, 0.15}, {{}, {0.06, 0.06, 0.06}, 0.07}};
    std::vector<FilledRecord> records;
    std::vector<uint32_t> labels;
    for (uint32_t i = 0; i < truth.size(); ++i) {
        std::ranges::copy(sphere(i + 1, truth[i]), std::back_inserter(records));
        labels.push_back(i + 1);
    }
    fill(records);
    const auto fits = fit(labels, 4);
    for (uint32_t i = 0; i < truth.size(); ++i) {
        const gpu::WardFit& fitted = fits[i + 1];
        EXPECT_LT(max_of(glm::abs(glm::dvec3(fitted.ks_alpha) - truth[i].ks)), 1e-3) << i;
        EXPECT_NEAR(fitted.ks_alpha.w, truth[i].alpha, 1e-3) << i;
        EXPECT_GT(fitted.confidence, 0.7f) << i;
        EXPECT_EQ(materials_[i + 1].ks_alpha.w > 0, true);
        EXPECT_NEAR(materials_[i + 1].ks_alpha.w, truth[i].alpha, 0.03 * truth[i].alpha) << i;
    }
}

TEST_F(FitWardTest, FindsThemUnderAFlatLamp) {
    std::vector<Light> lights = kLights;
    lights[2].axis = {0.8, 0.6, 0};
    set_lights(lights);
    const Ward truth{{}, {0.1, 0.12, 0.14}, 0.15};
    fill(sphere(1, truth));
    const gpu::WardFit fitted = fit({1}, 4)[1];
    EXPECT_LT(max_of(glm::abs(glm::dvec3(fitted.ks_alpha) - truth.ks)), 1e-3);
    EXPECT_NEAR(fitted.ks_alpha.w, truth.alpha, 1e-3);
}

TEST_F(FitWardTest, AgreesWithTheReferenceOnNoise) {
    std::vector<FilledRecord> records = sphere(3, {{}, {0.08, 0.1, 0.12}, 0.18}, 60);
    std::normal_distribution<float> noise(0, 0.03f);
    for (FilledRecord& record : records) {
        for (FilledObservation& seen : record.observations) {
            seen.rgb = glm::max(seen.rgb * (1 + noise(random_)), 0.0f);
            seen.clipped = {random_() % 5 == 0, false, random_() % 7 == 0};
            if (random_() % 9 == 0) seen.to_viewer = glm::normalize(seen.to_viewer - 0.9f * record.normal);
        }
    }
    fill(records);
    const std::vector<ReferenceFit> want = reference_fits(records, 3);
    EXPECT_GT(max_of(want[0].material.ks), 0.05) << "a highlight was there to be found";
    for (const ReferenceFit& each : want) expect_agreement(fit({3})[3], each, 2e-4, 2e-4, 0.02);
}

TEST_F(FitWardTest, TheWholeSegmentsAlbedoIsThatOfItsVoxelsWithoutTheirHighlights) {
    std::vector<FilledRecord> records = sphere(1, {{}, glm::dvec3(0.2), 0.2});
    fill(records);
    const glm::vec3 mixed = kd_of(fit({1}, 3)[1]).value();
    const std::vector<ReferenceFit> want = reference_fits(records, 9);
    EXPECT_LT(max_of(glm::abs(glm::dvec3(mixed) - want[2].kd)), 1e-3);
    EXPECT_LT(max_of(glm::abs(glm::dvec3(kd_of(fit({1}, 6)[1]).value()) - want[8].kd)), 1e-3);
    EXPECT_LT(max_of(glm::abs(glm::dvec3(mixed) - 0.275)), 0.03) << "voxels have any albedo from 0.05 to 0.5";

    const glm::dvec3 kd(0.3, 0.2, 0.1);
    std::vector<FilledRecord> plain = sphere(2, {{}, glm::dvec3(0.2), 0.2}, kVoxels, 0.3f);
    for (FilledRecord& record : plain) {
        const reference::SurfacePoint point{glm::dvec3(kept_point_m(map_, record)), glm::dvec3(record.normal)};
        for (FilledObservation& seen : record.observations)
            seen.rgb = glm::vec3(reference::shade({kd, glm::dvec3(0.2), 0.2}, point, received(),
                                                  glm::dvec3(0.05, 0.04, 0.03), glm::dvec3(seen.to_viewer)));
    }
    fill(plain);
    EXPECT_LT(max_of(glm::abs(glm::dvec3(kd_of(fit({2}, 3)[2]).value()) - kd)), 2e-3);
    EXPECT_FALSE(kd_of(fit({5})[5])) << "nothing is known of it";
}

// What voxels gathered takes the ambient term's place, and a gloss reflects ks of it.
TEST_F(FitWardTest, ASegmentsAlbedoCountsTheLightFromAllAround) {
    const Ward material{{0.3, 0.2, 0.1}, glm::dvec3(0.2), 0.2};
    const glm::dvec3 around(0.5, 0.25, 0.125);
    std::vector<FilledRecord> records = sphere(2, material, kVoxels, 0.3f);
    for (FilledRecord& record : records) {
        const reference::SurfacePoint point{glm::dvec3(kept_point_m(map_, record)), glm::dvec3(record.normal)};
        for (FilledObservation& seen : record.observations)
            seen.rgb = glm::vec3(reference::shade(material, point, received(), around, glm::dvec3(seen.to_viewer)) +
                                 material.ks * around);
    }
    fill(records);
    rig_.set_incident(static_cast<uint32_t>(records.size()), {around, 64, 0});
    EXPECT_LT(max_of(glm::abs(glm::dvec3(kd_of(fit({2}, 3)[2]).value()) - material.kd)), 4e-3);
}

TEST_F(FitWardTest, HighlightsOfBentSurfacesAreTakenForBlurred) {
    // Voxels of a ball, many side by side, each seen with the mean over normals that spread as its blur says.
    const Ward truth{{}, glm::dvec3(0.05), 0.07};
    std::vector<FilledRecord> records = sphere(1, truth, 200, 0.16f);
    const std::vector<double> blur2 = blur2_of(records);
    ASSERT_GT(std::ranges::count_if(blur2, [](double b) { return b > 0.02 * 0.02; }), 150);
    std::normal_distribution<double> gauss;
    for (size_t i = 0; i < records.size(); ++i) {
        FilledRecord& record = records[i];
        const glm::dvec3 position(kept_point_m(map_, record)), normal(record.normal);
        const Ward material{{0.2, 0.2, 0.2}, truth.ks, truth.alpha};
        for (FilledObservation& seen : record.observations) {
            glm::dvec3 rgb(0);
            constexpr int kNormals = 400;
            for (int k = 0; k < kNormals; ++k) {
                const glm::dvec3 off =
                    std::sqrt(0.5 * blur2[i]) * glm::dvec3(gauss(random_), gauss(random_), gauss(random_));
                const glm::dvec3 tilted = glm::normalize(normal + off - normal * glm::dot(normal, off));
                rgb += reference::shade(material, {position, tilted}, received(), glm::dvec3(0),
                                        glm::dvec3(seen.to_viewer)) /
                       double(kNormals);
            }
            seen.rgb = glm::vec3(rgb);
        }
    }
    // Beyond an edge the ball does not bend: faces of another thing, across its own, in voxels beside some of its own.
    for (size_t i = 0; i < 60; ++i) {
        std::array<int, 3> beside = voxel_of(records[i]);
        beside[i % 3] += i % 2 == 0 ? 1 : -1;
        if (!used_.insert(beside).second) continue;
        const glm::vec3 center_vox(beside[0] + 0.5f, beside[1] + 0.5f, beside[2] + 0.5f);
        records.push_back({center_vox * map_.settings().voxel_m,
                           glm::normalize(glm::cross(records[i].normal, glm::vec3(0.3f, 0.5f, 0.8f))),
                           2,
                           {}});
    }
    ASSERT_GT(records.size(), 220u);
    fill(records);
    const gpu::WardFit unaware = fit({1})[1];
    EXPECT_GT(unaware.ks_alpha.w, 1.08 * truth.alpha) << "without its neighbours a voxel knows no better";
    enter_records(runner(), map_, records);
    graph::FrameGraph frame = runner().begin();
    table_.reset(frame);
    run(std::move(frame));
    const gpu::WardFit got = fit({1})[1];
    EXPECT_NEAR(got.ks_alpha.w, truth.alpha, 0.03 * truth.alpha);
    EXPECT_LT(max_of(glm::abs(glm::dvec3(got.ks_alpha) - truth.ks)), 0.05 * 0.05);

    records.resize(blur2.size());
    const std::vector<ReferenceFit> want = reference_fits(records, 3, blur2);
    expect_agreement(got, want[0], 2e-4, 2e-4, 0.01);
    // Differences are 4.7e-5 and 6.0e-5 on lavapipe; were the highlights that weights are about not blurred, they would
    // be 1.0e-4 and 1.2e-4.
    expect_agreement(fit({1}, 2)[1], want[2], 7.5e-5, 9e-5, 1e-3);

    EXPECT_NEAR(fit({1}, 3)[1].ks_alpha.w, truth.alpha, 0.03 * truth.alpha) << "when the estimate tells outliers, too";
}

TEST_F(FitWardTest, KeepsThePriorWhereNoObservationTells) {
    // A floor, seen from far off every mirrored light.
    std::vector<FilledRecord> records = sphere(1, {{}, glm::dvec3(0.2), 0.05});
    for (FilledRecord& record : records) {
        std::erase_if(record.observations, [&](const FilledObservation& seen) {
            return std::ranges::any_of(kLights, [&](const Light& light) {
                const glm::vec3 half =
                    glm::normalize(glm::normalize(glm::vec3(light.position_m) - record.point_m) + seen.to_viewer);
                return glm::dot(half, record.normal) > std::cos(0.7f);
            });
        });
    }
    std::vector<FilledRecord> again = records;
    for (FilledRecord& record : again) record.label = 2;
    std::ranges::copy(again, std::back_inserter(records));
    fill(records);
    set_network(2, {0.07f, 0.08f, 0.09f, 0.06f});
    const auto fits = fit({1, 2}, 3);
    EXPECT_LT(max_of(glm::abs(glm::dvec3(fits[1].ks_alpha) - 0.04)), 2e-3) << "without the network's word";
    EXPECT_LT(max_of(glm::abs(glm::dvec3(fits[2].ks_alpha) - 0.04)), 2e-3) << "its word on alpha alone counts";
    EXPECT_NEAR(fits[2].ks_alpha.w, 0.06f, 2e-3);
    EXPECT_LT(fits[1].confidence, 0.1f);
    EXPECT_LT(fits[2].confidence, 0.1f);
}

TEST_F(FitWardTest, TheNetworksWordCountsAsTheReferenceHasIt) {
    // Of few voxels, so that it counts beside them.
    std::vector<FilledRecord> records = sphere(1, {{}, {0.05, 0.06, 0.07}, 0.2}, 12);
    std::normal_distribution<float> noise(0, 0.1f);
    for (FilledRecord& record : records)
        for (FilledObservation& seen : record.observations) seen.rgb *= std::max(1 + noise(random_), 0.0f);
    fill(records);
    const ReferenceFit without = reference_fits(records).front();
    expect_agreement(fit({1})[1], without, 1e-4, 5e-5, 1e-3);
    set_network(1, {0.2f, 0.2f, 0.2f, 0.4f});
    reference::SpecularPrior said;
    said.alpha = 0.4;
    said.alpha_deviation = 0.7;
    const std::vector<ReferenceFit> with = reference_fits(records, 1, {}, said);
    EXPECT_GT(with[0].material.alpha, 1.02 * without.material.alpha);
    graph::FrameGraph frame = runner().begin();
    table_.reset(frame);
    run(std::move(frame));
    expect_agreement(fit({1})[1], with[0], 1e-4, 5e-5, 1e-3);
}

TEST_F(FitWardTest, TheNetworksWordGivesWayToObservations) {
    const Ward truth{{}, glm::dvec3(0.1), 0.15};
    fill(sphere(1, truth));
    set_network(1, {0.2f, 0.2f, 0.2f, 0.3f});
    const gpu::WardFit fitted = fit({1}, 4)[1];
    EXPECT_LT(max_of(glm::abs(glm::dvec3(fitted.ks_alpha) - truth.ks)), 2e-3);
    EXPECT_NEAR(fitted.ks_alpha.w, truth.alpha, 2e-3);
}

// Three views of a voxel lie close together as often as not: what differs between them is as likely an error.
TEST_F(FitWardTest, VoxelsThatWereSeenSeldomTellOfKdAlone) {
    std::vector<FilledRecord> records = sphere(1, {{}, glm::dvec3(0.2), 0.15});
    for (FilledRecord& record : records) record.observations.resize(3);
    for (FilledRecord record : sphere(2, {{}, glm::dvec3(0.2), 0.15})) {
        record.observations.resize(4);
        records.push_back(record);
    }
    fill(records);
    const auto fits = fit({1, 2}, 3);
    EXPECT_LT(max_of(glm::abs(glm::dvec3(fits[1].ks_alpha) - 0.04)), 1e-6) << "the prior";
    EXPECT_LT(fits[1].confidence, 0.01f);
    EXPECT_EQ(materials_[1].unobserved, 1.0f);
    EXPECT_LT(max_of(glm::abs(glm::dvec3(kd_of(fits[1]).value()) - 0.275)), 0.05) << "voxels have any from 0.05 to 0.5";
    EXPECT_GT(fits[2].ks_alpha.r, 0.1f);
    EXPECT_LT(materials_[2].unobserved, 0.3f);
}

// No such material is known: what is so blue is a window that it mirrors.
TEST_F(FitWardTest, StrongGlossFarBluerThanTheLampsIsNotBelieved) {
    const std::vector<std::pair<glm::dvec3, double>> believed{
        {{0.2, 0.3, 0.4}, 0}, {{0.4, 0.3, 0.2}, 1}, {{0.1, 0.15, 0.18}, 1}, {{0.28, 0.33, 0.4}, 0.5}};
    for (const auto& [ks, share] : believed) {
        graph::FrameGraph frame = runner().begin();
        table_.reset(frame);
        run(std::move(frame));
        const std::vector<FilledRecord> records = sphere(1, {{}, ks, 0.15}, 60);
        fill(records);
        const gpu::WardFit fitted = fit({1})[1];
        expect_agreement(fitted, reference_fits(records, 1)[0], 1e-3, 1e-3, 0.01);
        const glm::dvec3 expected = glm::mix(glm::dvec3(0.04), ks, share);
        EXPECT_LT(max_of(glm::abs(glm::dvec3(fitted.ks_alpha) - expected)), share == 0.5 ? 0.05 : 2e-3) << ks.b;
        EXPECT_NEAR(fitted.confidence, share, share == 0.5 ? 0.2 : 0.3) << ks.b;
        EXPECT_NEAR(materials_[1].unobserved, 1 - share, share == 0.5 ? 0.2 : 0.1) << ks.b;
    }
}

TEST_F(FitWardTest, SegmentsWithoutVoxelsOrLightAreUnknown) {
    fill(sphere(1, {{}, glm::dvec3(0.1), 0.15}, 20));
    shadow_all();
    const auto fits = fit({1, 5, 1000});
    for (const uint32_t label : {1u, 5u}) {
        EXPECT_EQ(fits[label].estimates, 0u) << label;
        EXPECT_LT(max_of(glm::abs(glm::dvec3(fits[label].ks_alpha) - 0.04)), 1e-6) << label << ": the prior";
        EXPECT_LT(fits[label].confidence, 0.01f) << label;
    }
}

TEST_F(FitWardTest, AFewWrongNormalsDoNotRuleAHighlightOut) {
    // Seen from far off every mirrored light, but for two voxels, whose normals are wrong: they would show a peak, and
    // do not.
    std::vector<FilledRecord> records = sphere(1, {{}, glm::dvec3(0.2), 0.05});
    uint32_t wrong = 0;
    for (size_t i = 0; i < records.size(); ++i) {
        const auto shows_peak = [&](const FilledObservation& seen) {
            return std::ranges::any_of(kLights, [&](const Light& light) {
                const glm::vec3 to_light = glm::normalize(glm::vec3(light.position_m) - records[i].point_m);
                return glm::dot(glm::normalize(to_light + seen.to_viewer), records[i].normal) > std::cos(0.7f);
            });
        };
        std::erase_if(records[i].observations, shows_peak);
        if (wrong == 2 || records[i].observations.empty()) continue;
        ++wrong;
        const glm::vec3 to_light = glm::normalize(glm::vec3(kLights[0].position_m) - records[i].point_m);
        records[i].normal = glm::normalize(to_light + records[i].observations.front().to_viewer);
    }
    fill(records);
    ASSERT_EQ(wrong, 2u);
    const gpu::WardFit fitted = fit({1}, 3)[1];
    EXPECT_GT(max_of(glm::dvec3(fitted.ks_alpha)), 0.02);
    EXPECT_LT(fitted.confidence, 0.5f);
}

TEST_F(FitWardTest, TheOrderInWhichVoxelsAreKeptChangesNothing) {
    const std::vector<FilledRecord> records = clipped(sphere(1, {{}, glm::dvec3(0.3), 0.08}), 0.5f);
    fill(records);
    const gpu::WardFit one = fit({1}, 2)[1];
    graph::FrameGraph frame = runner().begin();
    table_.reset(frame);
    run(std::move(frame));
    backwards_ = true;
    fill(records);
    const gpu::WardFit other = fit({7, 1}, 2)[1];
    EXPECT_EQ(one.ks_alpha, other.ks_alpha);
    EXPECT_EQ(one.color2_weight, other.color2_weight);
    EXPECT_EQ(one.confidence, other.confidence);
}

TEST_F(FitWardTest, AMaterialsVersionChangesOnlyWithTheMaterial) {
    fill(sphere(1, {{}, glm::dvec3(0.1), 0.15}));
    fit({1}, 5);
    const uint32_t settled = materials_[1].version;
    EXPECT_GE(settled, 1u);
    fit({1}, 3);
    EXPECT_EQ(materials_[1].version, settled);
    EXPECT_EQ(materials_[2].version, 0u);
}

}  // namespace
}  // namespace patina::fit_ward_test
