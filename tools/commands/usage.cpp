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

/// The innermost subcommand that was named; the program itself where none was.
const CLI::App& innermost(const CLI::App& app) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    return chosen.empty() ? app : innermost(*chosen.front());
}

/// The options of a subcommand, and of those that it leaves options to.
std::vector<std::string> known_options(const CLI::App& command) {
    std::vector<std::string> names = option_names(command);
    if (!command.get_fallthrough()) return names;
    const std::vector<std::string> above = known_options(*command.get_parent());
    names.insert(names.end(), above.begin(), above.end());
    return names;
}

bool is_option(const std::string& word) { return word.size() > 1 && word.front() == '-'; }

/// The first option that is not known; empty where there is none.
std::string unknown_option(const CLI::App& command) {
    const std::vector<std::string> rest = command.remaining();
    const auto found = std::find_if(rest.begin(), rest.end(), is_option);
    if (found != rest.end()) return found->substr(0, found->find('='));
    return command.get_fallthrough() ? unknown_option(*command.get_parent()) : "";
}

}  // namespace

std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App& command = innermost(app);
    const bool chosen = &command != &app;
    const std::vector<std::string> rest = command.remaining(), names = subcommand_names(command);
    // Its options are known once it is.
    if (!names.empty() && !rest.empty() && !is_option(rest.front())) {
        return text("there is no subcommand '", rest.front(), "'", chosen ? " of " + command.get_name() : "",
                    did_you_mean(rest.front(), names));
    }
    if (const std::string option = unknown_option(command); !option.empty()) {
        return text(chosen ? command.get_name() + " has " : "there is ", "no option '", option, "'",
                    did_you_mean(option, known_options(command)));
    }
    return error.what();
}

}  // namespace patina::tools
