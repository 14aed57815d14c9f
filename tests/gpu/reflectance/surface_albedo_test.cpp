// Records that tell each other of their albedo: made up from known ones, under light that errs.

#include "tests/reference/reflectance/surface_albedo.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/reflectance/reflectance_rig.h"
#include "tools/bench/filled_records.h"

namespace patina::surface_albedo_test {
namespace {

const glm::dvec3 kWhite(0.8, 0.75, 0.7), kDark(0.2, 0.18, 0.15), kLight(0.5, 0.45, 0.35);

/// A record and the light that really arrives, and that is taken to.
struct LitRecord {
    FilledRecord record;
    glm::dvec3 kd{0}, light{0}, taken{0};
};

class SurfaceAlbedoTest : public GpuTest {
  protected:
    SurfaceAlbedoTest() {
        graph::FrameGraph frame = runner().begin();
        voxel_map_.reset(frame, glm::dvec3(0));
        map_.reset(frame, glm::dvec3(0));
        run(std::move(frame));
        rig_.lights.set({}, glm::dvec3(0));
    }

    /// A floor of 60 x 60 cm, a record every 2 cm, whose light is taken for up to `error` more or less than it is.
    std::vector<LitRecord> floor(double error, const std::function<glm::dvec3(glm::dvec3)>& kd, uint32_t label = 0) {
        std::vector<LitRecord> records;
        std::uniform_real_distribution<double> off(-error, error);
        for (int z = -15; z < 15; ++z) {
            for (int x = -15; x < 15; ++x) {
                const glm::vec3 point_m(0.02f * (static_cast<float>(x) + 0.5f), 0.01f,
                                        0.02f * (static_cast<float>(z) + 0.5f));
                LitRecord lit{{point_m, {0, -1, 0}, label, {}}, kd(glm::dvec3(point_m)), kLight, kLight};
                lit.taken *= 1 + off(random_);
                records.push_back(lit);
            }
        }
        return records;
    }

    /// What the records hear, with what the reference makes of them.
    std::vector<RefinedRecord> share(std::vector<LitRecord> lit, const glm::vec4& cube_m = RefinedPart{}.cube_m) {
        std::vector<FilledRecord> records;
        std::vector<reference::GatheredRays> rays;
        for (LitRecord& record : lit) {
            const glm::dvec3 rgb = record.kd * record.light;
            record.record.observations = {{{0, -1, 0}, glm::vec3(rgb), {}}};
            records.push_back(record.record);
            rays.push_back({record.taken, 64, 0});
        }
        rig_.set_incident(rays);
        ReflectanceSettings settings;
        settings.first_marched_records = 1u << 20;
        rig_.update(settings, [&](graph::FrameGraph& frame, ObservationMapIds& ids) {
            add_fill_records(frame, map_, ids, records);
            gpu::MapCounters counters{};
            counters.high_water = static_cast<uint32_t>(records.size());
            ids.record_counters =
                frame.upload_bytes(ids.record_counters, 0, std::as_bytes(std::span(&counters, 1)), false);
            return add_list_records(frame, static_cast<uint32_t>(records.size()));
        });
        rig_.share_albedo(cube_m);
        return rig_.records(static_cast<uint32_t>(records.size()));
    }

    std::mt19937 random_{1};
    VoxelMap voxel_map_{device(), {.capacity_blocks = 64}};
    ObservationMap map_{device(), {.capacity_blocks = 512, .capacity_records = 2048}};
    ReflectanceRig rig_{device(), runner(), voxel_map_, map_};
};

void expect_as_reference(const std::vector<RefinedRecord>& records) {
    std::vector<reference::ToldAlbedo> told;
    for (const RefinedRecord& record : records)
        told.push_back({record.point_m, record.normal, record.label, record.raw_kd, record.incident.mean});
    const std::vector<glm::dvec3> expected = reference::surface_albedo(told);
    size_t apart = 0, known = 0;
    for (size_t i = 0; i < records.size(); ++i) {
        EXPECT_EQ(expected[i] == glm::dvec3(0), records[i].around == glm::dvec3(0)) << i;
        known += expected[i] != glm::dvec3(0);
        apart += glm::distance(expected[i], records[i].around) > 0.01;
    }
    EXPECT_GT(known, records.size() / 2);
    // A record halfway between two cells may count in either.
    EXPECT_LE(apart, records.size() / 50);
}

/// How far what the records hear, or know themselves, is from what they are: root mean square.
double error_of(const std::vector<RefinedRecord>& records, const std::vector<LitRecord>& lit,
                glm::dvec3 RefinedRecord::*what) {
    double squares = 0;
    for (size_t i = 0; i < records.size(); ++i) {
        const glm::dvec3 off = records[i].*what - lit[i].kd;
        squares += glm::dot(off, off) / 3;
    }
    return std::sqrt(squares / static_cast<double>(records.size()));
}

TEST_F(SurfaceAlbedoTest, WhatLightErrsByAveragesOutAndPrintStays) {
    const auto stripes = [](glm::dvec3 p) { return std::fmod(p.x + 10, 0.2) < 0.1 ? kWhite : kDark; };
    const std::vector<LitRecord> lit = floor(0.3, stripes);
    const std::vector<RefinedRecord> records = share(lit);
    EXPECT_GT(error_of(records, lit, &RefinedRecord::kd), 0.07);
    EXPECT_LT(error_of(records, lit, &RefinedRecord::around), 0.02);
    expect_as_reference(records);
}

TEST_F(SurfaceAlbedoTest, WithTheSegmentAsTheReferenceHasIt) {
    // Light is taken for a third too strong on one side: the other half of the segment tells.
    std::vector<LitRecord> lit = floor(
        0.2, [](glm::dvec3) { return kWhite; }, 7);
    for (LitRecord& record : lit)
        if (record.record.point_m.x < 0) record.taken *= 1.33;
    const std::vector<RefinedRecord> records = share(lit);
    double left = 0, right = 0;
    for (const RefinedRecord& record : records) (record.point_m.x < 0 ? left : right) += record.around.g / 450;
    EXPECT_GT(left, kWhite.g / 1.33 + 0.05);
    EXPECT_LT(right, kWhite.g);
    expect_as_reference(records);
}

// A patch of sun on tiles, of which the model knows nothing: what the tiles reflect in it asks for albedos far above 1.
TEST_F(SurfaceAlbedoTest, APatchOfSunIsNoWhitePaint) {
    const auto tiles = [](glm::dvec3 p) {
        return std::fmod(p.x + 10, 0.04) < 0.02 && std::fmod(p.z + 10, 0.04) < 0.02 ? 0.12 * kWhite : 0.02 * kWhite;
    };
    std::vector<LitRecord> lit = floor(0.1, tiles, 3);
    const auto in_patch = [](const LitRecord& record) { return record.record.point_m.x > 0.1f; };
    for (LitRecord& record : lit) {
        record.kd *= 7;
        record.light *= in_patch(record) ? 3.0 : 1.0;
        if (in_patch(record)) record.taken *= 0.5;
    }
    const std::vector<RefinedRecord> records = share(lit);
    double own = 0, heard = 0, count = 0;
    for (size_t i = 0; i < records.size(); ++i) {
        if (!in_patch(lit[i]) || records[i].around == glm::dvec3(0)) continue;
        own += std::abs(records[i].kd.g - lit[i].kd.g);
        heard += std::abs(records[i].around.g - lit[i].kd.g);
        ++count;
    }
    EXPECT_GT(count, 200);
    EXPECT_GT(own / count, 0.3);
    EXPECT_LT(heard, own / 2);
    expect_as_reference(records);
}

TEST_F(SurfaceAlbedoTest, RecordsOutsideThePartNeitherTellNorHear) {
    const std::vector<LitRecord> lit = floor(0.3, [](glm::dvec3) { return kWhite; });
    const std::vector<RefinedRecord> records = share(lit, {-0.3f, 0, 0, 0.3f});
    std::vector<RefinedRecord> inside;
    for (const RefinedRecord& record : records) {
        if (record.point_m.x < 0)
            inside.push_back(record);
        else
            EXPECT_EQ(record.around, glm::dvec3(0));
    }
    EXPECT_EQ(inside.size(), 450u);
    expect_as_reference(inside);
}

TEST_F(SurfaceAlbedoTest, RecordsWithoutGatheredLightHearNothing) {
    std::vector<LitRecord> lit = floor(0, [](glm::dvec3) { return kWhite; });
    for (LitRecord& record : lit) record.taken = glm::dvec3(0);
    for (const RefinedRecord& record : share(lit)) EXPECT_EQ(record.around, glm::dvec3(0));
}

TEST_F(SurfaceAlbedoTest, TheOrderOfRecordsChangesNothing) {
    std::vector<LitRecord> lit = floor(
        0.3, [](glm::dvec3) { return kWhite; }, 2);
    const std::vector<RefinedRecord> records = share(lit);
    std::reverse(lit.begin(), lit.end());
    std::vector<RefinedRecord> reversed = share(lit);
    std::reverse(reversed.begin(), reversed.end());
    for (size_t i = 0; i < records.size(); ++i) EXPECT_EQ(records[i].around, reversed[i].around) << i;
}

}  // namespace
}  // namespace patina::surface_albedo_test
