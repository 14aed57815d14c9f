// Which segments are mirrors: made-up voxels of a plane that see a wall of known colours.

#include "passes/specular/fit_mirrors.h"

#include <cmath>
#include <cstring>
#include <numbers>

#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "passes/reflectance/collect_surroundings.h"
#include "tests/gpu/specular/fit_ward_rig.h"
#include "tests/reference/scenes/analytic_scene.h"

namespace patina::fit_mirrors_test {
namespace {

constexpr double kWall_m = 1.5;       // in front of the plane z = 0
constexpr double kAlpha = 0.06;       // of the mirrors
constexpr double kIrradiance = 0.45;  // over pi
const Intrinsics kCamera{{640, 480}, 200, 200, 319.5, 239.5, {}};

/// The wall's radiance: bright and dark squares of 0.8 m, several times what a lobe blurs, and a slope.
double wall(double x, double y) {
    const auto square = static_cast<int>(std::floor(x / 0.8) + std::floor(y / 0.8));
    return (square & 1 ? 0.7 : 0.15) + 0.05 * x;
}

struct Surface {
    double ks = 0;
    double least_kd = 0.3, most_kd = 0.3;  ///< voxels have different ones
    glm::dvec3 tint{1};                    ///< of ks
    double other = 0;                      ///< each view is so much brighter or darker at most, by chance
};

class FitMirrorsTest : public FitWardTest {
  protected:
    struct Found {
        gpu::MirrorFit fit;
        gpu::SegmentMaterial material;
        double ks() const { return double{fit.product.w} / double{fit.square.w}; }
    };

    double contrast_ = 1;  // what the wall's radiance is multiplied with

    /// What a viewer sees mirrored: the mean over Ward's lobe, by plain Monte Carlo.
    double mirrored(glm::dvec3 point, glm::dvec3 to_viewer) {
        std::uniform_real_distribution<double> uniform(0, 1);
        double sum = 0;
        constexpr int kRays = 200;
        for (int i = 0; i < kRays; ++i) {
            const double tangent = kAlpha * std::sqrt(-std::log(1 - uniform(random_)));
            const double angle = 2 * std::numbers::pi * uniform(random_);
            const glm::dvec3 half_way =
                glm::normalize(glm::dvec3(tangent * std::cos(angle), tangent * std::sin(angle), 1));
            const glm::dvec3 ray = 2 * glm::dot(half_way, to_viewer) * half_way - to_viewer;
            const glm::dvec3 at = point + ray * ((kWall_m - point.z) / ray.z);
            sum += contrast_ * wall(at.x, at.y);
        }
        return sum / kRays;
    }

    std::vector<FilledRecord> plane(uint32_t label, const Surface& surface, double least_x_m) {
        std::uniform_real_distribution<double> place(0, 0.4), level(surface.least_kd, surface.most_kd), share(0, 1);
        std::vector<FilledRecord> records;
        while (records.size() < kVoxels) {
            FilledRecord record{{least_x_m + place(random_), place(random_), 0.001}, {0, 0, 1}, label, {}};
            const auto voxel = voxel_of(record);
            if (!used_.insert(voxel).second) continue;
            const double own = level(random_) * kIrradiance;
            while (record.observations.size() < 12) {
                const glm::dvec3 direction = direction_about({0, 0, 1}, 0.72);
                const double shown = surface.ks * mirrored(glm::dvec3(kept_point_m(map_, record)), direction);
                const double all = own + surface.other * (2 * share(random_) - 1);
                record.observations.push_back({glm::vec3(direction), glm::vec3(all + shown * surface.tint), {}});
            }
            records.push_back(record);
        }
        return records;
    }

    graph::BufferId add_wall(graph::FrameGraph& frame) {
        Image<float> depth(kCamera.extent, static_cast<float>(kWall_m));
        std::vector<uint64_t> halves;
        const RigidTransform pose = reference::look_at({0, 0, 0}, {0, 0, 1});
        for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
            for (uint32_t x = 0; x < kCamera.extent.width; ++x) {
                const glm::dvec4 ray((x - kCamera.cx) / kCamera.fx, (y - kCamera.cy) / kCamera.fy, 1, 0);
                const glm::dvec4 at = glm::dmat4(pose) * (ray * kWall_m);
                halves.push_back(
                    glm::packHalf4x16(glm::vec4(glm::vec3(static_cast<float>(contrast_ * wall(at.x, at.y))), 1)));
            }
        }
        ReflectanceStateIds state;
        state.surroundings = frame.fill(frame.create_buffer("surroundings", kSurroundingsBytes), 0);
        SurroundingsInputs inputs;
        inputs.depth_m =
            frame.upload("depth", {kCamera.extent, vulkan::Format::kR32f}, std::as_bytes(std::span(depth.pixels())));
        inputs.color_linear =
            frame.upload("color", {kCamera.extent, vulkan::Format::kRgba16f}, std::as_bytes(std::span(halves)));
        inputs.depth_camera = inputs.color_camera = make_camera(kCamera, pose);
        for (; inputs.frame_index < 16; ++inputs.frame_index) add_collect_surroundings(frame, state, inputs);
        return state.surroundings;
    }

    /// Forgets the voxels, and nothing of what was found.
    void empty() {
        graph::FrameGraph frame = runner().begin();
        map_.reset(frame, glm::dvec3(0));
        samples_.reset(frame);
        run(std::move(frame));
    }

    /// Looks so many times at label 1.
    Found find(uint32_t times = 1) {
        Found found{};
        for (uint32_t i = 0; i < times; ++i) {
            graph::FrameGraph frame = runner().begin();
            const ObservationMapIds records = map_.import(frame);
            const SegmentSampleIds samples = samples_.import(frame);
            const FitMirrorsInputs inputs{map_, records, add_wall(frame), samples, kLabels, i + 1, 0.93f};
            WardFitIds ids = table_.import(frame);
            graph::BufferId materials = rig_.materials.import(frame);
            const std::vector<uint32_t> list{1, 1};
            add_fit_mirrors(frame, inputs, {frame.upload<uint32_t>("batch", list), 1}, table_, ids, materials);
            WardFits::keep(frame, ids);
            frame.keep(materials);
            const graph::Readback fits = frame.read_back(ids.mirrors), read = frame.read_back(materials);
            run(std::move(frame));
            found = {fits.as<gpu::MirrorFit>()[1], read.as<gpu::SegmentMaterial>()[1]};
        }
        return found;
    }
};

TEST_F(FitMirrorsTest, AMirrorIsFoundWithItsKs) {
    fill(plane(1, {.ks = 0.8, .least_kd = 0.02, .most_kd = 0.02}, 0));
    const Found found = find(6);
    // 6 looks of 128 pairs (one a voxel), two rays in a set: single rays differ by 0.3, their products by 0.1, so 0.004
    // on a square of 0.1; twice that for the pairs that come again, three deviations.
    EXPECT_NEAR(found.ks(), 0.8, 0.2);
    EXPECT_GT(found.material.mirror, 0.95f);
    EXPECT_GT(found.material.version, 0u);
}

TEST_F(FitMirrorsTest, AGoldenMirrorHasItsColour) {
    const glm::dvec3 tint(1, 0.7, 0.3);
    fill(plane(1, {.ks = 0.9, .least_kd = 0.02, .most_kd = 0.02, .tint = tint}, 0));
    const Found found = find(6);
    EXPECT_GT(found.material.mirror, 0.95f);
    // The wall is grey, so that all channels have the same error.
    const glm::dvec3 ks = glm::dvec3(found.fit.product) / glm::dvec3(found.fit.square);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(ks[c] / ks[0], tint[c], 0.02) << c;
    EXPECT_NEAR(ks[0], 0.9, 0.22);
}

TEST_F(FitMirrorsTest, PrintIsNoMirror) {
    fill(plane(1, {.ks = 0, .least_kd = 0.05, .most_kd = 0.9}, 0));
    const Found found = find(6);
    EXPECT_LT(std::abs(found.ks()), 0.02);
    EXPECT_EQ(found.material.mirror, 0.0f);
}

TEST_F(FitMirrorsTest, LacquerIsNoMirror) {
    fill(plane(1, {.ks = 0.05, .least_kd = 0.1, .most_kd = 0.6}, 0));
    const Found found = find(6);
    EXPECT_NEAR(found.ks(), 0.05, 0.02);
    EXPECT_EQ(found.material.mirror, 0.0f);
}

// A ceiling that few frames saw, from far and flat: its colours changed by twice what it would have mirrored, and
// mostly for other reasons.
TEST_F(FitMirrorsTest, WhatChangesByMoreThanItWouldMirrorIsNoMirror) {
    contrast_ = 0.15;
    fill(plane(1, {.ks = 2, .least_kd = 0.7, .most_kd = 0.7, .other = 0.3}, 0));
    const Found found = find(6);
    EXPECT_GT(found.ks(), 1.4);
    EXPECT_EQ(found.material.mirror, 0.0f);
}

// A mirror that shows more sky than pictures did: all changes go with what it mirrors, and are larger.
TEST_F(FitMirrorsTest, AMirrorOfSurroundingsThatAreMoreEvenThanTheRoomIsOne) {
    // The wall's dark squares are black, so that its bright ones are not clipped.
    constexpr double kKs = 1.7, kDark = 0.15;
    fill(plane(1, {.ks = kKs, .least_kd = -kKs * kDark / kIrradiance, .most_kd = -kKs * kDark / kIrradiance}, 0));
    const Found found = find(6);
    EXPECT_GT(found.ks(), 1.4);
    EXPECT_GT(found.material.mirror, 0.95f);
}

// What is mirrored explains a tenth of how the colours change. Its error alone would leave a mirror of 0.5.
TEST_F(FitMirrorsTest, WhatChangesForOtherReasonsIsNoMirror) {
    fill(plane(1, {.ks = 0.65, .least_kd = 0.3, .most_kd = 0.3, .other = 0.4}, -0.6));
    const Found found = find(6);
    EXPECT_GT(found.ks(), 0.4);
    EXPECT_LT(found.material.mirror, 0.2f);
}

TEST_F(FitMirrorsTest, ClippedViewsDoNotCount) {
    auto records = clipped(plane(1, {.ks = 0.8, .least_kd = 0.02, .most_kd = 0.02}, 0), 0.01f);
    fill(records);
    EXPECT_EQ(find().fit.pairs, 0.0f);
}

// Frames of low exposure show more than pixels of the others can.
TEST_F(FitMirrorsTest, ViewsBrighterThanPixelsDoNotCount) {
    auto records = plane(1, {.ks = 0.8, .least_kd = 0.02, .most_kd = 0.02}, 0);
    for (FilledRecord& record : records)
        for (FilledObservation& seen : record.observations) seen.rgb += 1.0f;
    fill(records);
    EXPECT_EQ(find().fit.pairs, 0.0f);
}

// The wall is seen in one direction of six: what the others show is not known.
TEST_F(FitMirrorsTest, WhereMostRaysMeetNothingNothingIsTold) {
    std::vector<FilledRecord> records = plane(1, {.ks = 0.8, .least_kd = 0.02, .most_kd = 0.02}, 0);
    for (size_t i = 0; i < records.size(); ++i)
        if (i % 6 != 0) records[i].normal = {0, 0, -1};
    for (FilledRecord& record : records)
        if (record.normal.z < 0)
            for (FilledObservation& seen : record.observations) seen.to_viewer.z = -seen.to_viewer.z;
    fill(records);
    EXPECT_EQ(find().fit.pairs, 0.0f);
}

// A camera that begins to move sees a small part from several sides, long before the rest.
TEST_F(FitMirrorsTest, ItIsNotToldByTheFewVoxelsThatWereSeenOften) {
    for (const uint32_t often : {2u, 3u}) {
        std::vector<FilledRecord> records = plane(1, {.ks = 0.8, .least_kd = 0.02, .most_kd = 0.02}, 0);
        for (uint32_t i = 0; i < kVoxels; ++i)
            if (i % 5 >= often) records[i].observations.resize(3);
        empty();
        fill(records);
        const float pairs = find().fit.pairs;
        EXPECT_TRUE(often == 3 ? pairs > 24 : pairs == 0) << often << " of five: " << pairs;
    }
}

// A leg of a desk, of 14 voxels, whose colours happened to differ as what they would have mirrored.
TEST_F(FitMirrorsTest, AFewVoxelsAreTooFew) {
    for (const size_t voxels : {size_t{20}, size_t{30}}) {
        std::vector<FilledRecord> records = plane(1, {.ks = 0.8, .least_kd = 0.02, .most_kd = 0.02}, 0);
        records.resize(voxels);
        empty();
        fill(records);
        EXPECT_EQ(find().fit.pairs > 0, voxels == 30) << voxels;
    }
}

TEST_F(FitMirrorsTest, ALookThatFindsNothingKeepsWhatIsKnown) {
    const auto records = plane(1, {.ks = 0.8, .least_kd = 0.02, .most_kd = 0.02}, 0);
    fill(records);
    const Found known = find(6);
    ASSERT_GT(known.material.mirror, 0.9f);
    empty();
    fill(clipped(records, 0.01f));
    const Found after = find();
    EXPECT_EQ(after.material.mirror, known.material.mirror);
    EXPECT_EQ(after.material.version, known.material.version);
    EXPECT_EQ(after.fit.pairs, known.fit.pairs);
}

TEST_F(FitMirrorsTest, TheOrderOfVoxelsDoesNotMatter) {
    const auto records = plane(1, {.ks = 0.5}, 0);
    fill(records);
    const Found forwards = find();
    backwards_ = true;
    empty();
    graph::FrameGraph frame = runner().begin();
    table_.reset(frame);
    run(std::move(frame));
    fill(records);
    const Found backwards = find();
    EXPECT_EQ(forwards.fit.product, backwards.fit.product);
    EXPECT_EQ(forwards.fit.square, backwards.fit.square);
    EXPECT_EQ(forwards.fit.pairs, backwards.fit.pairs);
}

}  // namespace
}  // namespace patina::fit_mirrors_test
