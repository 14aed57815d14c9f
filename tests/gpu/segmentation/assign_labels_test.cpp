#include "passes/segmentation/assign_labels.h"

#include <algorithm>
#include <array>
#include <random>

#include "shared/segmentation/segment_samples.h"
#include "shared/specular/ward_fit.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/segmentation/segment_table.h"

namespace patina::assign_labels_test {
namespace {

using reference::SeenSegment;
using reference::SegmentBook;
using ::testing::Each;
using ::testing::ElementsAre;

class AssignLabels : public GpuTest {
  protected:
    void start(uint32_t capacity) {
        params_ = {};
        params_.capacity = capacity;
        params_.overlap_slots = 4096;
        params_.inherit_share = 0.3f;
        params_.inherit_pixels = 15;
        params_.merge_share = 0.2f;
        params_.merge_count = 3;
        params_.merge_chroma = 0.03f;
        params_.merge_brightness = 1.4f;
        params_.merge_ks = 0.1f;
        params_.merge_alpha = 2;
        params_.new_pixels = 100;
        params_.prune_voxels = 10;
        params_.prune_frames = 30;
        table_.emplace(device(), capacity);
        kd_.assign(capacity, {});
        fits_.assign(1, {});
        graph::FrameGraph frame = runner().begin();
        table_->reset(frame);
        run(std::move(frame));
    }

    /// One frame: labels by segment. `keys`: given ids.
    std::vector<uint32_t> assign(const std::vector<SeenSegment>& seen, const std::vector<uint32_t>& keys = {}) {
        ++params_.stamp;
        graph::FrameGraph frame = runner().begin();
        SegmentTableIds ids = table_->import(frame);
        const auto uniforms = frame.upload<gpu::SegmentationParams>("params", std::span(&params_, 1));
        const FrameSegments segments = upload_segments(frame, seen, keys);
        KnownMaterials materials{frame.upload<gpu::SegmentKd>("kd", std::span(std::as_const(kd_))),
                                 frame.upload<gpu::WardFit>("fits", std::span(std::as_const(fits_)))};
        const graph::Readback read =
            frame.read_back(add_assign_labels(frame, ids, segments, upload_overlaps(frame, seen), materials, uniforms));
        const graph::Readback counters = frame.read_back(ids.counters), kd = frame.read_back(materials.kd);
        SegmentTable::keep(frame, ids);
        run(std::move(frame));
        counters_ = counters.as<gpu::SegmentCounters>().front();
        kd_ = kd.as<gpu::SegmentKd>();
        auto labels = read.as<uint32_t>();
        labels.erase(labels.begin());
        labels.resize(seen.size());
        return labels;
    }

    /// Changes what is known of labels between frames.
    template <class Change>
    void change(Change&& change) {
        graph::FrameGraph frame = runner().begin();
        const graph::Readback read = frame.read_back(table_->import(frame).labels);
        run(std::move(frame));
        auto labels = read.as<gpu::SegmentLabel>();
        for (uint32_t label = 1; label < labels.size(); ++label) change(label, labels[label]);
        frame = runner().begin();
        frame.keep(frame.upload_bytes(table_->import(frame).labels, 0, std::as_bytes(std::span(labels)), true));
        run(std::move(frame));
    }

    /// Makes partners of two labels, as a split does.
    void pair(uint32_t own, uint32_t beyond) {
        std::vector<uint32_t> partners = read(&SegmentTableIds::partners).as<uint32_t>();
        auto rules = read(&SegmentTableIds::rules).as<gpu::SplitRule>();
        partners[own] = beyond;
        partners[beyond] = own;
        rules[own] = {1, 0, 0.4f, 0};
        rules[beyond] = {1, 0, 0.4f, 1};
        graph::FrameGraph frame = runner().begin();
        const SegmentTableIds ids = table_->import(frame);
        frame.keep(frame.upload_bytes(ids.partners, 0, std::as_bytes(std::span(partners)), true));
        frame.keep(frame.upload_bytes(ids.rules, 0, std::as_bytes(std::span(rules)), true));
        run(std::move(frame));
    }
    std::vector<uint32_t> partners() { return read(&SegmentTableIds::partners).as<uint32_t>(); }

    graph::Readback read(graph::BufferId SegmentTableIds::*buffer) {
        graph::FrameGraph frame = runner().begin();
        graph::Readback read = frame.read_back(table_->import(frame).*buffer);
        run(std::move(frame));
        return read;
    }

    void paint_all(uint32_t r, uint32_t g) {
        change([&](uint32_t, gpu::SegmentLabel& label) {
            label.chroma_samples = 1;
            label.chroma_r = r;
            label.chroma_g = g;
        });
    }

    /// Two labels that one segment has covered for three frames, with colours that are alike or not, and what else is
    /// known of their materials. Returns whether they were merged.
    bool merges(bool alike, const std::array<glm::vec3, 2>& kd, uint32_t samples,
                const std::vector<gpu::WardFit>& fits = std::vector<gpu::WardFit>(1)) {
        start(64);
        assign({{500, {}}, {500, {}}});
        paint_all(300, 300);
        if (!alike) change([](uint32_t label, gpu::SegmentLabel& known) { known.chroma_r += label == 2 ? 60 : 0; });
        for (size_t i = 0; i < 2; ++i) {
            const glm::uvec3 sums(kd[i] * (gpu::kKdSteps * static_cast<float>(samples)));
            kd_[1 + i] = {samples, sums.r, sums.g, sums.b};
        }
        fits_ = fits;
        for (int i = 0; i < 3; ++i) assign({{1000, {{1, 400}, {2, 500}}}});
        return counters_.merged > 0;
    }

    gpu::SegmentationParams params_{};
    std::vector<gpu::SegmentKd> kd_;
    std::vector<gpu::WardFit> fits_;
    gpu::SegmentCounters counters_{};
    std::optional<SegmentTable> table_;

  private:
    static FrameSegments upload_segments(graph::FrameGraph& frame, const std::vector<SeenSegment>& seen,
                                         const std::vector<uint32_t>& keys) {
        std::vector<gpu::FrameSegment> segments(gpu::kMaxFrameSegments + 1);
        for (size_t i = 0; i < seen.size(); ++i) {
            segments[i + 1].pixels = seen[i].pixels;
            if (!keys.empty()) segments[i + 1].key = keys[i];
        }
        gpu::FrameSegmentCount count{};
        count.segments = static_cast<uint32_t>(seen.size());
        const std::vector<uint32_t> none(1);
        return {frame.upload("segment", {{1, 1}, vulkan::Format::kR32u}, std::as_bytes(std::span(none))),
                frame.upload<gpu::FrameSegment>("segments", std::span(std::as_const(segments))),
                frame.upload<gpu::FrameSegmentCount>("count", std::span(&std::as_const(count), 1))};
    }

    /// Entries in any order, as they come from a hash table.
    SegmentOverlaps upload_overlaps(graph::FrameGraph& frame, const std::vector<SeenSegment>& seen) {
        std::vector<gpu::SegmentOverlap> entries;
        for (uint32_t i = 0; i < seen.size(); ++i) {
            for (const auto& [label, pixels] : seen[i].shared) entries.push_back({label | (i + 1) << 16, pixels});
        }
        std::shuffle(entries.begin(), entries.end(), random_);
        std::vector<uint32_t> list{static_cast<uint32_t>(entries.size())};
        for (uint32_t i = 0; i < entries.size(); ++i) list.push_back(i);
        entries.resize(params_.overlap_slots);
        return {frame.upload<gpu::SegmentOverlap>("overlaps", std::span(std::as_const(entries))),
                frame.upload<uint32_t>("list", std::span(std::as_const(list)))};
    }

    std::mt19937 random_{1};
};

TEST_F(AssignLabels, NewSegmentsGetLabelsInTheirOrderAndSmallOnesNone) {
    start(64);
    EXPECT_THAT(assign({{500, {}}, {99, {}}, {100, {}}, {3000, {}}}), ElementsAre(1, 0, 2, 3));
    EXPECT_EQ(counters_.live, 3u);
    EXPECT_EQ(counters_.created, 3u);
}

TEST_F(AssignLabels, ANewLabelHasNoPartner) {
    start(64);
    pair(1, 2);
    assign({{500, {}}, {500, {}}});
    EXPECT_EQ(partners()[1], 0u);
    EXPECT_EQ(partners()[2], 0u);
}

TEST_F(AssignLabels, ALabelThatCoversEnoughIsInheritedTheSmallerOneOfEqualOnes) {
    start(64);
    assign({{500, {}}, {500, {}}, {500, {}}});
    EXPECT_THAT(
        assign({{100, {{2, 31}}}, {100, {{2, 30}}}, {40, {{3, 15}}}, {40, {{3, 14}}}, {200, {{3, 80}, {1, 80}}}}),
        ElementsAre(2, 4, 3, 0, 1));
}

TEST_F(AssignLabels, LabelsThatAreOneForThreeFramesAreMergedIfTheirColoursAgree) {
    for (const bool alike : {true, false}) {
        start(64);
        assign({{500, {}}, {500, {}}});
        paint_all(300, 300);
        if (!alike) change([](uint32_t label, gpu::SegmentLabel& known) { known.chroma_r += label == 2 ? 60 : 0; });
        const std::vector<SeenSegment> both{{1000, {{1, 400}, {2, 500}}}};
        EXPECT_THAT(assign(both), ElementsAre(2));
        EXPECT_THAT(assign(both), ElementsAre(2));
        EXPECT_THAT(assign(both), ElementsAre(alike ? 1 : 2)) << "of as much seen the smaller remains";
        EXPECT_EQ(counters_.merged, alike ? 1u : 0u);
        EXPECT_EQ(counters_.live, alike ? 1u : 2u);
    }
}

TEST_F(AssignLabels, TheAlbedoDecidesOnMergingWhereItIsKnownOfBoth) {
    const glm::vec3 grey(0.4f), blue(0.2f, 0.3f, 0.6f);
    EXPECT_TRUE(merges(false, {grey, grey}, 20)) << "coloured light does not matter";
    EXPECT_TRUE(merges(true, {grey, grey * 0.8f}, 20));
    EXPECT_FALSE(merges(true, {grey, grey * 0.6f}, 20)) << "of another brightness";
    EXPECT_FALSE(merges(true, {grey, blue}, 20)) << "of another colour";
    EXPECT_TRUE(merges(true, {grey, grey * 0.6f}, gpu::kLeastKdSamples - 1)) << "too few records to tell";
    EXPECT_TRUE(merges(true, {glm::vec3(0.012f), glm::vec3(0.006f)}, 20)) << "as dark as errors";
}

TEST_F(AssignLabels, SureSpecularFitsHaveToAgree) {
    const glm::vec3 grey(0.4f);
    const auto fit = [](float ks, float alpha, float confidence) {
        return gpu::WardFit{{ks, ks, ks, alpha}, {}, confidence, 0, 1, 0, {}, {}, {}};
    };
    const auto with = [&](const gpu::WardFit& one, const gpu::WardFit& two) {
        return merges(true, {grey, grey}, 20, {{}, one, two});
    };
    EXPECT_TRUE(with(fit(0.2f, 0.1f, 0.9f), fit(0.25f, 0.15f, 0.9f)));
    EXPECT_FALSE(with(fit(0.2f, 0.1f, 0.9f), fit(0.4f, 0.1f, 0.9f))) << "ks";
    EXPECT_FALSE(with(fit(0.2f, 0.1f, 0.9f), fit(0.2f, 0.3f, 0.9f))) << "alpha";
    EXPECT_TRUE(with(fit(0.2f, 0.1f, 0.9f), fit(0.4f, 0.3f, 0.3f))) << "one of them is not sure";
}

TEST_F(AssignLabels, MergedLabelsShareTheirAlbedoAndNewOnesHaveNone) {
    EXPECT_TRUE(merges(true, {glm::vec3(0.4f), glm::vec3(0.5f)}, 20));
    EXPECT_EQ(kd_[1].samples, 40u);
    EXPECT_NEAR(kd_[1].r / (40 * gpu::kKdSteps), 0.45, 1e-3);
    kd_[3] = {9, 1, 1, 1};
    EXPECT_THAT(assign({{500, {}}}), ElementsAre(3));
    EXPECT_EQ(kd_[3].samples, 0u);
}

TEST_F(AssignLabels, OfMergedLabelsTheOneThatMoreWasSeenOfRemains) {
    for (const uint32_t more : {1u, 2u}) {
        start(64);
        assign({{500, {}}, {500, {}}});
        change([&](uint32_t label, gpu::SegmentLabel& known) { known.chroma_samples = label == more ? 40 : 30; });
        uint32_t label = 0;
        for (int i = 0; i < 3; ++i) label = assign({{1000, {{3 - more, 600}, {more, 300}}}})[0];
        EXPECT_EQ(label, more);
    }
}

TEST_F(AssignLabels, ALabelAndItsPartnerAreMergedOnlyIfTheirAlbedosAreKnownToAgree) {
    for (const uint32_t samples : {0u, 7u, 8u}) {
        start(64);
        assign({{500, {}}, {500, {}}});
        paint_all(300, 300);
        pair(1, 2);
        kd_[1] = kd_[2] = {samples, samples * 300, samples * 200, samples * 100};
        for (int i = 0; i < 4; ++i) assign({{1000, {{1, 400}, {2, 500}}}});
        const bool known = samples >= gpu::kLeastKdSamples;
        EXPECT_EQ(counters_.merged, known ? 1u : 0u);
        EXPECT_EQ(partners()[1], known ? 1u : 2u) << "what was split in vain is not split again";
    }
}

TEST_F(AssignLabels, AMergedLabelsPartnerIsThatOfTheOneThatRemains) {
    for (const bool has_one : {false, true}) {
        start(64);
        assign({{500, {}}, {500, {}}, {500, {}}, {500, {}}});
        change([&](uint32_t label, gpu::SegmentLabel& known) { known.chroma_samples = label == 1 ? 40 : 30; });
        pair(2, 3);
        if (has_one) pair(1, 4);
        for (int i = 0; i < 3; ++i) assign({{1000, {{1, 600}, {2, 300}}}});
        ASSERT_EQ(counters_.merged, 1u);
        const std::vector<uint32_t> partners = this->partners();
        EXPECT_EQ(partners[1], has_one ? 4u : 3u);
        EXPECT_EQ(partners[3], has_one ? 0u : 1u) << "nobody's partner is a label that is gone";
        const auto rules = read(&SegmentTableIds::rules).as<gpu::SplitRule>();
        EXPECT_EQ(rules[1].threshold, 0.4f);
        EXPECT_EQ(rules[1].beyond, 0u);
    }
}

TEST_F(AssignLabels, WhatWasGivenUpIsNobodysPartner) {
    start(64);
    assign({{500, {}}, {500, {}}, {500, {}}});
    change([](uint32_t label, gpu::SegmentLabel& known) { known.tally = label == 2 ? 0 : 100; });
    pair(1, 2);
    while (params_.stamp < 4 * gpu::kSweepFrames + 1) {
        change([](uint32_t label, gpu::SegmentLabel& known) { known.tally = label == 2 ? 0 : 100; });
        assign({{500, {{1, 500}}}, {500, {{3, 500}}}});
    }
    EXPECT_EQ(counters_.pruned, 1u);
    EXPECT_EQ(partners()[1], 0u);
    EXPECT_EQ(partners()[2], 0u) << "nor has it one";
}

TEST_F(AssignLabels, WhatWasSplitInVainIsItsOwnPartnerAndSoIsNoOtherThatItJoins) {
    start(64);
    assign({{500, {}}, {500, {}}});
    change([&](uint32_t label, gpu::SegmentLabel& known) { known.chroma_samples = label == 1 ? 40 : 30; });
    pair(2, 2);
    for (int i = 0; i < 3; ++i) assign({{1000, {{1, 600}, {2, 300}}}});
    ASSERT_EQ(counters_.merged, 1u);
    EXPECT_EQ(partners()[1], 0u);
}

TEST_F(AssignLabels, ASegmentThatManyLabelsCoverGetsNoLabelMore) {
    start(64);
    assign({{500, {}}, {500, {}}, {500, {}}, {500, {}}});
    EXPECT_THAT(assign({{200, {{1, 50}, {2, 51}, {3, 50}, {4, 49}}}, {100, {{1, 14}, {2, 14}, {3, 14}, {4, 14}}}}),
                ElementsAre(2, 0));
    EXPECT_EQ(counters_.created, 4u);
}

TEST_F(AssignLabels, LabelsSeenApartAreNotMergedByChance) {
    start(64);
    assign({{500, {}}, {500, {}}});
    paint_all(300, 300);
    for (int i = 0; i < 10; ++i) {
        assign({{1000, {{1, 400}, {2, 500}}}});
        assign({{500, {{1, 400}}}, {500, {{2, 400}}}});
    }
    EXPECT_EQ(counters_.merged, 0u);
}

TEST_F(AssignLabels, ChainsOfMergersEndInOneLabel) {
    start(64);
    assign({{500, {}}, {500, {}}, {500, {}}, {500, {}}});
    paint_all(300, 300);
    std::vector<uint32_t> labels;
    for (int i = 0; i < 3; ++i)
        labels = assign({{900, {{3, 400}, {4, 400}}}, {900, {{2, 400}, {3, 400}}}, {900, {{1, 400}, {2, 400}}}});
    for (int i = 0; i < 6; ++i) {
        graph::FrameGraph frame = runner().begin();
        const graph::Readback read = frame.read_back(table_->import(frame).parents);
        run(std::move(frame));
        const auto parents = read.as<uint32_t>();
        std::vector<SeenSegment> seen(3);
        const uint32_t pairs[3][2] = {{3, 4}, {2, 3}, {1, 2}};
        for (size_t s = 0; s < 3; ++s) {
            seen[s].pixels = 900;
            for (const uint32_t label : pairs[s]) seen[s].shared[parents[label]] += 400;
        }
        labels = assign(seen);
    }
    EXPECT_THAT(labels, Each(labels.front()));
    EXPECT_EQ(counters_.live, 1u);
}

TEST_F(AssignLabels, GivenIdsAreTheLabels) {
    start(64);
    params_.given = 1;
    EXPECT_THAT(assign({{5, {}}, {500, {}}, {500, {}}}, {7, 63, 64}), ElementsAre(7, 63, 0));
    EXPECT_EQ(counters_.live, 2u);
    EXPECT_EQ(counters_.refused, 1u);
    EXPECT_THAT(assign({{500, {}}}, {7}), ElementsAre(7));
    EXPECT_EQ(counters_.live, 2u);
}

TEST_F(AssignLabels, AFrameWithoutSegmentsChangesNothing) {
    start(64);
    assign({{500, {}}});
    EXPECT_THAT(assign({}), ElementsAre());
    EXPECT_EQ(counters_.live, 1u);
}

TEST_F(AssignLabels, AllLabelsCanBeHandedOutAndNoMore) {
    start(SegmentTable::kMaxCapacity);
    const std::vector<SeenSegment> many(4095, SeenSegment{100, {}});
    for (int i = 0; i < 16; ++i) assign(many);
    EXPECT_EQ(counters_.live, 16u * 4095);
    const std::vector<uint32_t> last = assign(many);
    EXPECT_EQ(counters_.live, 65534u);
    EXPECT_EQ(last[13], 65534u);
    EXPECT_EQ(last[14], 0u);
    EXPECT_EQ(counters_.refused, 17u * 4095 - 65534);
}

TEST_F(AssignLabels, ALabelIsFreeAgainOnlyAfterAWholeSweepWithoutIt) {
    start(3);
    EXPECT_THAT(assign({{500, {}}, {500, {}}, {500, {}}}), ElementsAre(1, 2, 0));
    while (params_.stamp < 3 * gpu::kSweepFrames - 1) {
        change([](uint32_t, gpu::SegmentLabel& label) { label.tally = 0; });
        const uint32_t granted = assign({{500, {}}})[0];
        ASSERT_EQ(granted, 0u) << "in frame " << params_.stamp;
    }
    EXPECT_EQ(counters_.pruned, 2u);
    assign({});
    const uint32_t next = assign({{500, {}}})[0];
    EXPECT_EQ(next, 0u) << "pruned one sweep ago";
    while (params_.stamp < 4 * gpu::kSweepFrames) assign({});
    EXPECT_THAT(assign({{500, {}}}), ElementsAre(1));
}

TEST_F(AssignLabels, AgreesWithTheReferenceOverManyFrames) {
    constexpr uint32_t kCapacity = 12;
    start(kCapacity);
    SegmentBook::Rules rules;
    rules.capacity = kCapacity;
    rules.prune_frames = params_.prune_frames = 1;
    SegmentBook book(rules);
    std::mt19937 random(3);
    const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
    const auto alike = [](uint32_t a, uint32_t b) { return (a + b) % 2 == 0; };
    for (uint32_t i = 1; i <= 450; ++i) {
        std::vector<SeenSegment> seen(below(12));
        for (SeenSegment& segment : seen) {
            segment.pixels = 20 + below(300);
            for (uint32_t n = below(4); n > 0; --n) {
                const uint32_t label = book.root(1 + below(kCapacity - 1));
                if (label != 0) segment.shared[label] = 1 + below(segment.pixels / 3);
            }
        }
        std::map<uint32_t, uint32_t> voxels;
        for (uint32_t label = 1; label < kCapacity; ++label) voxels[label] = below(12);
        std::map<uint32_t, uint32_t> samples;
        for (uint32_t label = 1; label < kCapacity; ++label) samples[label] = 1 + below(4);
        change([&](uint32_t label, gpu::SegmentLabel& known) {
            known.tally = voxels[label];
            known.chroma_samples = samples[label];
            known.chroma_r = label % 2 * 500 * samples[label];
        });
        const std::vector<uint32_t> expected = book.frame(seen, alike, samples, voxels);
        ASSERT_EQ(assign(seen), expected) << "frame " << i;
        ASSERT_EQ(counters_.live, book.live_labels()) << "frame " << i;
        ASSERT_EQ(counters_.merged, book.merged()) << "frame " << i;
        ASSERT_EQ(counters_.pruned, book.pruned()) << "frame " << i;
    }
    EXPECT_GT(counters_.merged, 3u);
    EXPECT_GT(counters_.pruned, 10u);
    EXPECT_GT(counters_.created, kCapacity + 5) << "labels were handed out again";
}

}  // namespace
}  // namespace patina::assign_labels_test
