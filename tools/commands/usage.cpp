#include "tools/commands/usage.h"

#include <algorithm>
#include <vector>

#include "engine/core/did_you_mean.h"
#include "engine/core/error.h"

namespace patina::tools {

namespace {

std::vector<std::string> subcommand_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

bool is_option(const std::string& word) { return word.size() > 1 && word.front() == '-'; }

/// The first option that is not known; empty where there is none.
std::string unknown_option(const CLI::App& command) {
    const std::vector<std::string> rest = command.remaining();
    const auto found = std::find_if(rest.begin(), rest.end(), is_option);
    return found == rest.end() ? "" : found->substr(0, found->find('='));
}

}  // namespace

std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    const CLI::App& command = chosen.empty() ? app : *chosen.front();
    // Its options are known once it is.
    if (const auto rest = app.remaining(); chosen.empty() && !rest.empty() && !is_option(rest.front())) {
        const std::vector<std::string> names = subcommand_names(app);
        return text("there is no subcommand '", rest.front(), "'", did_you_mean(rest.front(), names));
    }
    if (const std::string option = unknown_option(command); !option.empty()) {
        const std::string of = chosen.empty() ? "" : command.get_name() + " has ";
        return text(chosen.empty() ? "there is " : of, "no option '", option, "'",
                    did_you_mean(option, option_names(command)));
    }
    return error.what();
}

}  // namespace patina::tools
