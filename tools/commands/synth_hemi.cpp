#include "tools/synth/synth_hemi.h"

#include <memory>

#include "tools/commands/commands.h"
#include "tools/commands/parse.h"

namespace patina::tools {

void add_synth_hemi(CLI::App& app) {
    CLI::App* command = app.add_subcommand("synth-hemi", "Write labelled HemiImages to train a network with");
    struct Arguments {
        SynthHemiOptions synth;
        DeviceArguments device;
    };
    const auto arguments = std::make_shared<Arguments>();
    SynthHemiOptions& options = arguments->synth;
    command->add_option("--out", options.out, "File to create")->required();
    command->add_option("--seed", options.seed, "Of everything random; files of different seeds go together")
        ->capture_default_str();
    command->add_option("--examples", options.examples, "How many to write")
        ->capture_default_str()
        ->check(CLI::Range(1u, 1u << 24));
    command->add_option("--map", options.map, "How directions become points of an image: parabolic, orthogonal")
        ->transform(one_of<HemisphereMap>(
            {{"parabolic", HemisphereMap::kParabolic}, {"orthogonal", HemisphereMap::kOrthogonal}}))
        ->default_str("parabolic");
    command->add_flag("--quiet", options.quiet, "Print nothing but errors");
    arguments->device.add_to(*command);
    command->callback([arguments] {
        vulkan::Device device(arguments->device.options());
        synthesise_hemi_images(device, arguments->synth);
    });
}

}  // namespace patina::tools
