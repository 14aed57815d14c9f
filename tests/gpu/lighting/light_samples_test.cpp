// Samples of the observed surface against their reference, on records made up at random.

#include "tests/reference/lighting/light_samples.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <set>

#include <glm/gtc/packing.hpp>

#include "passes/lighting/sample_surface.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/observation/observed_scene.h"
#include "tests/gpu/reflectance/reflectance_rig.h"

namespace patina::light_samples_test {
namespace {

constexpr uint32_t kRecords = 4096;

/// A record by its voxel.
struct MadeUpRecord {
    std::array<int, 3> block{};
    uint32_t voxel = 0;
    RecordContent content;
    reference::GatheredRays around{};
    glm::vec3 bright{0};  ///< at low exposure; 0: not known

    glm::dvec3 point_m() const {
        const reference::ObservedVoxel seen = observed_scene::unpack(content);
        const glm::dvec3 low(2 * block[0] + static_cast<int>(voxel & 1),
                             2 * block[1] + static_cast<int>(voxel >> 1 & 1),
                             2 * block[2] + static_cast<int>(voxel >> 2));
        return (low + 0.5 + seen.normal * seen.offset_vox) * 0.02;
    }
};

/// One to eight voxels of each of some blocks, with up to 30 observations.
std::vector<MadeUpRecord> made_up_records(std::mt19937& random) {
    const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
    std::set<std::array<int, 3>> blocks;
    std::vector<MadeUpRecord> records;
    while (records.size() < kRecords - 8) {
        const std::array<int, 3> block{static_cast<int>(below(60)) - 30, static_cast<int>(below(40)) - 20,
                                       static_cast<int>(below(60)) - 30};
        if (!blocks.insert(block).second) continue;
        for (uint32_t voxel = below(3); voxel < 8; voxel += 1 + below(4)) {
            MadeUpRecord& record = records.emplace_back(MadeUpRecord{block, voxel, {}});
            record.around.mean = glm::dvec3(below(64), below(64), below(64)) / 64.0;
            record.around.met = below(4) == 0 ? 0 : below(200);
            record.around.missed = below(4) == 0 ? 0 : below(200);
            if (below(2) == 0) record.bright = glm::vec3(below(64), below(64), below(64)) / 16.0f;
            const uint32_t count = below(31);
            gpu::VoxelRecord& known = record.content.record;
            known.block_key = static_cast<uint32_t>(block[0] + 1024) | static_cast<uint32_t>(block[1] + 512) << 11 |
                              static_cast<uint32_t>(block[2] + 1024) << 21;
            known.normal = static_cast<uint32_t>(random());
            known.state = count | voxel << 5 | static_cast<uint32_t>(random()) << 16;
            // Around one of three exponents, so that some voxels have highlights; no two are equally bright, as
            // rounding would decide which one is darker.
            const uint32_t exponent = 13 + below(3);
            std::set<uint32_t> brightness;
            while (record.content.colors.size() < count) {
                const uint32_t r = below(512), g = below(512), b = below(512), brighter = below(16) == 0 ? 1 : 0;
                if (!brightness.insert((r + g + b) << brighter).second) continue;
                const uint32_t x = below(8191) - 4095, y = below(8191) - 4095;
                record.content.directions.push_back((x & 0x1fff) | (y & 0x1fff) << 13);
                record.content.colors.push_back(r | g << 9 | b << 18 | (exponent + brighter) << 27);
            }
        }
    }
    return records;
}

class LightSamples : public GpuTest {
  protected:
    std::vector<gpu::LightSample> draw(const std::vector<MadeUpRecord>& made_up, uint32_t seed = 0) {
        std::vector<gpu::VoxelRecord> records;
        std::vector<gpu::RecordStatus> status(kRecords);
        std::vector<uint32_t> directions(kRecords * gpu::kRecordQuads * 4), colors(directions.size());
        for (size_t i = 0; i < made_up.size(); ++i) {
            const RecordContent& content = made_up[i].content;
            records.push_back(content.record);
            status[i].incident = pack_rays(made_up[i].around);
            status[i].bright = glm::packF3x9_E1x5(made_up[i].bright);
            std::ranges::copy(content.directions, &directions[i * gpu::kRecordQuads * 4]);
            std::ranges::copy(content.colors, &colors[i * gpu::kRecordQuads * 4]);
        }
        gpu::MapCounters counters{};
        counters.high_water = static_cast<uint32_t>(records.size());
        graph::FrameGraph frame = runner().begin();
        ObservationMapIds ids = map_.import(frame);
        ids.record_counters = frame.upload<gpu::MapCounters>("counters", std::span(&std::as_const(counters), 1));
        ids.records = frame.upload<gpu::VoxelRecord>("records", std::span(std::as_const(records)));
        ids.directions = frame.upload_bytes(ids.directions, 0, std::as_bytes(std::span(directions)), true);
        ids.colors = frame.upload_bytes(ids.colors, 0, std::as_bytes(std::span(colors)), true);
        const graph::BufferId known = frame.upload<gpu::RecordStatus>("status", std::span(std::as_const(status)));
        const graph::Readback drawn = frame.read_back(add_sample_surface(frame, map_, ids, known, seed));
        run(std::move(frame));
        return drawn.as<gpu::LightSample>();
    }

    /// How many of so many places are taken when so many choose one each.
    static double places_taken(double places, double choices) {
        return places * (1 - std::pow(1 - 1 / places, choices));
    }

    ObservationMap map_{device(), {.capacity_blocks = 1024, .capacity_records = kRecords}};
};

const MadeUpRecord& record_at(const std::vector<MadeUpRecord>& records, const std::vector<glm::dvec3>& points_m,
                              glm::dvec3 point_m) {
    const auto apart = [&](glm::dvec3 other_m) { return glm::distance(other_m, point_m); };
    const auto nearest = std::ranges::min_element(points_m, {}, apart);
    EXPECT_LT(apart(*nearest), 1e-5);
    return records[static_cast<size_t>(nearest - points_m.begin())];
}

void expect_near(const gpu::LightSample& got, const MadeUpRecord& record, bool is_highlight) {
    const reference::ObservedVoxel seen = observed_scene::unpack(record.content);
    const reference::LightSample expected = reference::light_sample(seen.seen);
    EXPECT_GE(seen.seen.size(), gpu::kLeastForSample);
    EXPECT_EQ(got.point_m.w, static_cast<float>(seen.seen.size()));
    EXPECT_LT(glm::distance(glm::dvec3(got.normal), seen.normal), 1e-4);
    const bool clips = std::max({expected.diffuse.r, expected.diffuse.g, expected.diffuse.b}) > 0.8;
    const glm::dvec3 diffuse = clips ? glm::max(expected.diffuse, glm::dvec3(record.bright)) : expected.diffuse;
    EXPECT_LT(glm::distance(glm::dvec3(got.diffuse), diffuse), 1e-5);
    EXPECT_LT(glm::distance(glm::dvec3(got.highlight), expected.to_viewer), 1e-4);
    const double met = record.around.met, rays = met + record.around.missed;
    const glm::dvec4 around(record.around.mean * (met / rays), 1 - met / rays);
    EXPECT_LT(glm::distance(glm::dvec4(got.around), rays > 0 ? around : glm::dvec4(0, 0, 0, -1)), 1e-5);
    if (std::abs(expected.excess - expected.least_excess) < 1e-5) return;
    const bool shines = expected.excess > expected.least_excess;
    EXPECT_NEAR(got.highlight.w, shines ? std::min(expected.excess, 0.3) : 0.0, 1e-5);
    EXPECT_TRUE(shines || !is_highlight);
}

TEST_F(LightSamples, AreWhatTheReferenceMakesOfTheirRecords) {
    std::mt19937 random(17);
    std::vector<MadeUpRecord> records = made_up_records(random);
    std::vector<glm::dvec3> points_m;
    std::set<std::array<int, 3>> blocks;
    std::map<uint32_t, uint32_t> shining;  // blocks, by voxel
    for (const MadeUpRecord& record : records) {
        points_m.push_back(record.point_m());
        const reference::ObservedVoxel seen = observed_scene::unpack(record.content);
        if (seen.seen.size() < gpu::kLeastForSample) continue;
        blocks.insert(record.block);
        const reference::LightSample sample = reference::light_sample(seen.seen);
        if (sample.excess > sample.least_excess) ++shining[record.voxel];
    }
    const std::vector<gpu::LightSample> drawn = draw(records);
    ASSERT_EQ(drawn.size(), 2 * gpu::kLightSamples);
    std::set<std::array<int, 3>> sampled;
    std::set<const MadeUpRecord*> highlights;
    for (uint32_t place = 0; place < drawn.size(); ++place) {
        if (drawn[place].point_m.w == 0) continue;
        const MadeUpRecord& record = record_at(records, points_m, glm::dvec3(drawn[place].point_m));
        const bool is_highlight = place >= gpu::kLightSamples;
        expect_near(drawn[place], record, is_highlight);
        EXPECT_TRUE(is_highlight ? highlights.insert(&record).second : sampled.insert(record.block).second)
            << "drawn twice";
    }
    const double places = places_taken(gpu::kLightSamples, static_cast<double>(blocks.size()));
    EXPECT_NEAR(static_cast<double>(sampled.size()), places, 0.05 * places);
    double shining_places = 0;
    for (const auto& [voxel, count] : shining) shining_places += places_taken(gpu::kLightSamples / 8.0, count);
    EXPECT_NEAR(static_cast<double>(highlights.size()), shining_places, 0.05 * shining_places);
    EXPECT_GT(sampled.size(), 500u);
    EXPECT_GT(highlights.size(), 200u);

    std::shuffle(records.begin(), records.end(), random);
    const std::vector<gpu::LightSample> shuffled = draw(records);
    EXPECT_EQ(std::memcmp(drawn.data(), shuffled.data(), drawn.size() * sizeof drawn[0]), 0);
}

TEST_F(LightSamples, TheDarkestTwoFifthsAreDiffuseAndWhatShinesMustStandOut) {
    // Grey values of ten observations; 1 / 512 each.
    const auto sample = [&](const std::vector<uint32_t>& greys) {
        std::mt19937 random(1);
        MadeUpRecord record = made_up_records(random).front();
        record.content.record.state = (record.content.record.state & ~31u) | static_cast<uint32_t>(greys.size());
        record.content.directions.assign(greys.size(), 0);
        record.content.colors.clear();
        for (const uint32_t grey : greys) record.content.colors.push_back(grey | grey << 9 | grey << 18 | 15u << 27);
        for (const gpu::LightSample& drawn : draw({record})) {
            if (drawn.point_m.w > 0) return drawn;
        }
        return gpu::LightSample{};
    };
    const gpu::LightSample dull = sample({200, 100, 120, 140, 160, 130, 150, 170, 180, 190});
    EXPECT_NEAR(dull.diffuse.r, (100 + 120 + 130 + 140) / 4.0 / 512, 1e-6);
    EXPECT_EQ(dull.highlight.w, 0) << "60 more than 140, 51 + 42 are asked for";
    const gpu::LightSample bright = sample({240, 100, 120, 140, 160, 130, 150, 170, 180, 190});
    EXPECT_NEAR(bright.highlight.w, 100 / 512.0, 1e-6);
    EXPECT_NEAR(sample({511, 100, 120, 140, 160, 130, 150, 170, 180, 190}).highlight.w, 0.3, 1e-6);
    EXPECT_EQ(sample({511, 100, 120}).point_m.w, 0) << "too few";
}

TEST_F(LightSamples, AnotherSeedDrawsOthers) {
    std::mt19937 random(23);
    const std::vector<MadeUpRecord> records = made_up_records(random);
    const auto points_of = [](const std::vector<gpu::LightSample>& samples) {
        std::set<std::array<float, 3>> points;
        for (size_t i = 0; i < gpu::kLightSamples; ++i)
            if (const glm::vec4 p = samples[i].point_m; p.w > 0) points.insert({p.x, p.y, p.z});
        return points;
    };
    const auto first = points_of(draw(records)), again = points_of(draw(records, 0)),
               other = points_of(draw(records, 5));
    EXPECT_EQ(first, again);
    ASSERT_GT(first.size(), 100u);
    ASSERT_GT(other.size(), 100u);
    size_t both = 0;
    for (const auto& point : other) both += first.count(point);
    EXPECT_LT(both, other.size()) << "of " << other.size();
}

}  // namespace
}  // namespace patina::light_samples_test
