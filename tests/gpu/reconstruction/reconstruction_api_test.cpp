// What a reconstruction of frames does where its options leave it open.

#include <algorithm>

#include <gmock/gmock.h>

#include "patina/reconstruction.h"

namespace patina::reconstruction_api_test {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Ne;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;
using ::testing::Truly;

const Intrinsics kCamera{{64, 48}, 60, 60, 31.5, 23.5};

/// A wall one metre ahead.
struct Wall {
    std::vector<uint16_t> depth = std::vector<uint16_t>(kCamera.extent.area(), 1000);
    std::vector<glm::u8vec3> color = std::vector<glm::u8vec3>(kCamera.extent.area(), glm::u8vec3(128));

    RgbdFrame frame() const { return {.depth = {.pixels = depth, .camera = kCamera}, .color = {color, kCamera}}; }
};

class ReconstructionApiTest : public ::testing::Test {
  protected:
    void TearDown() override { EXPECT_THAT(device_.validation_messages(), IsEmpty()); }

    static ReconstructionOptions lit() {
        ReconstructionOptions options;
        options.lighting.lights = {{glm::dvec3(0), glm::dvec3(2), 0.05}};
        return options;
    }

    Scene scene_of(Reconstruction&& reconstruction) { return scene_of(reconstruction); }
    Scene scene_of(Reconstruction& reconstruction) {
        for (int i = 0; i < 3; ++i) EXPECT_TRUE(reconstruction.add(wall_.frame()).fused);
        return reconstruction.finish();
    }

    Wall wall_;
    Device device_{DeviceChoice{.validation = true}};
};

TEST_F(ReconstructionApiTest, LightMakesSegmentsWithMaterials) {
    Reconstruction reconstruction(device_, lit());
    const Scene scene = scene_of(reconstruction);
    EXPECT_THAT(scene.reflectance.labels, Contains(Ne(0u)));
    const auto& segments = scene.reflectance.segments;
    EXPECT_TRUE(std::ranges::any_of(segments, [](const SegmentReflectance& s) { return s.voxels > 0 && s.kd; }));
    // A wall seen from one place shows no gloss, but it is looked for.
    EXPECT_THAT(reconstruction.statistics().passes, Contains(Field(&PassTime::name, StartsWith("specular."))));
}

TEST_F(ReconstructionApiTest, WithoutLabelsAlbedoIsAllThereIs) {
    ReconstructionOptions options = lit();
    options.labels = Labels::kOff;
    for (size_t i = 0; i < wall_.depth.size(); ++i)
        if (i % kCamera.extent.width >= 32) wall_.depth[i] = 0;
    const Scene scene = scene_of(Reconstruction(device_, options));
    EXPECT_THAT(scene.reflectance.kd, Contains(Truly([](glm::vec4 kd) { return kd.a == 1; })));
    EXPECT_THAT(scene.reflectance.labels, Not(Contains(Ne(0u))));
    // Right of the wall there is light from afar.
    ASSERT_EQ(scene.far_field.extent(), (Extent2D{32, 32}));
    int known = 0;
    for (uint32_t y = 0; y < 32; ++y) {
        for (uint32_t x = 0; x < 32; ++x) {
            const glm::vec4 radiance = scene.far_field.at(x, y);
            if (radiance.a == 0) continue;
            ++known;
            EXPECT_GE(x, 16u);
            EXPECT_NEAR(radiance.g, 0.2159, 1e-3);
        }
    }
    EXPECT_GT(known, 5);
}

TEST_F(ReconstructionApiTest, AWindowIsPartOfTheLighting) {
    constexpr uint32_t kFrames = 16;  // each looks at a sixteenth of the pixels
    for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
        for (uint32_t x = 0; x < kCamera.extent.width; ++x) {
            const uint32_t pixel = y * kCamera.extent.width + x;
            if (y >= 40) wall_.depth[pixel] = 500;  // a table before the wall
            if (y < 14 || y >= 34 || x < 20 || x >= 44) continue;
            wall_.depth[pixel] = 0;
            wall_.color[pixel] = glm::u8vec3(255);
        }
    }
    Reconstruction reconstruction(device_, lit());
    for (uint32_t i = 0; i < kFrames; ++i) ASSERT_TRUE(reconstruction.add(wall_.frame()).fused);
    const Scene scene = reconstruction.finish();
    ASSERT_THAT(scene.lighting.windows, SizeIs(1));
    const AreaLight& window = scene.lighting.windows.front();
    EXPECT_LT(glm::distance(window.center_m, {0, 0, 1}), 0.05);
    EXPECT_LT(normal_of(window).z, -0.95) << "towards the table";
    const double u_m = glm::length(window.half_u_m), v_m = glm::length(window.half_v_m);
    EXPECT_NEAR(std::max(u_m, v_m), 0.2, 0.035);
    EXPECT_NEAR(std::min(u_m, v_m), 1.0 / 6, 0.035);
    EXPECT_NEAR(window.radiance.g, 1, 1e-2);
    EXPECT_TRUE(window.clipped);
}

TEST_F(ReconstructionApiTest, WithoutLightThereAreSegmentsButNoMaterials) {
    Reconstruction reconstruction(device_);
    EXPECT_THAT(scene_of(reconstruction).reflectance.kd, IsEmpty());
    const PendingView pending = reconstruction.view(kCamera, RigidTransform(1.0));
    reconstruction.wait();
    EXPECT_FALSE(pending.get().reflectance);
    EXPECT_NE(pending.get().label.at(32, 24), 0u);
}

TEST_F(ReconstructionApiTest, PosesAreGivenUnlessTrackingIsAskedFor) {
    EXPECT_FALSE(Reconstruction(device_).tracks());
    EXPECT_TRUE(Reconstruction(device_, {.poses = Poses::kTrack}).tracks());
    ReconstructionOptions options;
    options.settings.set("tracking.levels", "3");
    EXPECT_TRUE(Reconstruction(device_, options).tracks());
    options.poses = Poses::kGiven;
    EXPECT_FALSE(Reconstruction(device_, options).tracks());
}

// Tracking predicts what the model looks like before the frame's own light is gathered.
TEST_F(ReconstructionApiTest, TrackedFramesGatherLight) {
    ReconstructionOptions options = lit();
    options.poses = Poses::kTrack;
    Reconstruction reconstruction(device_, options);
    EXPECT_TRUE(reconstruction.add(wall_.frame()).fused);
    for (int i = 0; i < 2; ++i) reconstruction.add(wall_.frame());
    reconstruction.wait();
    const std::vector<PassTime> passes = reconstruction.statistics().passes;
    for (const char* name : {"reflectance.gather_irradiance", "tracking.hide_highlights"})
        EXPECT_THAT(passes, Contains(Field(&PassTime::name, StartsWith(name))));
}

TEST_F(ReconstructionApiTest, WhatCannotBeMetIsOneSentence) {
    ReconstructionOptions options = lit();
    options.materials = Materials::kTruth;
    EXPECT_THAT([&] { Reconstruction(device_, options); }, ThrowsMessage<Error>(HasSubstr("belong to a sequence")));
    options.materials = Materials::kNetwork;
    options.network = "/nowhere";
    EXPECT_THAT([&] { Reconstruction(device_, options); }, ThrowsMessage<Error>(HasSubstr("/nowhere")));
    Reconstruction reconstruction(device_);
    EXPECT_THAT(
        [&] {
            reconstruction.view({{0, 0}, 60, 60, 0, 0}, RigidTransform(1.0));
        },
        ThrowsMessage<Error>(HasSubstr("0 x 0")));
    EXPECT_THAT(
        [&] {
            reconstruction.view({{64, 48}, 0, 60, 0, 0}, RigidTransform(1.0));
        },
        ThrowsMessage<Error>(HasSubstr("fx 0")));
    EXPECT_THAT([&] { reconstruction.view(kCamera, RigidTransform(2.0)); },
                ThrowsMessage<Error>(HasSubstr("not rigid")));
}

}  // namespace
}  // namespace patina::reconstruction_api_test
