#include "tools/synth/synth.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "scenes/description/never_recorded.h"
#include "scenes/description/noise.h"
#include "tools/commands/commands.h"
#include "tools/commands/parse.h"

namespace patina::tools {
namespace {

PoseNoise parse_pose_noise(const std::string& text) {
    PoseNoise noise;
    if (!parse_pair(text, ',', noise.translation_m, noise.rotation_degrees) || !std::isfinite(noise.translation_m) ||
        !std::isfinite(noise.rotation_degrees) || noise.translation_m < 0 || noise.rotation_degrees < 0) {
        throw CLI::ValidationError("--pose-noise",
                                   patina::text("'", text, "' is not METRES,DEGREES from 0, such as 0.002,0.1"));
    }
    return noise;
}

/// Adds an option that keeps empty what was not given.
template <class Value>
void add_optional(CLI::App& command, const std::string& name, std::optional<Value>& value, const std::string& help) {
    command.add_option_function<Value>(
        name, [&value](const Value& given) { value = given; }, help);
}

void add_switch(CLI::App& command, const std::string& names, std::optional<bool>& value, const std::string& help) {
    command.add_flag_function(
        names, [&value](int64_t given) { value = given > 0; }, help);
}

void add_recording_options(CLI::App& command, SynthOptions& options) {
    add_optional(command, "--noise", options.noise, "Errors of depth and colour: " + scenes::noise_preset_names());
    command.add_option_function<std::string>(
        "--pose-noise", [&options](const std::string& text) { options.pose_noise = parse_pose_noise(text); },
        "Errors of the recorded poses, METRES,DEGREES: standard deviations per axis");
    add_switch(command, "--shadows,!--no-shadows", options.shadows, "Whether things keep light from others");
    add_switch(command, "--area-lights", options.area_lights, "Lamps with a radius shine from all their surface");
    add_optional(command, "--bounces", options.bounces, "How often light is reflected before it reaches what is seen");
    add_optional(command, "--samples", options.samples, "Random samples per pixel, where there is something to sample");
    add_optional(command, "--environment", options.environment,
                 "Light from afar: latitude-longitude picture, .hdr or .exr");
    add_switch(command, "--exr", options.exr, "Colour as linear OpenEXR without clipping, not as 8-bit sRGB");
    command.add_option_function<std::string>(
        "--extent", [&options](const std::string& text) { options.extent = parse_extent(text); },
        "Size of the depth pictures, WIDTHxHEIGHT; an unregistered colour camera scales likewise");
    command.add_flag_callback(
        "--no-lighting", [&options] { options.lighting = false; }, "Leave out the low-exposure sequence lighting/");
}

}  // namespace

void add_synth(CLI::App& app) {
    CLI::App* command = app.add_subcommand("synth", "Record a synthetic scene as a sequence with its truth");
    struct Arguments {
        SynthOptions synth;
        DeviceArguments device;
    };
    const auto arguments = std::make_shared<Arguments>();
    SynthOptions& options = arguments->synth;
    command->add_option("scene", options.scene, "JSON file of a scene, or one of: " + scenes::scene_names())
        ->required();
    command->add_option("--out", options.out, "Folder to create")->required();
    command->add_option("--frames", options.frames, "How many frames to record")
        ->check(at_least_one())
        ->capture_default_str();
    command->add_option("--truth-every", options.truth_every,
                        "Write truth/frames/NNNNNN.exr of every so many frames: materials, normals, depth, radiance");
    command
        ->add_option("--novel", options.novel,
                     "Write so many views off the path to truth/novel, and the same under other lamps to truth/relit")
        ->check(CLI::Range(scenes::kFewestNovelViews, 100000u));
    add_optional(*command, "--seed", options.changes.seed, "Seed of noise and random samples");
    add_optional(*command, "--vary", options.changes.vary, "Seed of other materials, lights and path of the same kind");
    command->add_option("--mesh", options.changes.mesh, "Mesh in place of those whose height the scene sets");
    command->add_flag("--quiet", options.quiet, "Print nothing but errors");
    add_recording_options(*command, options);
    arguments->device.add_to(*command);
    command->callback([arguments] {
        vulkan::Device device(arguments->device.options());
        synthesise(device, arguments->synth);
    });
}

}  // namespace patina::tools
