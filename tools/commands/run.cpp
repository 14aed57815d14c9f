#include "tools/run/run.h"

#include <memory>
#include <system_error>
#include <utility>

#include "engine/core/error.h"
#include "tools/commands/run_arguments.h"

namespace patina::tools {

namespace {

namespace fs = std::filesystem;

/// Throws CLI::RequiredError where something is missing that a run begins with.
void expect_complete(const CLI::App& command) {
    for (const char* option : {"sequence", "--out"})
        if (command.count(option) == 0) throw CLI::RequiredError(option);
}

/// Takes over what the run in the folder was started with; its results go there. Throws CLI::RequiredError where more
/// was given than that: such words are for a run whose sequence is given.
std::shared_ptr<RunArguments> resumed(const RunArguments& given) {
    for (size_t i = 0; i < given.run.arguments.size(); ++i) {
        const std::string& word = given.run.arguments[i];
        if (word == "--resume") ++i;  // its folder
        if (!word.starts_with("--resume") && word != "--quiet") throw CLI::RequiredError("sequence");
    }
    const fs::path folder = fs::absolute(*given.resume);
    auto arguments = kept_arguments(map_in(folder));
    arguments->resume = arguments->run.out = folder;
    arguments->run.quiet = given.run.quiet;
    return arguments;
}

int start(RunArguments& arguments) {
    RunOptions& run_options = arguments.run;
    arguments.sequence.finish(run_options);
    if (arguments.extends) run_options.extends = map_in(*arguments.extends);
    run_options.hints.track = "--poses track";
    run_options.resume = arguments.resume.has_value();
    run_options.hints.resume = "--resume " + run_options.out.string();
    name_map(arguments);
    if (!arguments.shows()) return run(run_options).exit_code();
    const auto window = show_run(arguments.viewer, run_options, nullptr, nullptr);
    return run(run_options, window.get()).exit_code();
}

}  // namespace

void add_run(CLI::App& app, int& exit_code, const std::vector<std::string>& words) {
    CLI::App* command = app.add_subcommand("run", "Reconstruct a sequence into a scene");
    const auto given = std::make_shared<RunArguments>();
    declare(*command, *given);
    command->callback([given, words, command, &exit_code] {
        given->run.arguments = words;
        for (const auto& [option, folder] : {std::pair("--resume", given->resume), {"--extend", given->extends}})
            if (folder && folder->empty()) throw Error(option, " is empty, but must name a run's folder");
        const bool alone = given->resume && command->count("sequence") == 0;
        if (!alone) expect_complete(*command);
        exit_code = start(alone ? *resumed(*given) : *given);
    });
}

}  // namespace patina::tools
