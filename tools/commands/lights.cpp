#include "tools/lights.h"

#include <memory>

#include "tools/commands/commands.h"
#include "tools/commands/parse.h"

namespace patina::tools {

void add_lights(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("lights", "Find the lamps of a room, seen at low exposure or in what they light");
    struct Arguments {
        LightsOptions lights;
        DeviceArguments device;
    };
    const auto arguments = std::make_shared<Arguments>();
    LightsOptions& options = arguments->lights;
    command
        ->add_option("sequence", options.sequence, "Folder of a sequence, of a lighting sequence, or synthetic:SCENE")
        ->required();
    command->add_option("--out", options.out, "File to write, such as lights.json");
    command
        ->add_option(
            "--from", options.from,
            "lighting: frames of low exposure, those of lighting/ if there is one; self: what the lamps light; "
            "by default lighting where there is one")
        ->transform(
            one_of<LightsFrom>({{"lighting", LightsFrom::kLightingSequence}, {"self", LightsFrom::kMainSequence}}))
        ->option_text("lighting|self");
    command->add_option("--frames", options.frames, "Use at most so many frames; without it all")
        ->check(at_least_one());
    command
        ->add_option("--threshold", options.settings.find.threshold,
                     "Luminance of a pixel value, 1 being full scale, from which a pixel shines")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--min-sightings", options.settings.min_sightings, "Leave out lamps seen in fewer frames")
        ->capture_default_str();
    command->add_flag("--quiet", options.quiet, "Print nothing but errors");
    arguments->device.add_to(*command);
    command->callback([arguments] {
        arguments->lights.device = arguments->device.options();
        const Illumination found = find_lights(arguments->lights);
        if (!arguments->lights.quiet) print_lights(found);
    });
}

}  // namespace patina::tools
