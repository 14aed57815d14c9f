#include <memory>

#include "reconstruction/setting_table.h"
#include "tools/commands/commands.h"
#include "tools/program/standard_streams.h"

namespace patina::tools {

namespace {

void print(const SettingDescriptor& setting) {
    print_out("{} = {}{}{}\n", setting.key, setting.default_value, setting.unit.empty() ? "" : " ", setting.unit);
    print_out("    {}{}{}\n", setting.sentence, setting.note.empty() ? "" : " ", setting.note);
    print_out("    It is {}.\n", allowed_values(setting));
}

}  // namespace

void add_settings(CLI::App& app) {
    CLI::App* command = app.add_subcommand("settings", "List all settings with their defaults and ranges");
    const auto markdown = std::make_shared<bool>(false);
    command->add_flag("--markdown", *markdown, "Print the page docs/settings.md");
    command->callback([markdown] {
        if (*markdown) {
            print_out("{}", settings_page());
            return;
        }
        for (const SettingDescriptor& setting : setting_descriptors()) print(setting);
    });
}

}  // namespace patina::tools
