#include "tests/reference/lighting/find_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "engine/core/shader_camera.h"
#include "passes/input/convert_color.h"
#include "passes/input/convert_depth.h"
#include "reconstruction/lights/light_estimation.h"
#include "reconstruction/session/rgbd_frame.h"
#include "scenes/description/lighting_sequence.h"
#include "scenes/description/noise.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "tests/gpu/gpu_test.h"

namespace patina::find_lights_test {
namespace {

struct Lamp {
    glm::dvec3 center_m;
    double radius_m;
    glm::dvec3 intensity;
    glm::dvec3 axis{0};  ///< of a disc; else it is a sphere
};

/// A dark box-shaped room around the origin with lamps, seen pixel centre by pixel centre.
struct Room {
    std::vector<Lamp> lamps;
    double half_size_m = 3;
    double exposure = 1e-3;  ///< of the lighting sequence over that of the reflectance sequence
    bool lamps_have_depth = true;
    double depth_sigma_m = 0;
    bool mirror_wall = false;  ///< the wall at the largest z shows lamps in it
    double flying_rim = 0;     ///< share of a lamp's disc, at its rim, whose depth lies anywhere between lamp and wall
};

struct Pictures {
    Image<glm::vec3> color;
    Image<float> depth_m;
};

std::optional<double> hit_disc(const Lamp& lamp, glm::dvec3 origin_m, glm::dvec3 direction) {
    const double facing = -glm::dot(direction, lamp.axis);
    if (facing <= 0) return std::nullopt;
    const double along = glm::dot(origin_m - lamp.center_m, lamp.axis) / facing;
    if (along <= 0 || glm::distance(origin_m + along * direction, lamp.center_m) > lamp.radius_m) return std::nullopt;
    return along;
}

std::optional<double> hit_lamp(const Lamp& lamp, glm::dvec3 origin_m, glm::dvec3 direction) {
    if (lamp.axis != glm::dvec3(0)) return hit_disc(lamp, origin_m, direction);
    const glm::dvec3 offset = origin_m - lamp.center_m;
    const double b = glm::dot(offset, direction), c = glm::dot(offset, offset) - lamp.radius_m * lamp.radius_m;
    const double discriminant = b * b - c;
    if (discriminant < 0 || -b - std::sqrt(discriminant) <= 0) return std::nullopt;
    return -b - std::sqrt(discriminant);
}

glm::dvec3 radiance_of(const Lamp& lamp) { return lamp.intensity / (std::numbers::pi * lamp.radius_m * lamp.radius_m); }

/// What a mirror at the largest z shows where a ray meets it.
glm::dvec3 mirrored(const Room& room, glm::dvec3 at_m, glm::dvec3 direction) {
    for (const Lamp& lamp : room.lamps)
        if (hit_lamp(lamp, at_m, direction * glm::dvec3(1, 1, -1))) return radiance_of(lamp);
    return glm::dvec3(0.5);
}

double hit_walls(double half_size_m, glm::dvec3 origin_m, glm::dvec3 direction) {
    double nearest_m = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double wall_m = std::copysign(half_size_m, direction[axis]);
        if (direction[axis] != 0) nearest_m = std::min(nearest_m, (wall_m - origin_m[axis]) / direction[axis]);
    }
    return nearest_m;
}

Pictures look(const Room& room, const Intrinsics& camera, const RigidTransform& world_from_camera,
              std::mt19937& random) {
    std::normal_distribution<double> noise(0, 1);
    Pictures out{Image<glm::vec3>(camera.extent), Image<float>(camera.extent)};
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            const glm::dvec3 ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
            const glm::dvec3 direction = glm::dmat3(world_from_camera) * glm::normalize(ray);
            double range_m = hit_walls(room.half_size_m, glm::dvec3(world_from_camera[3]), direction);
            glm::dvec3 radiance(0.5);  // the room at the reflectance sequence's exposure
            const glm::dvec3 on_wall_m = glm::dvec3(world_from_camera[3]) + range_m * direction;
            if (room.mirror_wall && on_wall_m.z > room.half_size_m - 1e-6)
                radiance = mirrored(room, on_wall_m, direction);
            bool has_depth = true;
            double flown_m = 0;
            for (const Lamp& lamp : room.lamps) {
                const auto hit = hit_lamp(lamp, glm::dvec3(world_from_camera[3]), direction);
                if (!hit || *hit > range_m) continue;
                const glm::dvec3 to_lamp = lamp.center_m - glm::dvec3(world_from_camera[3]);
                const double across_m = glm::length(glm::cross(direction, to_lamp));
                const bool rim = across_m * across_m > (1 - room.flying_rim) * lamp.radius_m * lamp.radius_m;
                flown_m = rim ? std::uniform_real_distribution<double>(0, range_m - *hit)(random) : 0;
                range_m = *hit;
                radiance = radiance_of(lamp);
                has_depth = room.lamps_have_depth;
            }
            const double z_m = (range_m + flown_m) / glm::length(ray) + room.depth_sigma_m * noise(random);
            out.depth_m.at(x, y) = has_depth ? static_cast<float>(z_m) : 0.0f;
            out.color.at(x, y) = glm::vec3(radiance * room.exposure);
        }
    }
    return out;
}

/// Level, at the origin's height, moving sideways and turning.
RigidTransform pose(int frame) {
    const double angle = -0.5 + 0.1 * frame;
    const glm::dvec3 forward(std::sin(angle), -0.25, std::cos(angle)), down(0, 1, 0);
    const glm::dvec3 f = glm::normalize(forward), right = glm::normalize(glm::cross(down, f));
    return {glm::dvec4(right, 0), glm::dvec4(glm::cross(f, right), 0), glm::dvec4(f, 0),
            glm::dvec4(-0.8 + 0.16 * frame, 0.3, -1.0, 1)};
}

const Intrinsics kCamera{{256, 212}, 182, 182, 127.5, 105.5, {}};

class FindLights : public GpuTest {
  protected:
    static constexpr int kFrames = 10;

    std::vector<FoundLight> find(const Room& room, const Intrinsics& depth_camera, const Intrinsics& color_camera,
                                 const RigidTransform& color_from_depth = RigidTransform(1.0)) {
        LightEstimation estimation(device(), {});
        std::mt19937 random(7);
        for (int i = 0; i < kFrames; ++i) {
            const RigidTransform world_from_color = pose(i) * rigid_inverse(color_from_depth);
            const Pictures of_depth = look(room, depth_camera, pose(i), random);
            const Pictures of_color = look(room, color_camera, world_from_color, random);
            RgbdFrame frame;
            frame.depth = {std::span<const float>(of_depth.depth_m.pixels()), depth_camera, 1.0, 20.0};
            frame.color = {std::span<const glm::vec3>(of_color.color.pixels()), color_camera};
            frame.color_from_depth = color_from_depth;
            frame.world_from_depth = pose(i);
            estimation.add(frame, static_cast<float>(1 / room.exposure));
        }
        return estimation.found();
    }

    /// What one frame shows from the origin, along the z axis.
    std::vector<FoundLight> found_in_one_frame(const Room& room) {
        LightEstimation estimation(device(), {.find = {}, .min_sightings = 1});
        std::mt19937 random(3);
        const RigidTransform straight(1.0);
        const Pictures pictures = look(room, kCamera, straight, random);
        RgbdFrame frame;
        frame.depth = {std::span<const float>(pictures.depth_m.pixels()), kCamera, 1.0, 20.0};
        frame.color = {std::span<const glm::vec3>(pictures.color.pixels()), kCamera};
        frame.world_from_depth = straight;
        estimation.add(frame, static_cast<float>(1 / room.exposure));
        return estimation.found();
    }

    static void expect_found(const std::vector<FoundLight>& found, const std::vector<Lamp>& lamps, double within_m,
                             double relative) {
        ASSERT_EQ(found.size(), lamps.size());
        for (const Lamp& lamp : lamps) {
            const auto nearest = std::min_element(found.begin(), found.end(), [&](const auto& a, const auto& b) {
                return glm::distance(a.light.position_m, lamp.center_m) <
                       glm::distance(b.light.position_m, lamp.center_m);
            });
            const auto& [light, evidence] = *nearest;
            EXPECT_LT(glm::distance(light.position_m, lamp.center_m), within_m);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(light.intensity[c], lamp.intensity[c], relative * lamp.intensity[c]);
            EXPECT_NEAR(light.radius_m, lamp.radius_m, 0.1 * lamp.radius_m + within_m / 4);
            EXPECT_GE(evidence.sightings, 5u);
            ASSERT_EQ(is_flat(light), lamp.axis != glm::dvec3(0));
            if (lamp.axis != glm::dvec3(0)) {
                EXPECT_GT(glm::dot(light.axis, lamp.axis), 0.98);
            }
        }
    }
};

Room three_lamps() {
    Room room;
    room.lamps = {{{-0.7, -0.9, 1.5}, 0.06, {12, 10, 8}},
                  {{0.6, -0.4, 2.0}, 0.10, {20, 20, 22}},
                  {{0.1, -1.0, 1.0}, 0.05, {5, 6, 7}}};
    return room;
}

TEST_F(FindLights, CentresAndIntensitiesOfSphereLamps) {
    const Room room = three_lamps();
    expect_found(find(room, kCamera, kCamera), room.lamps, 0.01, 0.03);
}

TEST_F(FindLights, DepthNoiseDoesNotMoveThem) {
    Room room = three_lamps();
    room.depth_sigma_m = 0.005;
    expect_found(find(room, kCamera, kCamera), room.lamps, 0.015, 0.04);
}

TEST_F(FindLights, FlyingPixelsAtTheRimDoNotMoveThem) {
    Room room = three_lamps();
    room.flying_rim = 0.2;
    expect_found(find(room, kCamera, kCamera), room.lamps, 0.02, 0.1);
}

// Kernels of 0.15 m and 0.1 rad hold a part of them.
TEST_F(FindLights, LargeLampsAreOneEach) {
    Room room;
    room.lamps = {{{-0.7, -0.6, 1.9}, 0.30, {80, 70, 60}}, {{0.9, -0.4, 2.0}, 0.22, {60, 60, 66}}};
    expect_found(find(room, kCamera, kCamera), room.lamps, 0.02, 0.03);
    room.depth_sigma_m = 0.005;
    expect_found(find(room, kCamera, kCamera), room.lamps, 0.02, 0.04);
    room.lamps_have_depth = false;
    expect_found(find(room, kCamera, kCamera), room.lamps, 0.03, 0.05);
}

// What they are seen to send goes with the cosine to their axes.
TEST_F(FindLights, DiscsShineToOneSideAlone) {
    Room room;
    room.lamps = {{{1.0, -0.6, 1.6}, 0.15, {30, 28, 20}, {-1, 0, 0}},
                  {{-0.6, -0.7, 1.6}, 0.12, {20, 20, 22}, glm::normalize(glm::dvec3(1, 0.4, -0.6))},
                  {{0.1, -1.0, 1.0}, 0.05, {5, 6, 7}}};
    expect_found(find(room, kCamera, kCamera), room.lamps, 0.02, 0.08);
    room.depth_sigma_m = 0.005;
    expect_found(find(room, kCamera, kCamera), room.lamps, 0.02, 0.1);
    room.lamps_have_depth = false;
    expect_found(find(room, kCamera, kCamera), room.lamps, 0.03, 0.1);
}

// Readings between lamp and glass fill the gap.
TEST_F(FindLights, ALampBeforeAMirrorDoesNotGrowOverItsImage) {
    Room room;
    room.lamps = {{{-0.12, -0.9, 2.78}, 0.05, {12, 12, 12}}, {{0.13, -0.9, 2.78}, 0.05, {12, 12, 12}}};
    room.mirror_wall = true;
    room.flying_rim = 0.2;
    room.depth_sigma_m = 0.003;
    std::vector<FoundLight> before_the_mirror = find(room, kCamera, kCamera);
    std::erase_if(before_the_mirror, [](const FoundLight& f) { return f.light.position_m.z > 2.9; });
    expect_found(before_the_mirror, room.lamps, 0.03, 0.15);
}

TEST_F(FindLights, ColourCameraOfItsOwnSizeAndPlace) {
    const Room room = three_lamps();
    const Intrinsics color{{400, 300}, 300, 300, 200, 149, {}};
    RigidTransform color_from_depth(1.0);
    color_from_depth[3] = {-0.05, 0.01, 0.003, 1};
    expect_found(find(room, kCamera, color, color_from_depth), room.lamps, 0.02, 0.05);
}

TEST_F(FindLights, WithoutDepthTheyAreTriangulated) {
    Room room = three_lamps();
    room.lamps_have_depth = false;
    const auto found = find(room, kCamera, kCamera);
    expect_found(found, room.lamps, 0.02, 0.05);
    for (const FoundLight& light : found) EXPECT_FALSE(light.evidence.has_depth);
}

TEST_F(FindLights, OneFrameMatchesTheReference) {
    Room with_depth = three_lamps(), without_depth = three_lamps(), flying = three_lamps();
    without_depth.lamps_have_depth = false;
    flying.flying_rim = 0.2;
    Room large, large_without;
    large.lamps = {{{-0.7, -0.6, 1.9}, 0.30, {80, 70, 60}}, {{0.9, -0.4, 2.0}, 0.22, {60, 60, 66}}};
    large_without.lamps = large.lamps;
    large_without.lamps_have_depth = false;
    for (const Room& room : {with_depth, without_depth, flying, large, large_without}) {
        std::mt19937 random(3);
        const Pictures pictures = look(room, kCamera, pose(5), random);
        const LightTracks tracks(device());
        graph::FrameGraph frame = runner().begin();
        tracks.reset(frame);
        run(std::move(frame));
        frame = runner().begin();
        LightTrackIds ids = tracks.import(frame);
        const gpu::Camera camera = make_camera(kCamera, pose(5));
        const auto scale = static_cast<float>(1 / room.exposure);
        const graph::ImageId depth_m =
            add_convert_depth(frame, {std::span<const float>(pictures.depth_m.pixels()), kCamera, 1.0, 20.0});
        const graph::ImageId color =
            add_convert_color(frame, {std::span<const glm::vec3>(pictures.color.pixels()), kCamera});
        add_find_lights(frame, ids, {depth_m, camera, color, camera, scale}, {});
        LightTracks::keep(frame, ids);
        const graph::Readback history = frame.read_back(ids.history);
        run(std::move(frame));

        const auto got = history.as<gpu::LightSighting>();
        const auto expected = reference::find_lights(pictures.color, pictures.depth_m, kCamera, pose(5),
                                                     {.bandwidth_chord = 2 * std::sin(0.05), .radiance_scale = scale});
        ASSERT_EQ(expected.size(), room.lamps.size());
        for (size_t i = 0; i < expected.size(); ++i) {
            const gpu::LightSighting& g = got[i * gpu::kMaxSightings];
            const reference::Sighting& e = expected[i];
            EXPECT_EQ(g.has_depth != 0, e.has_depth);
            EXPECT_LT(glm::distance(glm::dvec3(g.center_radius), e.has_depth ? e.center_m : glm::dvec3(pose(5)[3])),
                      1e-4);
            EXPECT_LT(glm::distance(glm::dvec3(g.bearing), e.bearing), 1e-5);
            EXPECT_NEAR(g.center_radius.w, e.radius_m, 1e-4);
            EXPECT_NEAR(g.bearing.w, e.solid_angle_sr, 2e-3 * e.solid_angle_sr) << "colours are halves";
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(g.intensity[c], e.intensity[c], 5e-3 * e.intensity[c]);
        }
    }
}

TEST_F(FindLights, OfWhatIsLargerThanALampOnlyAKernelIsTaken) {
    Room room;
    room.lamps = {{{0, -0.2, 2.6}, 0.8, {600, 600, 600}}};
    const auto found = found_in_one_frame(room);
    ASSERT_FALSE(found.empty());
    for (const FoundLight& f : found) EXPECT_LT(f.light.radius_m, 0.2);
}

// Within the kernel of 0.15 m it counts, beyond it does not.
TEST_F(FindLights, AFaintGlowAroundALampMakesItNoLarger) {
    Room room;
    room.lamps = {{{0, -0.2, 1.5}, 0.06, {17, 17, 17}}, {{0, -0.2, 1.81}, 0.32, {39, 39, 39}}};
    const auto found = found_in_one_frame(room);
    ASSERT_FALSE(found.empty());
    EXPECT_NEAR(found[0].light.intensity.g, 17 * 1.4, 17 * 0.25);
    EXPECT_LT(found[0].light.radius_m, 0.1);
}

TEST_F(FindLights, CutOffLampsAreLeftOut) {
    Room room;
    room.lamps = {{{0, 0, 1.0}, 0.05, {5, 5, 5}}};
    Intrinsics narrow = kCamera;
    narrow.cx = -12;  // the lamp is cut by the left border
    LightEstimation estimation(device(), {.find = {}, .min_sightings = 1});
    std::mt19937 random(3);
    RigidTransform straight(1.0);
    straight[3] = {-0.06, 0, 0, 1};
    const Pictures pictures = look(room, narrow, straight, random);
    float brightest = 0;
    for (const glm::vec3& pixel : pictures.color.pixels()) brightest = std::max(brightest, pixel.g);
    ASSERT_GT(brightest, 0.5f) << "the lamp must be in the picture";
    RgbdFrame frame;
    frame.depth = {std::span<const float>(pictures.depth_m.pixels()), narrow, 1.0, 20.0};
    frame.color = {std::span<const glm::vec3>(pictures.color.pixels()), narrow};
    frame.world_from_depth = straight;
    estimation.add(frame, 1000);
    EXPECT_TRUE(estimation.found().empty());
}

// Closer than sightings of one lamp in two frames may be.
TEST_F(FindLights, WhatOneFrameShowsApartAreTwoLamps) {
    Room room;
    room.lamps = {{{-0.12, -1.0, 1.5}, 0.06, {12, 12, 12}}, {{0.13, -1.0, 1.5}, 0.06, {10, 10, 10}}};
    expect_found(find(room, kCamera, kCamera), room.lamps, 0.01, 0.05);
}

TEST_F(FindLights, TheImageOfALampInAMirrorIsNone) {
    Room room;
    room.lamps = {{{0.5, -1.8, 2.6}, 0.06, {9, 9, 9}}, {{-0.6, -1.7, 2.65}, 0.06, {12, 12, 12}}};
    room.mirror_wall = true;
    expect_found(find(room, kCamera, kCamera), room.lamps, 0.02, 0.1);
}

TEST_F(FindLights, ADarkRoomHasNone) { EXPECT_TRUE(find(Room{}, kCamera, kCamera).empty()); }

TEST_F(FindLights, LampsOfTheOfficeWithTheNoiseOfAKinect) {
    scenes::SyntheticScene scene = scenes::load_scene("office");
    scene.camera = scaled_to(scene.camera, {256, 212});
    scene.recording.noise = scenes::noise_preset("kinect2");
    scene.recording.render.shadows = false;  // lamps shine all the same
    auto lighting = scenes::lighting_sequence(scene);
    ASSERT_TRUE(lighting.has_value());
    lighting->scene.fps /= 6;  // the same path in fewer frames
    scenes::SyntheticSource source(device(), lighting->scene,
                                   {.frames = lighting->frames / 6, .exposure = lighting->exposure});
    LightEstimation estimation(device(), {.find = {}, .min_sightings = 3});
    while (const auto reading = source.next()) {
        const auto& frame = std::get<Frame>(*reading);
        estimation.add(patina::to_rgbd(source.info(), frame), static_cast<float>(1 / lighting->exposure));
    }
    const auto found = estimation.found();
    ASSERT_EQ(found.size(), scene.lights.size());
    for (const Light& lamp : scene.lights) {
        const auto off_m = [&](const FoundLight& f) { return glm::distance(f.light.position_m, lamp.position_m); };
        const auto nearest = std::min_element(found.begin(), found.end(),
                                              [&](const auto& a, const auto& b) { return off_m(a) < off_m(b); });
        EXPECT_LT(off_m(*nearest), 0.04);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(nearest->light.intensity[c], lamp.intensity[c], 0.1 * lamp.intensity[c]);
    }
}

TEST_F(FindLights, SameInputGivesTheSameBytes) {
    const Room room = three_lamps();
    const auto first = find(room, kCamera, kCamera), second = find(room, kCamera, kCamera);
    ASSERT_EQ(first.size(), second.size());
    for (size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].light, second[i].light);
        EXPECT_EQ(first[i].evidence.spread_m, second[i].evidence.spread_m);
    }
}

}  // namespace
}  // namespace patina::find_lights_test
