// Segments made up from known materials and lights: what comes out is what went in.

#include "passes/specular/fit_ward.h"

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>

#include "shared/reflectance.h"
#include "tests/gpu/entered_records.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/reflectance_rig.h"
#include "tests/reference/fit_ward.h"
#include "tools/bench/filled_records.h"

namespace patina {
namespace {

using reference::Ward;

const std::vector<PointLight> kLights = {
    {{1.0f, -2.0f, 0.5f}, {3, 2.5f, 2}}, {{-1.5f, -1.8f, -1.0f}, {2, 2, 2.5f}}, {{0.2f, -2.2f, 1.5f}, {1, 1.5f, 1}}};
constexpr uint32_t kLabels = 16;
constexpr uint32_t kVoxels = 128;  // of a segment

double max_of(glm::dvec3 v) { return std::max({v.x, v.y, v.z}); }

class FitWardTest : public GpuTest {
  protected:
    FitWardTest() {
        graph::Frame frame = runner().begin();
        voxel_map_.reset(frame, glm::dvec3(0));
        map_.reset(frame, glm::dvec3(0));
        samples_.reset(frame);
        estimates_.reset(frame);
        table_.reset(frame);
        run(std::move(frame));
        rig_.lights.set(kLights, glm::vec3(0.05f, 0.04f, 0.03f));
        materials_.resize(kLabels);
    }

    static std::vector<reference::ReceivedLight> received() {
        std::vector<reference::ReceivedLight> lights;
        for (const PointLight& light : kLights)
            lights.push_back({glm::dvec3(light.position_m), glm::dvec3(light.intensity)});
        return lights;
    }

    glm::dvec3 direction_about(glm::dvec3 axis, double least_cosine) {
        std::normal_distribution<double> gauss;
        for (;;) {
            const glm::dvec3 d = glm::normalize(glm::dvec3(gauss(random_), gauss(random_), gauss(random_)));
            if (glm::dot(d, axis) > least_cosine) return d;
        }
    }

    /// Voxels of a sphere about the origin, each with a kd of its own and seen from random directions.
    std::vector<FilledRecord> sphere(uint32_t label, const Ward& gloss, uint32_t voxels = kVoxels,
                                     float radius_m = 0.4f) {
        std::uniform_real_distribution<double> level(0.05, 0.5);
        std::vector<FilledRecord> records;
        while (records.size() < voxels) {
            const glm::vec3 normal(direction_about({0, -1, 0}, 0.2));
            const glm::ivec3 voxel(glm::floor(radius_m * normal / map_.settings().voxel_m));
            if (!used_.insert({voxel.x, voxel.y, voxel.z}).second) continue;
            FilledRecord record{radius_m * normal, normal, label, {}};
            const reference::SurfacePoint point{glm::dvec3(kept_point_m(map_, record)), glm::dvec3(normal)};
            const Ward material{{level(random_), level(random_), level(random_)}, gloss.ks, gloss.alpha};
            while (record.observations.size() < gpu::kMaxObservations) {
                const glm::dvec3 direction = direction_about(point.normal, 0.3);
                const glm::dvec3 rgb =
                    reference::shade(material, point, received(), glm::dvec3(0.05, 0.04, 0.03), direction);
                record.observations.push_back({glm::vec3(direction), glm::vec3(rgb), {}});
            }
            records.push_back(record);
        }
        return records;
    }

    /// Puts voxels into the map; each label keeps its own, in the order of `kept`.
    void fill(const std::vector<FilledRecord>& records) {
        std::vector<std::vector<uint32_t>> kept(kLabels);
        for (uint32_t i = 0; i < records.size(); ++i) kept[records[i].label].push_back(i);
        if (backwards_) std::ranges::for_each(kept, [](auto& of_label) { std::ranges::reverse(of_label); });
        ReflectanceSettings settings;
        settings.shadows = false;
        settings.first_marched_records = 1u << 20;
        rig_.update(settings, [&](graph::Frame& frame, ObservationMapIds& ids) {
            add_fill_records(frame, map_, ids, records);
            add_keep_records(frame, samples_, kept);
            return add_list_records(frame, static_cast<uint32_t>(records.size()));
        });
    }

    /// What no light reaches.
    void shadow_all() {
        graph::Frame frame = runner().begin();
        frame.keep(frame.fill(map_.import(frame).visibility, 0));
        run(std::move(frame));
    }

    /// What the network is taken to have said.
    void set_network(uint32_t label, glm::vec4 ks_alpha) {
        graph::Frame frame = runner().begin();
        const gpu::WardMaterial said{glm::vec4(0.2f, 0.2f, 0.2f, 5), ks_alpha};
        frame.keep(frame.upload_bytes(estimates_.import(frame).materials, label * sizeof(said),
                                      std::as_bytes(std::span(&said, 1)), false));
        run(std::move(frame));
    }

    /// Fits the segments so many times; by label.
    std::vector<gpu::WardFit> fit(const std::vector<uint32_t>& labels, uint32_t times = 1) {
        std::vector<gpu::WardFit> fits;
        for (uint32_t i = 0; i < times; ++i) {
            std::vector<uint32_t> list{static_cast<uint32_t>(labels.size())};
            list.insert(list.end(), labels.begin(), labels.end());
            graph::Frame frame = runner().begin();
            const ObservationMapIds records = map_.import(frame);
            const FitWardInputs inputs{map_,
                                       records,
                                       rig_.state().import(frame).status,
                                       rig_.lights.upload(frame),
                                       rig_.lights.position_version(),
                                       samples_,
                                       samples_.import(frame),
                                       estimates_.import(frame).materials,
                                       kLabels};
            WardFitIds ids = table_.import(frame);
            graph::BufferId materials = rig_.materials.import(frame);
            add_fit_ward(frame, inputs, {frame.upload<uint32_t>("batch", list), list[0]}, table_, ids, materials);
            WardFits::keep(frame, ids);
            frame.keep(materials);
            const graph::Readback read = frame.read_back(ids.fits), read_materials = frame.read_back(materials);
            runner().submit(std::move(frame));
            runner().wait();
            fits = read.as<gpu::WardFit>();
            materials_ = read_materials.as<gpu::SegmentMaterial>();
        }
        return fits;
    }

    std::array<int, 3> voxel_of(const FilledRecord& record) const {
        const glm::ivec3 voxel(glm::floor(record.point_m / map_.settings().voxel_m));
        return {voxel.x, voxel.y, voxel.z};
    }

    /// FittedVoxel::blur2 of each record, from the records of the same face whose voxels touch.
    std::vector<double> blur2_of(const std::vector<FilledRecord>& records) const {
        std::map<std::array<int, 3>, glm::dvec3> normals;
        for (const FilledRecord& record : records) normals[voxel_of(record)] = glm::dvec3(record.normal);
        std::vector<double> blur2;
        for (const FilledRecord& record : records) {
            double sum = 0;
            int count = 0;
            for (size_t axis = 0; axis < 3; ++axis) {
                for (const int step : {-1, 1}) {
                    std::array<int, 3> beside = voxel_of(record);
                    beside[axis] += step;
                    const auto found = normals.find(beside);
                    if (found == normals.end() || glm::dot(found->second, glm::dvec3(record.normal)) < 0.5) continue;
                    sum += 2 - 2 * glm::dot(found->second, glm::dvec3(record.normal));
                    ++count;
                }
            }
            blur2.push_back(
                count == 0 ? 0 : std::pow(std::min(gpu::kFitBlurM / map_.settings().voxel_m, 1.0f), 2) * sum / count);
        }
        return blur2;
    }

    /// What the reference finds with each of so many fits.
    std::vector<Ward> reference_fits(const std::vector<FilledRecord>& records, uint32_t times = 1,
                                     const std::vector<double>& blur2 = {}) const {
        std::vector<reference::FittedVoxel> voxels;
        for (const FilledRecord& record : records) {
            voxels.push_back({{glm::dvec3(kept_point_m(map_, record)), glm::dvec3(record.normal)}, {}, received()});
            if (!blur2.empty()) voxels.back().blur2 = blur2[voxels.size() - 1];
            for (const FilledObservation& seen : record.observations)
                voxels.back().observations.push_back({glm::dvec3(seen.to_viewer), glm::dvec3(seen.rgb), seen.clipped});
        }
        reference::WardFitSeries series({});
        std::vector<Ward> fits;
        for (uint32_t i = 0; i < times; ++i) fits.push_back(series.fit(voxels));
        return fits;
    }

    std::mt19937 random_{1};
    std::set<std::array<int, 3>> used_;  // a voxel has one record
    bool backwards_ = false;
    VoxelMap voxel_map_{device(), {.capacity_blocks = 64}};
    // Several chunks of 256 records.
    ObservationMap map_{device(),
                        {.capacity_blocks = 256, .capacity_records = 1024, .max_chunk_bytes = uint64_t{1} << 15}};
    ReflectanceRig rig_{device(), runner(), voxel_map_, map_};
    SegmentSamples samples_{device(), kLabels};
    SpecularEstimates estimates_{device(), kLabels};
    WardFits table_{device(), kLabels};
    std::vector<gpu::SegmentMaterial> materials_;
};

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
    const std::vector<Ward> want = reference_fits(records, 3);
    EXPECT_GT(max_of(want[0].ks), 0.05) << "a highlight was there to be found";
    for (size_t i = 0; i < want.size(); ++i) {
        const glm::vec4 got = fit({3})[3].ks_alpha;
        EXPECT_LT(max_of(glm::abs(glm::dvec3(got) - want[i].ks)), 2e-4) << i;
        EXPECT_NEAR(got.w, want[i].alpha, 2e-4) << i;
    }
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
    graph::Frame frame = runner().begin();
    table_.reset(frame);
    run(std::move(frame));
    const gpu::WardFit got = fit({1})[1];
    EXPECT_NEAR(got.ks_alpha.w, truth.alpha, 0.03 * truth.alpha);
    EXPECT_LT(max_of(glm::abs(glm::dvec3(got.ks_alpha) - truth.ks)), 0.05 * 0.05);

    records.resize(blur2.size());
    const std::vector<Ward> want = reference_fits(records, 3, blur2);
    EXPECT_LT(max_of(glm::abs(glm::dvec3(got.ks_alpha) - want[0].ks)), 2e-4);
    EXPECT_NEAR(got.ks_alpha.w, want[0].alpha, 2e-4);
    // Were the highlights that weights are about not blurred, these would be 1.0e-4 and 1.2e-4.
    const glm::vec4 later = fit({1}, 2)[1].ks_alpha;
    EXPECT_LT(max_of(glm::abs(glm::dvec3(later) - want[2].ks)), 7.5e-5);
    EXPECT_NEAR(later.w, want[2].alpha, 9e-5);

    EXPECT_NEAR(fit({1}, 3)[1].ks_alpha.w, truth.alpha, 0.03 * truth.alpha) << "when the estimate tells outliers, too";
}

TEST_F(FitWardTest, KeepsThePriorWhereNoObservationTells) {
    // A floor, seen from far off every mirrored light.
    std::vector<FilledRecord> records = sphere(1, {{}, glm::dvec3(0.2), 0.05});
    for (FilledRecord& record : records) {
        std::erase_if(record.observations, [&](const FilledObservation& seen) {
            return std::ranges::any_of(kLights, [&](const PointLight& light) {
                const glm::vec3 half =
                    glm::normalize(glm::normalize(light.position_m - record.point_m) + seen.to_viewer);
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

TEST_F(FitWardTest, TheNetworksWordGivesWayToObservations) {
    const Ward truth{{}, glm::dvec3(0.1), 0.15};
    fill(sphere(1, truth));
    set_network(1, {0.2f, 0.2f, 0.2f, 0.3f});
    const gpu::WardFit fitted = fit({1}, 4)[1];
    EXPECT_LT(max_of(glm::abs(glm::dvec3(fitted.ks_alpha) - truth.ks)), 2e-3);
    EXPECT_NEAR(fitted.ks_alpha.w, truth.alpha, 2e-3);
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

TEST_F(FitWardTest, ClippedChannelsAndWildObservationsChangeLittle) {
    const Ward truth{{}, {0.1, 0.12, 0.14}, 0.12};
    std::vector<FilledRecord> records = sphere(1, truth);
    for (FilledRecord& record : records) {
        for (FilledObservation& seen : record.observations) {
            for (size_t c = 0; c < 3; ++c) {
                float& level = seen.rgb[static_cast<glm::length_t>(c)];
                seen.clipped[c] = level > 0.6f;
                level = std::min(level, 0.6f);
            }
            if (random_() % 20 == 0) seen.rgb *= 3.0f;
        }
    }
    fill(records);
    const glm::vec4 got = fit({1}, 25)[1].ks_alpha;
    EXPECT_LT(max_of(glm::abs(glm::dvec3(got) - truth.ks)), 0.01);
    EXPECT_NEAR(got.w, truth.alpha, 0.01);
}

TEST_F(FitWardTest, TheFlanksOfClippedHighlightsTellTheirPeaks) {
    // Peaks are many times as bright as what the camera records. Taken as recorded they would hold ks down to 0.12.
    const Ward truth{{}, {0.3, 0.25, 0.2}, 0.06};
    std::vector<FilledRecord> records = sphere(1, truth, 200);
    size_t clipped = 0;
    for (FilledRecord& record : records) {
        for (FilledObservation& seen : record.observations) {
            for (glm::length_t c = 0; c < 3; ++c) {
                seen.clipped[static_cast<size_t>(c)] = seen.rgb[c] > 0.6f;
                seen.rgb[c] = std::min(seen.rgb[c], 0.6f);
                clipped += seen.clipped[static_cast<size_t>(c)];
            }
        }
    }
    ASSERT_GT(clipped, 300u);
    fill(records);
    for (const uint32_t times : {2u, 20u}) {
        const glm::vec4 got = fit({1}, times)[1].ks_alpha;
        EXPECT_LT(max_of(glm::abs(glm::dvec3(got) - truth.ks) / truth.ks), 0.02) << times;
        EXPECT_NEAR(got.w, truth.alpha, 0.01 * truth.alpha) << times;
    }
}

TEST_F(FitWardTest, LaterFitsAgreeWithTheReferenceOnClippedAndWildObservations) {
    constexpr float kClip = 0.2f;
    const Ward truth{{}, {0.3, 0.25, 0.2}, 0.06};
    std::vector<FilledRecord> records = sphere(1, truth, 15);
    std::normal_distribution<float> noise(0, 0.03f);
    for (FilledRecord& record : records) {
        for (FilledObservation& seen : record.observations) {
            seen.rgb *= 1 + noise(random_);
            if (random_() % 15 == 0) seen.rgb *= 1.7f;
            for (glm::length_t c = 0; c < 3; ++c) {
                seen.clipped[static_cast<size_t>(c)] = seen.rgb[c] > kClip;
                seen.rgb[c] = std::min(seen.rgb[c], kClip);
            }
        }
    }
    fill(records);
    const std::vector<Ward> want = reference_fits(records, 4);
    EXPECT_GT(max_of(glm::abs(want[1].ks - want[0].ks)), 0.015) << "clipped channels count from the second on";
    for (size_t i = 0; i < want.size(); ++i) {
        const gpu::WardFit got = fit({1})[1];
        EXPECT_LT(max_of(glm::abs(glm::dvec3(got.ks_alpha) - want[i].ks)), 2.5e-3) << i;
        EXPECT_NEAR(got.ks_alpha.w, want[i].alpha, 2.5e-4) << i;
    }
}

TEST_F(FitWardTest, RoughNormalsAndClippedPeaksTellKs) {
    // Normals are off by some degrees, as those of a volume, and peaks are clipped. Did dark observations count for
    // more than bright ones, those that miss a highlight would say that it is weaker: ks would be 0.105.
    const Ward truth{{}, glm::dvec3(0.15), 0.1};
    std::vector<FilledRecord> records = sphere(1, truth);
    std::normal_distribution<float> error(0, 0.03f);
    for (FilledRecord& record : records) {
        record.normal = glm::normalize(record.normal + glm::vec3(error(random_), error(random_), error(random_)));
        for (FilledObservation& seen : record.observations) {
            for (glm::length_t c = 0; c < 3; ++c) {
                seen.clipped[static_cast<size_t>(c)] = seen.rgb[c] > 0.8f;
                seen.rgb[c] = std::min(seen.rgb[c], 0.8f);
            }
        }
    }
    fill(records);
    const glm::vec4 got = fit({1}, 25)[1].ks_alpha;
    EXPECT_LT(max_of(glm::abs(glm::dvec3(got) - truth.ks)), 0.025);
    EXPECT_NEAR(got.w, truth.alpha, 0.01);
}

TEST_F(FitWardTest, AChannelThatAllViewsClipCostsTheOthersNothing) {
    const Ward truth{{}, glm::dvec3(0.1), 0.15};
    std::vector<FilledRecord> records = sphere(1, truth);
    for (FilledRecord& record : records) {
        record.observations.resize(20);
        for (FilledObservation& seen : record.observations) {
            seen.clipped[2] = true;
            seen.rgb.b = 1;
        }
    }
    fill(records);
    const gpu::WardFit first = fit({1}, 1)[1];
    ASSERT_GT(first.confidence, 0.5f);
    EXPECT_EQ(first.color2_weight.w, 2.0f * 20 * kVoxels) << "two channels of each observation";
    const gpu::WardFit later = fit({1}, 4)[1];
    EXPECT_NEAR(later.color2_weight.w, 4.347f * first.color2_weight.w, 0.01f * first.color2_weight.w)
        << "0.93 of them are kept each time";
    EXPECT_EQ(later.color2_weight.b, 0);
    EXPECT_NEAR(later.ks_alpha.r, 0.1, 2e-3);
    EXPECT_NEAR(later.ks_alpha.g, 0.1, 2e-3);
    EXPECT_NEAR(later.ks_alpha.w, 0.15, 2e-3);
}

TEST_F(FitWardTest, AFewWrongNormalsDoNotRuleAHighlightOut) {
    // Seen from far off every mirrored light, but for two voxels, whose normals are wrong: they would show a peak, and
    // do not.
    std::vector<FilledRecord> records = sphere(1, {{}, glm::dvec3(0.2), 0.05});
    uint32_t wrong = 0;
    for (size_t i = 0; i < records.size(); ++i) {
        const auto shows_peak = [&](const FilledObservation& seen) {
            return std::ranges::any_of(kLights, [&](const PointLight& light) {
                const glm::vec3 to_light = glm::normalize(light.position_m - records[i].point_m);
                return glm::dot(glm::normalize(to_light + seen.to_viewer), records[i].normal) > std::cos(0.7f);
            });
        };
        std::erase_if(records[i].observations, shows_peak);
        if (wrong == 2 || records[i].observations.empty()) continue;
        ++wrong;
        const glm::vec3 to_light = glm::normalize(kLights[0].position_m - records[i].point_m);
        records[i].normal = glm::normalize(to_light + records[i].observations.front().to_viewer);
    }
    fill(records);
    ASSERT_EQ(wrong, 2u);
    const gpu::WardFit fitted = fit({1}, 3)[1];
    EXPECT_GT(max_of(glm::dvec3(fitted.ks_alpha)), 0.02);
    EXPECT_LT(fitted.confidence, 0.5f);
}

TEST_F(FitWardTest, TheOrderInWhichVoxelsAreKeptChangesNothing) {
    std::vector<FilledRecord> records = sphere(1, {{}, glm::dvec3(0.1), 0.15});
    fill(records);
    const gpu::WardFit one = fit({1})[1];
    graph::Frame frame = runner().begin();
    table_.reset(frame);
    run(std::move(frame));
    backwards_ = true;
    fill(records);
    const gpu::WardFit other = fit({7, 1})[1];
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
}  // namespace patina
