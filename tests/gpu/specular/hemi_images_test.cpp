#include "passes/specular/hemi_images.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include <glm/gtc/packing.hpp>

#include "shared/specular/hemi_images.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/specular/hemi_image.h"
#include "tools/bench/filled_records.h"

namespace patina::hemi_images_test {
namespace {

constexpr size_t kSide = gpu::kHemiSide, kPixels = gpu::kHemiPixels, kSamples = gpu::kHemiSamples;

class HemiImagesTest : public GpuTest {
  protected:
    static constexpr uint32_t kLabels = 8;

    struct Made {
        std::vector<uint32_t> drawn;
        std::vector<glm::vec4> images;

        glm::vec3 at(size_t image, size_t x, size_t y) const {
            return glm::vec3(images[image * kPixels + y * kSide + x]);
        }
        std::vector<uint32_t> drawn_of(size_t segment) const {
            const auto first = drawn.begin() + static_cast<ptrdiff_t>(segment * kSamples);
            return {first, first + kSamples};
        }
    };

    void SetUp() override {
        graph::FrameGraph frame = runner().begin();
        map_.reset(frame, glm::dvec3(0));
        samples_.reset(frame);
        run(std::move(frame));
    }

    /// Records 0, 1, ..., and those of them that each label keeps.
    void fill(const std::vector<FilledRecord>& records,
              const std::map<uint32_t, std::vector<uint32_t>>& kept_by_label) {
        std::vector<gpu::SegmentSampleCount> counts(kLabels);
        std::vector<uint32_t> all(kLabels * gpu::kSegmentSamples, gpu::kNoRecord);
        for (const auto& [label, kept] : kept_by_label) {
            counts[label].kept = static_cast<uint32_t>(kept.size());
            std::ranges::copy(kept, all.begin() + label * gpu::kSegmentSamples);
        }
        graph::FrameGraph frame = runner().begin();
        ObservationMapIds ids = map_.import(frame);
        add_fill_records(frame, map_, ids, records);
        ObservationMap::keep(frame, ids);
        SegmentSampleIds sampled = samples_.import(frame);
        sampled.counts = frame.upload_bytes(sampled.counts, 0, std::as_bytes(std::span(counts)), true);
        sampled.kept = frame.upload_bytes(sampled.kept, 0, std::as_bytes(std::span(all)), true);
        SegmentSamples::keep(frame, sampled);
        run(std::move(frame));
    }

    Made make(const std::vector<uint32_t>& labels, uint32_t seed,
              HemisphereMap hemisphere_map = HemisphereMap::kParabolic) {
        std::vector<uint32_t> list{static_cast<uint32_t>(labels.size())};
        list.insert(list.end(), labels.begin(), labels.end());
        graph::FrameGraph frame = runner().begin();
        const SegmentBatch batch{frame.upload<uint32_t>("batch", list), list[0]};
        const HemiImages made = add_hemi_images(frame, map_, map_.import(frame), samples_, samples_.import(frame),
                                                batch, hemisphere_map, seed);
        const graph::Readback drawn = frame.read_back(made.drawn), images = frame.read_back(made.images);
        runner().submit(std::move(frame));
        runner().wait();
        return {drawn.as<uint32_t>(), images.as<glm::vec4>()};
    }

    glm::vec3 random_direction(glm::vec3 normal) {
        std::normal_distribution<float> gauss;
        for (;;) {
            const glm::vec3 direction = glm::normalize(glm::vec3(gauss(random_), gauss(random_), gauss(random_)));
            if (glm::dot(direction, normal) > 0.05f) return direction;
        }
    }

    /// The i-th voxel of a grid, seen from random directions.
    FilledRecord record(uint32_t i, glm::vec3 normal, uint32_t observations) {
        FilledRecord result{0.02f * glm::vec3(i % 16, i / 16, 0) + 0.01f, normal, 1, {}};
        std::uniform_real_distribution<float> level(0, 1);
        for (uint32_t k = 0; k < observations; ++k) {
            result.observations.push_back(
                {random_direction(normal), {level(random_), level(random_), level(random_)}, {}});
        }
        return result;
    }

    static std::vector<uint32_t> numbers(uint32_t from, uint32_t to) {
        std::vector<uint32_t> all;
        for (uint32_t i = from; i < to; ++i) all.push_back(i);
        return all;
    }

    std::mt19937 random_{1};
    // Several chunks of 128 records.
    ObservationMap map_{device(),
                        {.capacity_blocks = 64, .capacity_records = 512, .max_chunk_bytes = uint64_t{1} << 15}};
    SegmentSamples samples_{device(), kLabels};
};

TEST_F(HemiImagesTest, DirectionsLieWhereTheMapPutsThem) {
    // Normal z: its frame's x axis is the world's. Straight up, and at 60 degrees to all sides: tan(30) of 7 pixels.
    const float far = std::sin(glm::radians(60.0f)), up = 0.5f;
    const std::vector<glm::vec3> directions{{0, 0, 1}, {far, 0, up}, {-far, 0, up}, {0, far, up}, {0, -far, up}};
    FilledRecord voxel{{0.01f, 0.01f, 0.01f}, {0, 0, 1}, 1, {}};
    for (size_t k = 0; k < directions.size(); ++k) {
        voxel.observations.push_back({directions[k], glm::vec3(static_cast<float>(k + 1)), {}});
    }
    fill({voxel}, {{1, {0}}});
    const Made parabolic = make({1}, 1), orthogonal = make({1}, 1, HemisphereMap::kOrthogonal);
    // Between middle and side the border is at 2.02 and at 3.03 pixels.
    for (const auto& [made, border] : {std::pair(&parabolic, 2u), std::pair(&orthogonal, 3u)}) {
        for (uint32_t x = 0; x < kSide; ++x) {
            const uint32_t off = x < 7 ? 7 - x : x - 7;
            EXPECT_EQ(made->at(0, x, 7), glm::vec3(off <= border ? 1 : x > 7 ? 2 : 3)) << x;
            EXPECT_EQ(made->at(0, 7, x), glm::vec3(off <= border ? 1 : x > 7 ? 4 : 5)) << x;
        }
        EXPECT_EQ(made->at(0, 14, 13), glm::vec3(2)) << "corners are filled, too";
    }
    for (size_t image = 1; image < kSamples; ++image) EXPECT_EQ(parabolic.at(image, 3, 9), parabolic.at(0, 3, 9));
    EXPECT_EQ(parabolic.images[0].w, 0);
}

TEST_F(HemiImagesTest, ImagesAgreeWithTheReference) {
    std::vector<FilledRecord> records;
    for (uint32_t i = 0; i < 300; ++i) {
        const glm::vec3 normal = random_direction(glm::vec3(i % 2 == 0 ? 1 : -1, 0, 0.3f));
        records.push_back(record(i, normal, 5 + i % 26));
        if (i % 7 == 0) records.back().observations[2].to_viewer = -records.back().observations[2].to_viewer;
    }
    fill(records, {{1, numbers(0, 20)}, {2, numbers(20, 270)}, {5, numbers(270, 300)}});
    for (const HemisphereMap map : {HemisphereMap::kParabolic, HemisphereMap::kOrthogonal}) {
        const Made made = make({2, 5, 1}, 9, map);
        size_t compared = 0;
        for (size_t image = 0; image < 3 * kSamples; ++image) {
            const FilledRecord& voxel = records[made.drawn[image]];
            if (std::abs(std::abs(voxel.normal.x) - 0.9f) < 1e-3f) continue;  // where the frame's axis changes
            std::vector<glm::dvec3> directions;
            for (const FilledObservation& seen : voxel.observations) directions.emplace_back(seen.to_viewer);
            const reference::HemiImage want =
                reference::hemi_image(glm::dvec3(voxel.normal), directions, map == HemisphereMap::kOrthogonal, kSide);
            for (size_t pixel = 0; pixel < kPixels; ++pixel) {
                // Directions are kept to 0.02 degrees, those below the horizon land on its rim.
                if (want.margin[pixel] < 0.02) continue;
                const glm::vec3 rgb =
                    glm::unpackF3x9_E1x5(glm::packF3x9_E1x5(voxel.observations[want.nearest[pixel]].rgb));
                ASSERT_EQ(glm::vec3(made.images[image * kPixels + pixel]), rgb) << image << ", pixel " << pixel;
                ++compared;
            }
        }
        EXPECT_GT(compared, 2 * kSamples * kPixels);
    }
}

TEST_F(HemiImagesTest, DrawsDifferentVoxelsWhereThereAreEnoughAndNoneThatWasHardlySeen) {
    std::vector<FilledRecord> records;
    for (uint32_t i = 0; i < 400; ++i) records.push_back(record(i, {0, 0, 1}, i % 4 == 0 ? i % 5 : 5));
    fill(records, {{1, numbers(0, 256)}, {2, numbers(256, 280)}, {3, numbers(280, 284)}, {4, {284}}, {5, {}}});
    const Made made = make({1, 2, 3, 4, 5, 7, 1000}, 3);
    const auto first = made.drawn_of(0), second = made.drawn_of(1), third = made.drawn_of(2);
    EXPECT_EQ(std::set<uint32_t>(first.begin(), first.end()).size(), kSamples);
    EXPECT_GT(std::set<uint32_t>(second.begin(), second.end()).size(), 6u) << "of 18";
    EXPECT_EQ(std::set<uint32_t>(third.begin(), third.end()), (std::set<uint32_t>{281, 282, 283}));
    for (const uint32_t id : first) EXPECT_TRUE(id < 256 && id % 4 != 0) << id;
    for (const uint32_t id : second) EXPECT_TRUE(id >= 256 && id < 280 && id % 4 != 0) << id;
    for (size_t segment = 3; segment < 7; ++segment) {
        EXPECT_THAT(made.drawn_of(segment), ::testing::Each(gpu::kNoRecord)) << segment;
        EXPECT_EQ(made.at(segment * kSamples, 7, 7), glm::vec3(0));
    }
}

TEST_F(HemiImagesTest, TheDrawDependsOnVoxelsAndSeedAlone) {
    std::vector<FilledRecord> records;
    for (uint32_t i = 0; i < 200; ++i) records.push_back(record(i, {0, 0, 1}, 5));
    std::vector<uint32_t> kept = numbers(0, 200);
    fill(records, {{1, kept}, {2, numbers(0, 10)}});
    const Made one = make({1, 2}, 5), again = make({1, 2}, 5), other = make({1, 2}, 6);
    std::ranges::shuffle(kept, random_);
    fill(records, {{1, kept}, {3, {9, 8, 7, 6, 5, 4, 3, 2, 1, 0}}});
    const Made shuffled = make({3, 1}, 5);
    EXPECT_EQ(one.drawn, again.drawn);
    EXPECT_EQ(one.images, again.images);
    EXPECT_EQ(one.drawn_of(0), shuffled.drawn_of(1));
    EXPECT_EQ(one.drawn_of(1), shuffled.drawn_of(0));
    EXPECT_NE(one.drawn_of(0), other.drawn_of(0));
    EXPECT_NE(one.drawn_of(1), other.drawn_of(1));
}

TEST_F(HemiImagesTest, EveryVoxelIsAsLikelyToBeDrawn) {
    constexpr uint32_t kVoxels = 100, kDraws = 80;
    std::vector<FilledRecord> records;
    for (uint32_t i = 0; i < kVoxels; ++i) records.push_back(record(i, {0, 0, 1}, 5));
    fill(records, {{1, numbers(0, kVoxels)}});
    std::vector<uint32_t> counts(kVoxels);
    for (uint32_t seed = 0; seed < kDraws; ++seed) {
        for (const uint32_t id : make({1}, seed).drawn) ++counts[id];
    }
    // Pearson's statistic; draws without putting back vary by 1 - 1/4 of what independent ones do.
    const double mean = kDraws * kSamples / static_cast<double>(kVoxels);
    double sum = 0;
    for (const uint32_t count : counts) sum += (count - mean) * (count - mean) / (mean * 0.75);
    EXPECT_NEAR(sum, kVoxels - 1, 5 * std::sqrt(2.0 * (kVoxels - 1)));
}

}  // namespace
}  // namespace patina::hemi_images_test
