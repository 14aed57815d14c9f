#include <cstdio>
#include <memory>
#include <optional>

#include "cameras/open_sequence.h"
#include "reconstruction/api/access.h"
#include "scenes/files/scene_file.h"
#include "scenes/files/scene_report.h"
#include "scenes/render/synthetic_source.h"
#include "sensor/inspect.h"
#include "sensor/open.h"
#include "sensor/prefetch.h"
#include "tools/commands/commands.h"
#include "tools/program/map_text.h"

namespace patina::tools {

void add_info(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("info",
                           "Print what a recorded sequence holds, and what about it is implausible; or what a map "
                           "holds that a run left");
    struct Arguments {
        std::string sequence, format;
    };
    const auto arguments = std::make_shared<Arguments>();
    command->add_option("sequence", arguments->sequence, "Folder of a sequence, synthetic:SCENE, or a map.sqlite")
        ->required();
    command->add_option("--format", arguments->format, sensor::format_names() + ", instead of recognising it");
    command->callback([arguments] {
        if (const auto map = map_at(arguments->sequence); !map.empty()) {
            std::fputs(describe_map(map).c_str(), stdout);
            return;
        }
        if (const auto scene = scenes::scene_name(arguments->sequence)) {
            const std::string report =
                scenes::format_scene_report(scenes::load_scene(*scene), scenes::SyntheticOptions{}.frames);
            std::fputs(report.c_str(), stdout);
            return;
        }
        std::optional<Device> device;  // for raw recordings alone
        const auto give_device = [&]() -> vulkan::Device& {
            return Access::vulkan(device ? *device : device.emplace());
        };
        sensor::PrefetchSource source(
            sensor::open_sequence(arguments->sequence, arguments->format, cameras::payload_decoders(give_device)));
        std::fputs(sensor::format_report(sensor::inspect(source)).c_str(), stdout);
    });
}

}  // namespace patina::tools
