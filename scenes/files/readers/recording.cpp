#include "scenes/files/readers/recording.h"

#include <cstdint>

#include "scenes/description/noise.h"
#include "scenes/files/readers/values.h"

namespace patina::scenes {
namespace {

constexpr uint64_t kMostBounces = 64;
constexpr uint64_t kMostSamples = 1 << 20;

SensorNoise read_noise(const sensor::JsonValue& value) {
    if (value.is_string()) return located(value, [&] { return noise_preset(value.string()); });
    value.expect_keys(
        {"depth_constant_m", "depth_quadratic_per_m", "depth_offset_m", "flying_pixels", "color_read", "color_shot"});
    SensorNoise noise;
    const auto read = [&](const char* key, double most, double& number) {
        if (const auto member = value.find(key)) number = member->number_within(0, most);
    };
    read("depth_constant_m", kLargestValue, noise.depth_constant_m);
    read("depth_quadratic_per_m", kLargestValue, noise.depth_quadratic_per_m);
    read("depth_offset_m", kLargestValue, noise.depth_offset_m);
    read("flying_pixels", 1, noise.flying_pixels);
    read("color_read", kLargestValue, noise.color_read);
    read("color_shot", kLargestValue, noise.color_shot);
    return noise;
}

void read_pose_noise(const sensor::JsonValue& value, SensorNoise& noise) {
    value.expect_keys({"translation", "rotation_degrees"});
    if (const auto translation = value.find("translation"))
        noise.pose_translation_m = translation->number_within(0, kLargestValue);
    if (const auto rotation = value.find("rotation_degrees")) {
        rotation->number_within(0, 180);
        noise.pose_rotation_rad = read_degrees(*rotation);
    }
}

}  // namespace

Recording read_recording(const sensor::JsonValue& value) {
    value.expect_keys({"shadows", "area_lights", "bounces", "samples", "noise", "pose_noise", "exr", "seed"});
    Recording recording;
    RenderSettings& render = recording.render;
    if (const auto shadows = value.find("shadows")) render.shadows = shadows->boolean();
    if (const auto area_lights = value.find("area_lights")) render.area_lights = area_lights->boolean();
    if (const auto bounces = value.find("bounces"))
        render.bounces = static_cast<uint32_t>(bounces->whole_number(kMostBounces));
    if (const auto samples = value.find("samples")) {
        samples->positive_integer();
        render.samples = static_cast<uint32_t>(samples->whole_number(kMostSamples));
    }
    if (const auto noise = value.find("noise")) recording.noise = read_noise(*noise);
    if (const auto pose_noise = value.find("pose_noise")) read_pose_noise(*pose_noise, recording.noise);
    if (const auto exr = value.find("exr")) recording.exr = exr->boolean();
    if (const auto seed = value.find("seed")) recording.seed = render.seed = seed->whole_number(UINT64_MAX);
    return recording;
}

}  // namespace patina::scenes
