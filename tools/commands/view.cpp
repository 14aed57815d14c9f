#include <memory>

#include "tools/commands/commands.h"
#include "tools/commands/parse.h"
#include "tools/commands/viewer_arguments.h"

namespace patina::tools {

void add_view(CLI::App& app) {
    CLI::App* command = app.add_subcommand("view", "Show the map that a run left, in a window");
    struct Arguments {
        ViewOptions view;
        DeviceArguments device;
    };
    const auto arguments = std::make_shared<Arguments>();
    ViewOptions& options = arguments->view;
    command->add_option("map", options.input, "A run's folder, or its map.sqlite")->required();
    declare_viewer(*command, options.viewer, "--extent");
    command->add_option("--orbit", options.orbit, "Off screen: so many frames once around the model")
        ->check(CLI::Range(1u, 100000u))
        ->needs(command->get_option("--offscreen"));
    command->add_flag("--quiet", options.quiet, "Print nothing but errors");
    arguments->device.add_to(*command);
    command->callback([arguments] {
        arguments->view.device = arguments->device.choice();
        view(arguments->view);
    });
}

}  // namespace patina::tools
