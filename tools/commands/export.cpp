#include <memory>

#include "sensor/open.h"
#include "tools/commands/commands.h"
#include "tools/convert/export_native.h"

namespace patina::tools {

void add_export(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("export", "Write what a recording holds in another format");
    const auto native = std::make_shared<ExportNativeOptions>();
    command->add_option("source", native->sequence, "Recording, or folder of a sequence")->required();
    command->add_option("--native", native->out, "Folder to create: a sequence in Patina's own format")->required();
    command->add_option("--format", native->format, sensor::format_names() + ", instead of recognising it");
    command->add_flag("--quiet", native->quiet, "Print nothing but errors");
    command->callback([native, &exit_code] { exit_code = export_native(*native).exit_code(); });
}

}  // namespace patina::tools
