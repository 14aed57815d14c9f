// Materials of metals and mirrors: from their highlights, or from the surroundings that they mirror.

#include <array>
#include <cmath>

#include "passes/specular/bound_materials.h"
#include "tests/gpu/specular/fit_ward_rig.h"

namespace patina::mirrored_material_test {
namespace {

constexpr uint32_t kLabel = 2;
const glm::vec3 kMirrored(0.9f, 0.6f, 0.3f);

/// Sums that tell kMirrored.
gpu::MirrorFit mirror_fit() {
    const float square = 0.5f, brightness = (kMirrored.r + kMirrored.g + kMirrored.b) / 3;
    return {square * glm::vec4(kMirrored, brightness), glm::vec4(square), 0.1f, 100, 0, 0};
}

class MirroredMaterial : public FitWardTest {
  protected:
    struct Got {
        gpu::WardFit fit;
        gpu::SegmentMaterial material;
    };
    Got fit_after(const std::vector<FilledRecord>& records, float mirror) {
        fill(records);
        set_mirror(kLabel, mirror_fit(), mirror);
        const gpu::WardFit got = fit({kLabel})[kLabel];
        return {got, materials_[kLabel]};
    }
    /// Too few voxels to see a highlight.
    std::vector<FilledRecord> dull() { return sphere(kLabel, {glm::dvec3(0.02), glm::dvec3(0), 0.2}, 4); }

    static void expect_mirrored(const Got& got) {
        EXPECT_EQ(got.fit.mirrored.w, gpu::kMirrorAlpha);
        EXPECT_EQ(got.material.ks_alpha, got.fit.mirrored);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(got.material.ks_alpha[c], kMirrored[c], 1e-5) << c;
        EXPECT_EQ(got.material.unobserved, 0.0f);
        EXPECT_EQ(got.material.mirror, 1.0f);
    }
};

TEST_F(MirroredMaterial, WithoutHighlightsItIsWhatSurroundingsTell) { expect_mirrored(fit_after(dull(), 1)); }

TEST_F(MirroredMaterial, ASegmentThatMayBeNoMirrorKeepsWhatHighlightsTell) {
    const Got got = fit_after(dull(), 0.8f);
    EXPECT_EQ(got.fit.mirrored, glm::vec4(0));
    EXPECT_EQ(got.material.ks_alpha, got.fit.ks_alpha);
    EXPECT_GT(got.material.unobserved, 0.5f);
}

TEST_F(MirroredMaterial, HighlightsThatAgreeAreMoreExact) {
    const Got got = fit_after(sphere(kLabel, {glm::dvec3(0.02), glm::dvec3(0.5), 0.2}), 1);
    EXPECT_EQ(got.fit.mirrored, glm::vec4(0));
    EXPECT_NEAR(got.material.ks_alpha.r, 0.5, 0.02);
    EXPECT_NEAR(got.material.ks_alpha.a, 0.2, 0.01);
}

TEST_F(MirroredMaterial, HighlightsThatTellFarLessAreNotBelieved) {
    expect_mirrored(fit_after(sphere(kLabel, {glm::dvec3(0.02), glm::dvec3(0.1), 0.2}), 1));
}

// What the room sends is taken for a lobe of the lamps' light, far wider than one that mirrors sharply.
TEST_F(MirroredMaterial, AWideLobeIsNotBelievedWhereTheSurroundingsAreMirroredSharply) {
    expect_mirrored(fit_after(sphere(kLabel, {glm::dvec3(0.02), glm::dvec3(0.5), 0.4}), 1));
}

// A brushed metal blurs what it mirrors, so that contrasts tell less of its ks than highlights do.
TEST_F(MirroredMaterial, AWideLobeIsBelievedWhereContrastsAreBlurred) {
    const Got got = fit_after(sphere(kLabel, {glm::dvec3(0.02), glm::dvec3(0.95), 0.4}), 1);
    EXPECT_EQ(got.fit.mirrored, glm::vec4(0));
    EXPECT_NEAR(got.material.ks_alpha.a, 0.4, 0.02);
}

// What is mirrored has next to no blue: its quotient would be that of two errors.
TEST_F(MirroredMaterial, AChannelThatIsHardlyMirroredHasNoMoreThanTheOthers) {
    fill(dull());
    gpu::MirrorFit told = mirror_fit();
    told.product.b = told.square.b = 1e-4f;
    set_mirror(kLabel, told, 1);
    const gpu::WardFit got = fit({kLabel})[kLabel];
    EXPECT_LT(got.mirrored.b, 0.01f);
    EXPECT_NEAR(got.mirrored.r, kMirrored.r, 1e-5);
}

TEST_F(MirroredMaterial, ItsIntervalIsThatOfWhatSurroundingsTell) {
    const Got got = fit_after(dull(), 1);
    graph::FrameGraph frame = runner().begin();
    std::vector<gpu::SegmentAlbedo> albedo(kLabels, gpu::SegmentAlbedo{glm::uvec4(1000), glm::uvec4(1000)});
    const graph::BufferId sums = frame.upload<gpu::SegmentAlbedo>("albedo", albedo);
    const graph::Readback read = frame.read_back(add_bound_materials(frame, {table_, table_.import(frame), sums}));
    run(std::move(frame));
    const auto bounds = read.as<gpu::MaterialBounds>();
    // Student's distribution with two degrees of freedom, from a table.
    constexpr std::array kAway{0.8165, 1.8856, 2.9200, 4.3027};
    for (size_t level = 0; level < kAway.size(); ++level) {
        const gpu::MaterialBounds& bound = bounds[kLabel * gpu::kBoundsLevels + level];
        for (int c = 0; c < 3; ++c) {
            const double ks = double{got.fit.mirrored[c]}, factor = std::exp(0.2 * kAway[level]);
            EXPECT_NEAR(bound.ks_alpha_low[c], ks / factor, 1e-3 * ks) << level << ' ' << c;
            EXPECT_NEAR(bound.ks_alpha_high[c], std::min(ks * factor, 1.0), 1e-3 * ks) << level << ' ' << c;
        }
        const double octaves = std::min(kAway[level], -std::log2(double{got.fit.mirrored.w}));
        EXPECT_NEAR(std::log2(bound.ks_alpha_high.w / got.fit.mirrored.w), octaves, 0.01 * octaves) << level;
        EXPECT_GT(bound.kd_low.w, 0.5f) << "it was observed";
    }
}

}  // namespace
}  // namespace patina::mirrored_material_test
