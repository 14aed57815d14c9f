#include "passes/segmentation/split_labels.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "shared/segmentation/split_labels.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/segmentation/label_rig.h"
#include "tests/gpu/segmentation/packed_albedo.h"
#include "tests/reference/segmentation/color_split.h"
#include "tools/bench/filled_records.h"

namespace patina::split_labels_test {
namespace {

constexpr float kVoxelM = 0.02f;
constexpr SplitChoice kChoice{0.12f, 17};
const glm::dvec3 kBrown(0.059, 0.029, 0.012), kGrey(0.2, 0.18, 0.14);

/// Records of one label, each with one colour.
using Part = std::vector<reference::ColoredVoxel>;

class SplitLabels : public GpuTest {
  protected:
    struct Result {
        std::vector<gpu::SegmentLabel> labels;
        std::vector<uint32_t> partners, record_labels;
        std::vector<gpu::SplitRule> rules;
        std::vector<gpu::SegmentKd> kd;
        gpu::SegmentCounters counters{};
    };

    /// Begins with live labels 1, 2, ... of these parts, whose records are all kept, and as many free ones. Records
    /// that no label keeps come first.
    void begin(const std::vector<Part>& parts, uint32_t free, std::vector<FilledRecord> records = {}) {
        std::vector<std::vector<uint32_t>> kept(LabelRig::kLabels);
        for (uint32_t label = 1; label <= parts.size(); ++label) {
            for (const reference::ColoredVoxel& v : parts[label - 1]) {
                kept[label].push_back(static_cast<uint32_t>(records.size()));
                const FilledObservation seen{{0, 0, 1}, glm::vec3(v.color), {}};
                FilledObservation third = seen;
                if (glints_.contains(static_cast<uint32_t>(records.size()))) third.rgb += 0.5f;
                records.push_back({(glm::vec3(v.voxel) + 0.5f) * kVoxelM, {0, 0, 1}, label, {seen, third, seen}});
            }
        }
        reset();
        graph::FrameGraph frame = runner().begin();
        ObservationMapIds ids = map_.import(frame);
        add_fill_records(frame, map_, ids, records);
        add_keep_records(frame, samples_, kept);
        ObservationMap::keep(frame, ids);
        run(std::move(frame));
        records_ = static_cast<uint32_t>(records.size());
        set(&ObservationMapIds::albedo, std::vector<glm::uvec2>(records_));
        start_table(static_cast<uint32_t>(parts.size()), free);
    }

    /// What is known of all records, in their order.
    template <class T>
    void set(graph::BufferId ObservationMapIds::*buffer, const std::vector<T>& values) {
        graph::FrameGraph frame = runner().begin();
        frame.keep(frame.upload_bytes(map_.import(frame).*buffer, 0, std::as_bytes(std::span(values)), false));
        run(std::move(frame));
    }

    Result split(const SplitChoice& choice = kChoice) {
        graph::FrameGraph frame = runner().begin();
        VoxelMapIds voxels = rig_.map().import(frame);
        LabelMapIds labels = rig_.labels().import(frame);
        ObservationMapIds ids = map_.import(frame);
        gpu::MapCounters counters{};
        counters.high_water = records_;
        ids.record_counters = frame.upload<gpu::MapCounters>("counters", std::span(&std::as_const(counters), 1));
        if (!colors_.empty())
            voxels.color = frame.upload_bytes(voxels.color, 0, std::as_bytes(std::span(colors_)), false);
        SegmentTableIds table = table_.import(frame);
        SegmentSampleIds samples = samples_.import(frame);
        add_split_labels(frame, rig_.map(), voxels, labels, map_, ids, table, samples, LabelRig::kLabels, choice);
        LabelMap::keep(frame, labels);
        frame.keep(ids.records);
        SegmentTable::keep(frame, table);
        frame.keep(samples.kd);
        const auto read = [&](graph::BufferId id) { return frame.read_back(id); };
        const graph::Readback known = read(table.labels), partners = read(table.partners), rules = read(table.rules),
                              told = read(table.counters), records = read(ids.records), kd = read(samples.kd);
        run(std::move(frame));
        Result result;
        result.labels = known.as<gpu::SegmentLabel>();
        result.partners = partners.as<uint32_t>();
        result.rules = rules.as<gpu::SplitRule>();
        result.kd = kd.as<gpu::SegmentKd>();
        result.counters = told.as<gpu::SegmentCounters>().front();
        const auto all = records.as<gpu::VoxelRecord>();
        for (uint32_t i = 0; i < records_; ++i) result.record_labels.push_back(all[i].label & 0xffff);
        return result;
    }

    ObservationMap map_{
        device(), {.voxel_m = kVoxelM, .block_m = 4 * kVoxelM, .capacity_blocks = 1024, .capacity_records = 8192}};
    SegmentTable table_{device(), LabelRig::kLabels};
    SegmentSamples samples_{device(), LabelRig::kLabels};
    LabelRig rig_{device(), runner()};
    std::set<uint32_t> glints_;     ///< records with a highlight in one of their three observations
    std::vector<uint32_t> colors_;  ///< color words of the voxel map's pool; empty: as they are

  private:
    void reset() {
        graph::FrameGraph frame = runner().begin();
        map_.reset(frame, glm::dvec3(0));
        samples_.reset(frame);
        table_.reset(frame);
        run(std::move(frame));
    }

    void start_table(uint32_t live, uint32_t free) {
        graph::FrameGraph frame = runner().begin();
        SegmentTableIds ids = table_.import(frame);
        std::vector<gpu::SegmentLabel> labels(LabelRig::kLabels);
        std::vector<uint32_t> parents(LabelRig::kLabels), ring(LabelRig::kLabels);
        for (uint32_t label = 1; label <= live; ++label) {
            labels[label] = {gpu::kLiveLabel, 1, 6, 100, 0, 10, 5, 3};
            parents[label] = label;
        }
        // The first free label is the ring's last entry, the next one its first.
        std::iota(ring.begin(), ring.end(), live + 2);
        ring.back() = live + 1;
        gpu::SegmentCounters counters{};
        counters.live = live;
        counters.high_water = live + 1;
        counters.free_head = LabelRig::kLabels - 1;
        counters.free_labels = free;
        counters.capacity = LabelRig::kLabels;
        ids.labels = frame.upload_bytes(ids.labels, 0, std::as_bytes(std::span(labels)), true);
        ids.parents = frame.upload_bytes(ids.parents, 0, std::as_bytes(std::span(parents)), true);
        ids.free_labels = frame.upload_bytes(ids.free_labels, 0, std::as_bytes(std::span(ring)), true);
        ids.counters = frame.upload_bytes(ids.counters, 0, std::as_bytes(std::span(&counters, 1)), true);
        SegmentTable::keep(frame, ids);
        const std::vector<gpu::SegmentKd> kd(LabelRig::kLabels, {9, 8, 7, 6});
        frame.keep(frame.upload_bytes(samples_.import(frame).kd, 0, std::as_bytes(std::span(kd)), true));
        run(std::move(frame));
    }

    uint32_t records_ = 0;
};

/// A plane of so many voxels along each edge, whose colours a function of them chooses.
template <class Color>
Part plane(int edge, Color&& color) {
    Part part;
    for (int y = 0; y < edge; ++y) {
        for (int x = 0; x < edge; ++x) part.push_back({color(x, y), {x, y, 0}});
    }
    return part;
}

/// The same colour a little brighter or darker, and of a little other hue.
glm::dvec3 varied(glm::dvec3 color, std::mt19937& random, double spread) {
    std::uniform_real_distribution<double> around(-1, 1);
    const double light = 1 + 0.3 * around(random);
    return light * color * (1.0 + spread * glm::dvec3(around(random), around(random), around(random)));
}

bool is_beyond(const gpu::SplitRule& rule, glm::dvec3 color) {
    const double sum = color.r + color.g + color.b;
    return (rule.axis_r * color.r + rule.axis_g * color.g) / sum > rule.threshold;
}

TEST_F(SplitLabels, ADishOnABoardBecomesALabelOfItsOwn) {
    std::mt19937 random(1);
    const auto in_dish = [](int x, int y) { return std::hypot(x - 7.5, y - 7.5) < 5; };
    const Part part = plane(16, [&](int x, int y) { return varied(in_dish(x, y) ? kGrey : kBrown, random, 0.05); });
    begin({part}, 3);
    const Result got = split();
    EXPECT_EQ(got.counters.split, 1u);
    EXPECT_EQ(got.counters.live, 2u);
    EXPECT_EQ(got.counters.created, 1u);
    EXPECT_EQ(got.counters.free_labels, 2u);
    EXPECT_EQ(got.counters.high_water, 3u);
    EXPECT_EQ(got.partners[1], 2u);
    EXPECT_EQ(got.partners[2], 1u);
    EXPECT_EQ(got.rules[1].beyond, 0u);
    EXPECT_EQ(got.rules[2].beyond, 1u);
    for (const uint32_t label : {1u, 2u}) {
        EXPECT_EQ(got.labels[label].state, gpu::kLiveLabel);
        EXPECT_EQ(got.labels[label].since, 17u) << "what is known of either alone has yet to be seen";
        EXPECT_EQ(got.labels[label].seen, 6u);
        EXPECT_EQ(got.labels[label].chroma_samples, 0u);
        EXPECT_EQ(got.kd[label].samples, 0u);
    }
    for (const reference::ColoredVoxel& v : part)
        EXPECT_EQ(is_beyond(got.rules[1], v.color), in_dish(v.voxel.x, v.voxel.y)) << v.voxel.x << ' ' << v.voxel.y;
}

TEST_F(SplitLabels, OneColorPrintsGradientsAndSpecksStayWhole) {
    std::mt19937 random(2);
    const auto mix = [](double share) { return kBrown * (1 - share) + kGrey * share; };
    begin(
        {
            plane(16, [&](int, int) { return varied(kBrown, random, 0.05); }),
            plane(16, [&](int x, int y) { return varied((x + y) % 2 == 0 ? kGrey : kBrown, random, 0.05); }),
            plane(16, [&](int x, int) { return varied(mix(x / 15.0 * x / 15.0), random, 0.02); }),
            plane(16, [&](int x, int y) { return varied(x < 4 && y < 5 ? kGrey : kBrown, random, 0.05); }),
            plane(6, [&](int x, int) { return varied(x < 3 ? kGrey : kBrown, random, 0.05); }),
            plane(16, [&](int x, int) { return varied(x < 8 ? kGrey : kBrown, random, 0.6); }),
            plane(16, [&](int x, int) { return varied(x < 8 ? kGrey : mix(0.7), random, 0.02); }),
            plane(16, [&](int x, int) { return x < 8 ? 0.001 * kGrey : varied(kBrown, random, 0.05); }),
        },
        9);
    const Result got = split();
    const char* what[]{"",           "one colour",   "a print",    "a gradient", "a speck", "few records",
                       "wide noise", "near colours", "black parts"};
    for (uint32_t label = 1; label <= 8; ++label) EXPECT_EQ(got.partners[label], 0u) << what[label];
    EXPECT_EQ(got.counters.split, 0u);
    EXPECT_EQ(got.counters.live, 8u);
}

TEST_F(SplitLabels, AgreesWithTheReference) {
    std::mt19937 random(3);
    const auto below = [&](double most) { return std::uniform_real_distribution<double>(0, most)(random); };
    std::vector<Part> parts;
    for (int label = 0; label < 24; ++label) {
        const glm::dvec3 one(0.1 + below(0.4), 0.1 + below(0.4), 0.1 + below(0.4));
        const glm::dvec3 other(0.1 + below(0.4), 0.1 + below(0.4), 0.1 + below(0.4));
        const double spread = below(0.3), border = 2 + below(12), strewn = label % 3 == 0 ? below(1) : 0;
        parts.push_back(plane(16, [&](int x, int) {
            const bool first = below(1) < strewn ? below(16) < border : x < border;
            return varied(first ? one : other, random, spread);
        }));
    }
    begin(parts, 24);
    const Result got = split();
    int split = 0, whole = 0;
    uint32_t next = 25;
    for (uint32_t label = 1; label <= parts.size(); ++label) {
        const auto best = reference::best_color_split(parts[label - 1]);
        ASSERT_TRUE(best);
        // Of each condition, how far it is met; near 1 the bins of Otsu's threshold may decide otherwise.
        const double met = std::min({best->apart / kChoice.least_apart, 0.4 / best->mixed, 0.17 / best->between,
                                     static_cast<double>(best->fewer) / (gpu::kLeastSplitShare * 256)});
        const bool was_split = got.partners[label] != 0;
        if (was_split) {
            EXPECT_EQ(got.partners[label], next++) << "in the order of labels";
        }
        if (met > 0.93 && met < 1.07) continue;
        EXPECT_EQ(was_split, met > 1) << label << " meets them by " << met;
        (met > 1 ? split : whole) += 1;
        if (!was_split || met <= 1) continue;
        size_t other = 0;
        for (uint32_t i = 0; i < 256; ++i) {
            const bool goes = reference::is_of_fewer(*best, parts[label - 1][i].color);
            other += is_beyond(got.rules[label], parts[label - 1][i].color) != goes ? 1 : 0;
        }
        EXPECT_LE(other, 2u) << "of 256 records of label " << label << ", beside the threshold";
    }
    EXPECT_GT(split, 4);
    EXPECT_GT(whole, 4);
}

/// A voxel's color word (lib/map/voxel_map.glsl), from any of its bits.
glm::dvec3 color_of(uint32_t word) {
    const glm::dvec3 root = glm::dvec3(word & 0x7ff, word >> 11 & 0x7ff, word >> 22) / glm::dvec3(2047, 2047, 1023);
    return root * root * static_cast<double>(gpu::kColorRange);
}

TEST_F(SplitLabels, VoxelsHaveTheLabelOfTheirColorInThisAndLaterCalls) {
    std::mt19937 random(4);
    begin({plane(16, [&](int x, int) { return varied(x < 5 ? kGrey : kBrown, random, 0.05); }),
           plane(16, [&](int, int) { return varied(kBrown, random, 0.05); })},
          5);
    const auto set_random = [&] {
        rig_.set_random(random, 2);
        std::vector<uint32_t> words = rig_.words();
        for (uint32_t& word : words) word = word == 0 ? 0 : (word & ~0xffffu) | (1 + random() % 3);
        rig_.set(words, std::vector<uint32_t>(LabelRig::kCapacity, 1));
        colors_.assign(words.size(), 0);
        for (uint32_t& word : colors_) word = random() % 4 == 0 ? 0 : static_cast<uint32_t>(random());
        return words;
    };
    const std::vector<uint32_t> keys = rig_.fusion().table().block_keys;
    for (int call = 0; call < 2; ++call) {
        const std::vector<uint32_t> before = set_random();
        const Result got = split({kChoice.least_apart, 17u + 32 * static_cast<uint32_t>(call)});
        ASSERT_EQ(got.partners[1], 3u) << "and is not split again";
        EXPECT_EQ(got.counters.split, 1u);
        const std::vector<uint32_t> after = rig_.words();
        size_t moved = 0, beside = 0;
        for (size_t i = 0; i < before.size(); ++i) {
            const uint32_t label = before[i] & 0xffff;
            const glm::dvec3 color = color_of(colors_[i]);
            const double sum = color.r + color.g + color.b;
            const gpu::SplitRule& rule = got.rules[1];
            const double off = (rule.axis_r * color.r + rule.axis_g * color.g) / sum - rule.threshold;
            const bool has_color = colors_[i] != 0 && sum >= 0.006;
            if (has_color && std::abs(off) < 1e-5) continue;
            const bool in_use = keys[i / gpu::kBlockVoxels] != gpu::kEmptyKey;
            const bool paired = in_use && before[i] != 0 && has_color && (label == 1 || label == 3);
            const uint32_t expected = paired ? (before[i] & ~0xffffu) | (off > 0 ? 3 : 1) : before[i];
            moved += expected != before[i] ? 1 : 0;
            beside += after[i] != expected ? 1 : 0;
        }
        EXPECT_GT(moved, 1000u);
        EXPECT_EQ(beside, 0u);
    }
}

TEST_F(SplitLabels, HighlightsAreNoSecondColor) {
    std::mt19937 random(7);
    const auto shines = [](int x) { return x < 5; };
    const Part part = plane(16, [&](int x, int) { return varied(shines(x) ? kGrey : kBrown, random, 0.05); });
    for (const bool one : {true, false}) {
        for (const uint32_t known : {7u, 8u}) {
            begin({part}, 3);
            std::vector<glm::uvec2> albedo;
            uint32_t shining = 0;
            for (const reference::ColoredVoxel& v : part) {
                const bool is_known = !shines(v.voxel.x) || shining++ < known;
                const glm::dvec3 kd = !one && shines(v.voxel.x) ? kGrey : kBrown;
                albedo.push_back(packed_albedo(glm::vec3(2.0 * kd), is_known ? 0.6f : 0.4f));
            }
            set(&ObservationMapIds::albedo, albedo);
            EXPECT_EQ(split().counters.split, one && known == 8 ? 0u : 1u) << known << " know their albedo";
        }
    }
}

TEST_F(SplitLabels, AHighlightInSomeViewsChangesNoRecordsColor) {
    std::mt19937 random(9);
    const Part part = plane(16, [&](int, int) { return varied(kBrown, random, 0.05); });
    for (uint32_t i = 0; i < part.size(); ++i) {
        if (part[i].voxel.x < 5) glints_.insert(i);
    }
    begin({part}, 3);
    EXPECT_EQ(split().counters.split, 0u);
}

TEST_F(SplitLabels, ANewLabelIsNotYetSplit) {
    std::mt19937 random(8);
    begin({plane(16, [&](int x, int) { return varied(x < 5 ? kGrey : kBrown, random, 0.05); })}, 5);
    EXPECT_EQ(split({kChoice.least_apart, gpu::kLeastSplitAge}).counters.split, 0u) << "it is from frame 1";
    EXPECT_EQ(split({kChoice.least_apart, gpu::kLeastSplitAge + 1}).counters.split, 1u);
}

TEST_F(SplitLabels, RecordsHaveTheLabelOfTheVoxelAtTheirSurface) {
    std::mt19937 random(10);
    rig_.set_random(random, 4);
    std::vector<uint32_t> words = rig_.words();
    for (uint32_t& word : words) word = word == 0 ? 0 : (word & ~0xffffu) | (1 + random() % 4);
    rig_.set(words, std::vector<uint32_t>(LabelRig::kCapacity, 1));
    colors_.assign(words.size(), 0);  // so that no voxel's label changes
    std::vector<FilledRecord> around;
    for (int i = 0; i < 4000; ++i) {
        const glm::vec3 at(random() % 900, random() % 600, random() % 100);  // mm, about the wall
        around.push_back({at * 0.001f + glm::vec3(-0.45f, -0.3f, 0.95f), glm::normalize(at - 45.0f), 1 + i % 4u, {}});
    }
    begin({plane(16, [&](int x, int) { return varied(x < 5 ? kGrey : kBrown, random, 0.05); }),
           plane(16, [&](int, int) { return varied(kBrown, random, 0.05); })},
          5, around);
    const Result got = split();
    ASSERT_EQ(got.partners[1], 3u);
    std::vector<uint32_t> roots(LabelRig::kLabels);
    std::iota(roots.begin(), roots.end(), 0u);
    roots[4] = 0;  // there is none
    const reference::LabelVolume volume = rig_.volume();
    // Records round their point and normal: close to a border between voxels either side may answer. Rounding moves the
    // point, those before and behind it with it, and these two by the normal's rounding against each other.
    const auto clear_answer = [&](const FilledRecord& record) -> std::optional<uint32_t> {
        std::set<uint32_t> answers;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 beside(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
            const glm::dvec3 point_m = glm::dvec3(kept_point_m(map_, record)) + beside * (1e-3 * kVoxelM);
            for (int i = 0; i < 27; ++i) {
                const glm::dvec3 turned(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
                const glm::dvec3 normal = glm::dvec3(record.normal) + turned * 5e-3;
                answers.insert(reference::sampled_label(volume, roots, point_m, normal));
            }
        }
        return answers.size() == 1 ? std::optional(*answers.begin()) : std::nullopt;
    };
    int moved = 0, stayed = 0, other = 0;
    for (uint32_t i = 0; i < around.size(); ++i) {
        const uint32_t label = around[i].label, partner = label == 1 ? 3 : label == 3 ? 1 : 0;
        const std::optional<uint32_t> asked = clear_answer(around[i]);
        if (!asked) continue;
        const bool moves = partner != 0 && *asked == partner;
        (moves ? moved : stayed) += 1;
        other += got.record_labels[i] != (moves ? partner : label) ? 1 : 0;
    }
    EXPECT_GT(moved, 100);
    EXPECT_GT(stayed, 2000);
    EXPECT_EQ(other, 0);
}

TEST_F(SplitLabels, WithoutAFreeLabelNothingIsSplitAndThatIsCounted) {
    std::mt19937 random(5);
    const Part part = plane(16, [&](int x, int) { return varied(x < 5 ? kGrey : kBrown, random, 0.05); });
    begin({part, part}, 1);
    const Result got = split();
    EXPECT_EQ(got.counters.split, 1u);
    EXPECT_EQ(got.counters.refused, 1u);
    EXPECT_EQ(got.counters.free_labels, 0u);
    EXPECT_EQ(got.partners[1], 3u) << "the first label comes first";
    EXPECT_EQ(got.partners[2], 0u);
}

}  // namespace
}  // namespace patina::split_labels_test
