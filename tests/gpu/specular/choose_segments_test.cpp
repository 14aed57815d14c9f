#include "passes/specular/choose_segments.h"

#include <map>
#include <set>

#include "passes/state/segment_materials.h"
#include "shared/segmentation/segment_samples.h"
#include "shared/segmentation/segments.h"
#include "tests/gpu/gpu_test.h"

namespace patina::choose_segments_test {
namespace {

class ChooseSegmentsTest : public GpuTest {
  protected:
    static constexpr uint32_t kLabels = 300;

    ChooseSegmentsTest() : labels_(kLabels), counts_(kLabels) {
        graph::FrameGraph frame = runner().begin();
        estimates_.reset(frame);
        table_.reset(frame);
        materials_.import(frame);
        run(std::move(frame));
    }

    void start(uint32_t label) { labels_[label] = {gpu::kLiveLabel, stamp_, stamp_, 0, 0, 0, 0, 0}; }

    /// One frame that changes so many records of each label; returns the labels that it estimates.
    std::vector<uint32_t> choose(const std::map<uint32_t, uint32_t>& changes, uint32_t capacity) {
        std::vector<gpu::VoxelRecord> records;
        for (const auto& [label, count] : changes) records.resize(records.size() + count, {0, 0, 0, label});
        std::vector<uint32_t> list{static_cast<uint32_t>(records.size())};
        for (uint32_t i = 0; i < records.size(); ++i) list.push_back(i);
        records.resize(records.size() + 1);
        const std::vector<uint32_t> groups{1 + list[0] / gpu::kRecordGroup, 1, 1, 0};

        graph::FrameGraph frame = runner().begin();
        SpecularMaterialIds ids{estimates_.import(frame), table_.import(frame), materials_.import(frame)};
        const ChosenSegments chosen =
            add_choose_segments(frame,
                                {frame.upload<gpu::VoxelRecord>("records", records),
                                 {frame.upload<uint32_t>("list", list), frame.upload<uint32_t>("groups", groups)},
                                 frame.upload<gpu::SegmentLabel>("labels", labels_),
                                 frame.upload<gpu::SegmentSampleCount>("counts", counts_),
                                 kLabels,
                                 kLabels,
                                 stamp_++},
                                capacity, ids);
        SpecularEstimates::keep(frame, ids.estimates);
        WardFits::keep(frame, ids.fits);
        frame.keep(ids.materials);
        const graph::Readback read = frame.read_back(chosen.all.list), doubts = frame.read_back(chosen.doubtful.list),
                              fits = frame.read_back(ids.fits.fits), means = frame.read_back(ids.estimates.means),
                              materials = frame.read_back(ids.materials);
        runner().submit(std::move(frame));
        runner().wait();
        fits_ = fits.as<gpu::WardFit>();
        means_ = means.as<gpu::PerceptualMaterial>();
        set_ = materials.as<gpu::SegmentMaterial>();
        doubtful_ = labels_in(doubts);
        return labels_in(read);
    }

    static std::vector<uint32_t> labels_in(const graph::Readback& list) {
        const auto words = list.as<uint32_t>();
        return {words.begin() + 1, words.begin() + 1 + words[0]};
    }

    /// Something to be forgotten.
    void estimate(uint32_t label, float confidence = 1) {
        graph::FrameGraph frame = runner().begin();
        const gpu::WardFit fit{glm::vec4(1), glm::vec4(1), confidence,  1, 5, 0,
                               glm::vec4(1), glm::vec4(1), glm::vec4(0)};
        const gpu::PerceptualMaterial mean{glm::vec4(1), glm::vec4(1)};
        frame.keep(frame.upload_bytes(table_.import(frame).fits, label * sizeof(fit), std::as_bytes(std::span(&fit, 1)),
                                      false));
        frame.keep(frame.upload_bytes(estimates_.import(frame).means, label * sizeof(mean),
                                      std::as_bytes(std::span(&mean, 1)), false));
        run(std::move(frame));
        materials_.set(label, glm::vec3(0.2f), 0.3f);
        graph::FrameGraph upload = runner().begin();
        materials_.import(upload);
        run(std::move(upload));
    }

    uint32_t stamp_ = 1;
    std::vector<uint32_t> doubtful_;  ///< of those that were chosen last
    std::vector<gpu::SegmentLabel> labels_;
    std::vector<gpu::SegmentSampleCount> counts_;
    std::vector<gpu::WardFit> fits_;
    std::vector<gpu::PerceptualMaterial> means_;
    std::vector<gpu::SegmentMaterial> set_;
    SpecularEstimates estimates_{device(), kLabels};
    WardFits table_{device(), kLabels};
    SegmentMaterials materials_{device(), kLabels};
};

TEST_F(ChooseSegmentsTest, TakesWhatChangedMostAndHasSamples) {
    for (const uint32_t label : {3u, 7u, 130u, 200u, 299u}) {
        start(label);
        counts_[label].kept = 40;
    }
    counts_[7].kept = 0;
    labels_[299].state = gpu::kRetiredLabel;
    EXPECT_EQ(choose({{3, 5}, {7, 90}, {130, 20}, {200, 70}, {299, 80}}, 1), std::vector<uint32_t>{200});
    EXPECT_EQ(choose({}, 1), std::vector<uint32_t>{130}) << "what has changed before still counts";
    EXPECT_EQ(choose({{200, 1}}, 8), (std::vector<uint32_t>{3, 200}));
    EXPECT_TRUE(choose({}, 8).empty());
}

TEST_F(ChooseSegmentsTest, NoneStarves) {
    for (uint32_t label = 1; label <= 20; ++label) {
        start(label);
        counts_[label].kept = 40;
    }
    std::map<uint32_t, uint32_t> changes;
    for (uint32_t label = 1; label <= 20; ++label) changes[label] = label <= 4 ? 100 : 1;
    std::map<uint32_t, uint32_t> times;
    for (int frame = 0; frame < 20; ++frame) {
        const auto chosen = choose(changes, 4);
        EXPECT_EQ(std::set<uint32_t>(chosen.begin(), chosen.end()).size(), 4u);
        for (const uint32_t label : chosen) ++times[label];
    }
    for (uint32_t label = 1; label <= 20; ++label) EXPECT_GE(times[label], 1u) << label;
    EXPECT_GT(times[1], times[20]);
}

TEST_F(ChooseSegmentsTest, WhatTheFitIsSureOfIsNotDoubtful) {
    std::map<uint32_t, uint32_t> changes;
    for (uint32_t label = 1; label <= 4; ++label) {
        start(label);
        counts_[label].kept = 40;
        changes[label] = 10 * label;
    }
    choose(changes, 4);
    EXPECT_EQ(doubtful_.size(), 4u) << "nothing was fitted yet";
    estimate(1, 0.5f * gpu::kAskedBelowConfidence);
    estimate(2, 1.01f * gpu::kAskedBelowConfidence);
    estimate(4, gpu::kAskedBelowConfidence);
    EXPECT_EQ(choose(changes, 4), (std::vector<uint32_t>{4, 1, 3, 2}));
    EXPECT_EQ(doubtful_, (std::vector<uint32_t>{1, 3}));
    EXPECT_EQ(choose({{2, 1}, {4, 2}}, 4).size(), 2u);
    EXPECT_TRUE(doubtful_.empty());
    estimate(2, 0.5f);
    EXPECT_EQ(choose({{2, 1}, {4, 2}}, 4).size(), 2u);
    EXPECT_EQ(doubtful_, std::vector<uint32_t>{2}) << "it is not sure any more";
    estimate(2);
    start(4);
    EXPECT_EQ(choose({{2, 1}, {4, 2}}, 4).size(), 2u);
    EXPECT_EQ(doubtful_, std::vector<uint32_t>{4}) << "another object has its label";
}

TEST_F(ChooseSegmentsTest, ALabelThatIsHandedOutAnewForgets) {
    for (const uint32_t label : {5u, 6u}) {
        start(label);
        counts_[label].kept = 40;
    }
    choose({{5, 1}, {6, 1}}, 4);
    estimate(5);
    estimate(6);
    choose({}, 4);
    EXPECT_EQ(fits_[5].estimates, 5u);
    const uint32_t version = set_[5].version;
    start(5);
    choose({{5, 1}}, 4);
    EXPECT_EQ(fits_[5].estimates, 0u);
    EXPECT_EQ(means_[5].cgb_d_weight.w, 0);
    EXPECT_EQ(set_[5].ks_alpha.r, 0);
    EXPECT_NE(set_[5].version, version) << "albedos are computed anew";
    EXPECT_EQ(fits_[6].estimates, 5u);
    EXPECT_EQ(set_[6].ks_alpha.r, 0.2f);
}

}  // namespace
}  // namespace patina::choose_segments_test
