#include "tools/synth.h"

#include <memory>

#include <fmt/format.h>

#include "tools/commands/commands.h"

namespace patina::tools {

void add_synth(CLI::App& app) {
    CLI::App* command = app.add_subcommand("synth", "Record a built-in scene as a sequence with its truth");
    struct Arguments {
        std::string scene, out;
        uint32_t frames = 120;
        DeviceArguments device;
    };
    const auto arguments = std::make_shared<Arguments>();
    command->add_option("scene", arguments->scene, "Name of the scene: cubes")->required();
    command->add_option("--frames", arguments->frames, "How many frames to record")->capture_default_str();
    command->add_option("--out", arguments->out, "Folder to create")->required();
    arguments->device.add_to(*command);
    command->callback([arguments] {
        vulkan::Device device(arguments->device.options());
        synthesise(device, arguments->scene, arguments->frames, arguments->out);
        fmt::print("{} frames of {} in {}\n", arguments->frames, arguments->scene, arguments->out);
    });
}

}  // namespace patina::tools
