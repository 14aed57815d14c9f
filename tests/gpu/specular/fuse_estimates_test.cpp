#include "passes/specular/fuse_estimates.h"

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "passes/specular/perceptual.h"
#include "tests/gpu/gpu_test.h"

namespace patina::fuse_estimates_test {
namespace {

class FuseEstimates : public GpuTest {
  protected:
    static constexpr uint32_t kLabels = 8;

    struct Known {
        std::vector<gpu::PerceptualMaterial> means;
        std::vector<gpu::WardMaterial> materials;

        Perceptual mean(uint32_t label) const {
            const gpu::PerceptualMaterial& m = means[label];
            return {m.lab_cr[0],       m.lab_cr[1],       m.lab_cr[2],      m.lab_cr[3],
                    m.cgb_d_weight[0], m.cgb_d_weight[1], m.cgb_d_weight[2]};
        }
        float weight(uint32_t label) const { return means[label].cgb_d_weight.w; }
    };

    void SetUp() override {
        graph::FrameGraph frame = runner().begin();
        table_.reset(frame);
        run(std::move(frame));
    }

    static gpu::PerceptualMaterial packed(const Perceptual& w) {
        const auto f = [&](size_t i) { return static_cast<float>(w[i]); };
        return {{f(0), f(1), f(2), f(3)}, {f(4), f(5), f(6), std::numeric_limits<float>::quiet_NaN()}};
    }

    /// One batch; `unseen` labels had no voxel to draw.
    Known fuse(const std::vector<std::pair<uint32_t, Perceptual>>& batch, float weight = 1, uint32_t unseen = 0) {
        std::vector<uint32_t> list{static_cast<uint32_t>(batch.size())}, drawn;
        std::vector<gpu::PerceptualMaterial> estimates;
        for (const auto& [label, w] : batch) {
            list.push_back(label);
            estimates.push_back(packed(w));
            drawn.insert(drawn.end(), gpu::kHemiSamples, label == unseen ? gpu::kNoRecord : 0);
        }
        graph::FrameGraph frame = runner().begin();
        SpecularEstimateIds ids = table_.import(frame);
        add_fuse_estimates(frame, {frame.upload<uint32_t>("batch", list), list[0]},
                           frame.upload<gpu::PerceptualMaterial>("estimates", estimates),
                           frame.upload<uint32_t>("drawn", drawn), table_, ids, weight);
        SpecularEstimates::keep(frame, ids);
        const graph::Readback means = frame.read_back(ids.means), materials = frame.read_back(ids.materials);
        runner().submit(std::move(frame));
        runner().wait();
        return {means.as<gpu::PerceptualMaterial>(), materials.as<gpu::WardMaterial>()};
    }

    SpecularEstimates table_{device(), kLabels};
};

constexpr Perceptual kOne{0.5, 0.1, -0.1, 0.1, 0.2, 0.05, 0.9}, kOther{0.3, 0.2, 0.1, 0.3, 0.1, 0.05, 0.5};

TEST_F(FuseEstimates, TheFirstIsTakenAndOthersJoinTheMeanByTheirWeight) {
    Known known = fuse({{3, kOne}, {5, kOther}});
    for (size_t i = 0; i < 7; ++i) {
        EXPECT_NEAR(known.mean(3)[i], kOne[i], 1e-6);
        EXPECT_NEAR(known.mean(5)[i], kOther[i], 1e-6);
    }
    known = fuse({{3, kOther}}, 3);
    for (size_t i = 0; i < 7; ++i) {
        EXPECT_NEAR(known.mean(3)[i], 0.25 * kOne[i] + 0.75 * kOther[i], 1e-6);
        EXPECT_NEAR(known.mean(5)[i], kOther[i], 1e-6) << "not in the batch";
    }
    EXPECT_EQ(known.weight(3), 4);
    EXPECT_EQ(known.weight(5), 1);
    EXPECT_EQ(known.weight(4), 0);
    EXPECT_EQ(known.materials[4].kd_weight, glm::vec4(0));
}

TEST_F(FuseEstimates, TheWeightStopsAtItsLimitSoThatTheNewestCountMore) {
    Known known = fuse({{1, kOne}}, 59);
    known = fuse({{1, kOne}}, 5);
    EXPECT_EQ(known.weight(1), gpu::kMostEstimateWeight);
    known = fuse({{1, kOther}});
    for (size_t i = 0; i < 7; ++i) EXPECT_NEAR(known.mean(1)[i], (60 * kOne[i] + kOther[i]) / 61, 1e-6);
    EXPECT_EQ(known.weight(1), 60);
}

TEST_F(FuseEstimates, MaterialsAreWhatTheMeansStandFor) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> level(0, 1);
    std::map<uint32_t, std::pair<Perceptual, double>> expected;
    Known known;
    for (int frame = 0; frame < 12; ++frame) {
        std::vector<std::pair<uint32_t, Perceptual>> batch;
        const double weight = 1 + frame % 3 * 10;
        for (uint32_t label = 1; label < kLabels; ++label) {
            if (random() % 3 == 0) continue;
            const Perceptual w = perceptual_of({{level(random), level(random), level(random)},
                                                0.4 * glm::dvec3(level(random), level(random), level(random)),
                                                0.03 + 0.4 * level(random)});
            batch.emplace_back(label, w);
            auto& [mean, sum] = expected[label];
            for (size_t i = 0; i < 7; ++i) mean[i] = (sum * mean[i] + weight * w[i]) / (sum + weight);
            sum = std::min(sum + weight, 60.0);
        }
        known = fuse(batch, static_cast<float>(weight));
    }
    for (const auto& [label, mean_and_sum] : expected) {
        const auto& [mean, sum] = mean_and_sum;
        EXPECT_EQ(known.weight(label), sum);
        const WardParameters material = ward_of(mean);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(known.materials[label].kd_weight[c], material.kd[c], 1e-5);
            EXPECT_NEAR(known.materials[label].ks_alpha[c], material.ks[c], 1e-5);
        }
        EXPECT_NEAR(known.materials[label].ks_alpha.w, material.alpha, 1e-5);
        EXPECT_EQ(known.materials[label].kd_weight.w, sum);
    }
}

TEST_F(FuseEstimates, WhatSaysNothingChangesNothing) {
    fuse({{1, kOne}, {2, kOne}});
    Perceptual wild = kOther;
    wild[6] = std::numeric_limits<double>::infinity();
    const Known known = fuse({{1, wild}, {2, kOther}, {kLabels, kOther}, {70000, kOther}}, 1, 2);
    for (const uint32_t label : {1u, 2u}) {
        EXPECT_EQ(known.weight(label), 1) << label;
        for (size_t i = 0; i < 7; ++i) EXPECT_NEAR(known.mean(label)[i], kOne[i], 1e-6);
    }
    EXPECT_THROW(fuse({{1, kOne}}, 0), Error);
}

}  // namespace
}  // namespace patina::fuse_estimates_test
