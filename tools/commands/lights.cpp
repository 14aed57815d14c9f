#include <filesystem>
#include <memory>

#include "reconstruction/session/find_lights.h"
#include "scenes/files/scene_file.h"
#include "sensor/open.h"
#include "sensor/output/output_file.h"
#include "tools/commands/commands.h"
#include "tools/commands/parse.h"
#include "tools/program/console.h"
#include "tools/program/inputs.h"
#include "tools/program/lights_text.h"

namespace patina::tools {

namespace {

/// A wrong path is an error before a device is opened.
void expect_sequence(const LightsOptions& options) {
    if (!scenes::scene_name(options.sequence)) sensor::expect_sequence_path(options.sequence);
}

}  // namespace

void add_lights(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("lights", "Find the lamps of a room, seen at low exposure or in what they light");
    struct Arguments {
        LightsOptions lights;
        DeviceArguments device;
        std::filesystem::path out;
        bool quiet = false;
    };
    const auto arguments = std::make_shared<Arguments>();
    LightsOptions& options = arguments->lights;
    command
        ->add_option("sequence", options.sequence, "Folder of a sequence, of a lighting sequence, or synthetic:SCENE")
        ->required();
    command->add_option("--out", arguments->out, "File to write, such as lights.json");
    command
        ->add_option(
            "--from", options.from,
            "lighting: frames of low exposure, those of lighting/ if there is one; self: what the lamps light; "
            "by default lighting where there is one")
        ->transform(
            one_of<LightsFrom>({{"lighting", LightsFrom::kLightingSequence}, {"self", LightsFrom::kMainSequence}}))
        ->option_text("lighting|self");
    add_white_option(*command, options.fitting.white_albedo);
    command->add_option("--frames", options.frames, "Use at most so many frames; without it all")
        ->check(at_least_one());
    command
        ->add_option("--threshold", options.settings.find.threshold,
                     "Luminance of a pixel value, 1 being full scale, from which a pixel shines")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--min-sightings", options.settings.min_sightings, "Leave out lamps seen in fewer frames")
        ->capture_default_str();
    command->add_flag("--quiet", arguments->quiet, "Print nothing but errors");
    arguments->device.add_to(*command);
    command->callback([arguments] {
        Console console(arguments->quiet);
        arguments->lights.callbacks = console.callbacks();
        std::optional<sensor::OutputFile> out;
        if (!arguments->out.empty()) out.emplace(arguments->out, sequence_inputs(arguments->lights.sequence));
        expect_sequence(arguments->lights);
        vulkan::Device device(arguments->device.options());
        const Illumination found = find_lights(device, arguments->lights);
        console.end();
        if (out) {
            write_lighting(out->partial_path(), lighting_of(found));
            out->finish();
        }
        if (!arguments->quiet) print_lights(found);
    });
}

}  // namespace patina::tools
