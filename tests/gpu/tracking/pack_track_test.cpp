#include <algorithm>
#include <random>

#include "tests/gpu/input/input_pictures.h"
#include "tests/gpu/tracking/track_rig.h"

namespace patina::pack_track_test {
namespace {

using reference::TrackReading;
using reference::TrackSurface;

/// A colour picture of noise, one pixel in eight clipped, taken a little beside the depth camera.
reference::TrackPicture random_picture(Extent2D extent, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(0.0f, 1.2f);
    reference::TrackPicture picture{Image<glm::vec4>(extent), pinhole_camera(extent), RigidTransform(1.0)};
    picture.color_from_depth[3] = glm::dvec4(-0.03, 0.01, 0.004, 1);
    for (glm::vec4& pixel : picture.linear.pixels())
        pixel = glm::vec4(value(random), value(random), value(random), random() % 8 == 0 ? 0.5f : 1.0f);
    picture.linear = rounded_to_halves(picture.linear);
    return picture;
}

/// Steps and slopes as random_depth has them, but most neighbours on one surface.
Image<float> stepped_depth(Extent2D extent, uint32_t seed) {
    Image<float> depth_m = random_depth(extent, seed);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            if (x % 7 != 3)
                depth_m.at(x, y) = (x / 7 + y / 6) % 3 == 0 ? 1.4f : 1.41f + 0.004f * static_cast<float>(x % 7);
        }
    }
    return depth_m;
}

class PackTrackTest : public TrackTest {
  protected:
    static SeenScene random_scene(const Intrinsics& camera, uint32_t seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> part(-1, 1);
        SeenScene seen{stepped_depth(camera.extent, seed), Image<glm::vec4>(camera.extent),
                       Image<glm::vec4>(camera.extent), Image<glm::vec4>(camera.extent)};
        for (size_t i = 0; i < camera.extent.area(); ++i) {
            const float z = seen.depth_m.pixels()[i];
            const glm::vec3 normal = glm::normalize(glm::vec3(part(random), part(random), -1.5f));
            seen.position_m.pixels()[i] = glm::vec4(part(random), part(random), z, z);
            seen.normal.pixels()[i] = glm::vec4(z > 0 && random() % 9 > 0 ? normal : glm::vec3(0), 0);
            seen.color.pixels()[i] =
                glm::vec4(std::abs(part(random)), std::abs(part(random)), 0.4f, random() % 16 == 0 ? 0.0f : 1.0f);
        }
        seen.normal = rounded_to_halves(seen.normal);
        seen.color = rounded_to_halves(seen.color);
        return seen;
    }
};

constexpr double kDepthStep = 1.0 / 65536, kShadeStep = 1.0 / 2047;

void expect_equal(const Image<TrackReading>& got, const Image<TrackReading>& want, double steps) {
    ASSERT_EQ(got.extent(), want.extent());
    size_t known = 0, disputed = 0;
    for (size_t i = 0; i < got.pixels().size(); ++i) {
        ASSERT_NEAR(got.pixels()[i].depth_m, want.pixels()[i].depth_m, steps * kDepthStep) << i;
        // Single precision may see a little of a clipped pixel where double precision sees none.
        if ((got.pixels()[i].shade < 0) != (want.pixels()[i].shade < 0) && ++disputed <= got.pixels().size() / 10000)
            continue;
        ASSERT_NEAR(got.pixels()[i].shade, want.pixels()[i].shade, steps * kShadeStep) << i;
        known += want.pixels()[i].depth_m > 0 ? 1 : 0;
    }
    if (got.extent().area() > 100) {
        EXPECT_GT(known, got.extent().area() / 8);
    }
}

TEST_F(PackTrackTest, FramesAgreeWithTheReference) {
    for (const Extent2D extent : kPictureExtents) {
        const Intrinsics camera = pinhole_camera(extent);
        SeenScene seen;
        seen.depth_m = stepped_depth(extent, 3);
        const reference::TrackPicture picture = random_picture({extent.width + 3, extent.height + 1}, 4);
        graph::FrameGraph frame = runner().begin();
        const TrackLevel fine = pack_frame(frame, seen, camera, picture);
        const graph::Readback read = frame.read_back(fine.pixels);
        std::optional<graph::Readback> read_half, read_packed_half;
        if (extent.width > 1) {
            read_half = frame.read_back(add_halve_frame(frame, fine).pixels);
            read_packed_half = frame.read_back(pack_frame(frame, seen, camera, picture, true).pixels);
        }
        run(std::move(frame));
        const Image<TrackReading> got = readings(read.as<uint32_t>(), extent);
        // The device's square root and weights of pixels may be off in the last digits.
        expect_equal(got, reference::pack_frame(seen.depth_m, camera, picture, 6), 0.75);
        if (!read_half) continue;
        const Extent2D half{extent.width / 2, extent.height / 2};
        expect_equal(readings(read_half->as<uint32_t>(), half), reference::halve_frame(got), 0.75);
        expect_equal(readings(read_packed_half->as<uint32_t>(), half),
                     reference::pack_frame(seen.depth_m, camera, picture, 6, true), 0.75);
    }
}

TEST_F(PackTrackTest, WithoutColoursThereAreNoShades) {
    const Intrinsics camera = pinhole_camera({16, 16});
    SeenScene seen;
    seen.depth_m = Image<float>(camera.extent, 1.0f);
    seen.depth_m.at(5, 5) = 7.0f;  // too far, and its neighbours lie beside a jump
    graph::FrameGraph frame = runner().begin();
    const graph::Readback read = frame.read_back(pack_frame(frame, seen, camera, std::nullopt).pixels);
    run(std::move(frame));
    const Image<TrackReading> got = readings(read.as<uint32_t>(), camera.extent);
    for (uint32_t y = 0; y < 16; ++y) {
        for (uint32_t x = 0; x < 16; ++x) {
            const uint32_t away = (x > 5 ? x - 5 : 5 - x) + (y > 5 ? y - 5 : 5 - y);
            EXPECT_EQ(got.at(x, y).depth_m, away <= 1 ? 0 : 1);
            EXPECT_EQ(got.at(x, y).shade, -1);
        }
    }
}

void expect_equal(const Image<TrackSurface>& got, const Image<TrackSurface>& want) {
    ASSERT_EQ(got.extent(), want.extent());
    size_t known = 0, shaded = 0;
    for (size_t i = 0; i < got.pixels().size(); ++i) {
        const TrackSurface &a = got.pixels()[i], &b = want.pixels()[i];
        ASSERT_NEAR(a.depth_m, b.depth_m, 1e-6 * b.depth_m) << i;
        if (b.depth_m <= 0) continue;
        // Half a step of 16 bits. Normals come as half floats, which may be a little too long.
        ASSERT_LT(glm::length(a.normal - glm::clamp(b.normal, -1.0, 1.0)), 3e-5) << i;
        ASSERT_NEAR(a.shade_per_px.x, std::clamp(b.shade_per_px.x, -1.0, 1.0), 2e-5) << i;
        ASSERT_NEAR(a.shade_per_px.y, std::clamp(b.shade_per_px.y, -1.0, 1.0), 2e-5) << i;
        ASSERT_NEAR(std::max(a.shade, 0.0), std::max(b.shade, 0.0), 4e-5) << i;
        ASSERT_EQ(a.shade < 0, b.shade < 0) << i;
        ++known;
        shaded += b.shade >= 0 ? 1 : 0;
    }
    if (got.extent().area() > 1000) {
        EXPECT_GT(known, got.extent().area() / 8);
        EXPECT_GT(shaded, got.extent().area() / 100);
    }
}

TEST_F(PackTrackTest, TheModelAgreesWithTheReference) {
    for (const Extent2D extent : kPictureExtents) {
        const Intrinsics camera = pinhole_camera(extent);
        const SeenScene seen = random_scene(camera, 9);
        const RigidTransform pose = reference::look_at({0.1, -0.2, -0.1}, {0, 0, 5});
        graph::FrameGraph frame = runner().begin();
        const TrackLevel fine = pack_model(frame, seen, camera, pose, true);
        const graph::Readback read = frame.read_back(fine.pixels);
        std::optional<graph::Readback> read_half, read_packed_half;
        const Extent2D half{extent.width / 2, extent.height / 2};
        if (extent.width > 1) {
            const auto target = frame.create_image("half", {half, vulkan::Format::kRgba32u});
            read_half = frame.read_back(add_halve_model(frame, fine.pixels, target));
            read_packed_half = frame.read_back(pack_model(frame, seen, camera, pose, true, true).pixels);
        }
        run(std::move(frame));
        const Image<TrackSurface> got = surfaces(read.as<uint32_t>(), extent);
        const Image<TrackSurface> want = reference::pack_model(seen.position_m, seen.normal, seen.color, camera, pose);
        expect_equal(got, want);
        if (!read_half) continue;
        expect_equal(surfaces(read_half->as<uint32_t>(), half), reference::halve_model(got));
        expect_equal(surfaces(read_packed_half->as<uint32_t>(), half), reference::halve_model(want));
    }
}

TEST_F(PackTrackTest, ATargetOfAnotherSizeIsAnError) {
    const Intrinsics camera = pinhole_camera({16, 8});
    graph::FrameGraph frame = runner().begin();
    const graph::ImageId position = frame.create_image("position", {camera.extent, vulkan::Format::kRgba32f});
    const graph::ImageId target = frame.create_image("target", {{9, 4}, vulkan::Format::kRgba32u});
    EXPECT_THAT(
        [&] {
            add_pack_model(frame, {{position, position}, {}, {}}, target);
        },
        ::testing::ThrowsMessage<Error>(::testing::HasSubstr("got an image of 16 x 8 pixels and one of 9 x 4")));
}

TEST_F(PackTrackTest, HalvingNothingIsAnError) {
    graph::FrameGraph frame = runner().begin();
    const TrackLevel thin{frame.create_image("thin", {{8, 1}, vulkan::Format::kR32u}), pinhole_camera({8, 1})};
    EXPECT_THAT([&] { add_halve_frame(frame, thin); },
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("cannot halve an image of 8 x 1")));
}

}  // namespace
}  // namespace patina::pack_track_test
