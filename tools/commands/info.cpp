#include <cstdio>
#include <memory>

#include "sensor/inspect.h"
#include "sensor/open.h"
#include "sensor/prefetch.h"
#include "tools/commands/commands.h"

namespace patina::tools {

void add_info(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("info", "Print what a recorded sequence holds, and what about it is implausible");
    struct Arguments {
        std::string sequence, format;
    };
    const auto arguments = std::make_shared<Arguments>();
    command->add_option("sequence", arguments->sequence, "Folder of a sequence")->required();
    command->add_option("--format", arguments->format, "patina-sequence, 7-scenes or tum, instead of recognising it");
    command->callback([arguments] {
        sensor::PrefetchSource source(sensor::open_sequence(arguments->sequence, arguments->format));
        std::fputs(sensor::format_report(sensor::inspect(source)).c_str(), stdout);
    });
}

}  // namespace patina::tools
