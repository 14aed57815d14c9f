#include "tools/live/live.h"

#include <memory>

#include "engine/core/error.h"
#include "tools/commands/commands.h"
#include "tools/commands/run_arguments.h"
#include "tools/program/cameras.h"

namespace patina::tools {

void add_live(CLI::App& app, int& exit_code) {
    CLI::App* command =
        app.add_subcommand("live", "Reconstruct what a camera sees while it sees it; Ctrl-C ends it with its scene");
    struct Arguments {
        RunArguments run;
        LiveOptions live;
    };
    const auto arguments = std::make_shared<Arguments>();
    LiveOptions& live_options = arguments->live;
    declare(*command, arguments->run);
    command->get_option("sequence")->description(text("Camera: ", kCameraNames));
    command->add_option("--simulate", live_options.simulate, "Recording that plays by its clock, as a camera would");
    command->add_option("--record", live_options.record,
                        "Record all frames into this file, those that are dropped too");
    command->add_option("--seconds", live_options.seconds, "End so many seconds after the first frame")
        ->check(CLI::PositiveNumber);
    command->callback([arguments, command, &exit_code] {
        if (command->count("--out") == 0) throw CLI::RequiredError("--out");
        if (command->count("sequence") > 0 && command->count("--simulate") > 0)
            throw CLI::ExcludesError("--simulate", "the name of a camera");
        for (const char* option : {"--resume", "--checkpoint-every"})
            if (command->count(option) > 0) throw Error(option, " is for recordings: a camera cannot be read again");
        RunArguments& run = arguments->run;
        run.sequence.finish(run.run);
        if (run.extends) run.run.extends = map_in(*run.extends);
        name_map(run);
        run.run.hints.track = "--poses track";
        run.run.hints.lights = "--lights FILE, --lighting SEQUENCE";
        arguments->live.source = run.run.sequence;
        arguments->live.run = run.run;
        if (run.shows()) {
            arguments->live.accompany = [&run](const RunOptions& options, RunCompanion& companion,
                                               LiveControls& controls) {
                return show_run(run.viewer, options, &companion, &controls);
            };
        }
        exit_code = live(arguments->live).exit_code();
    });
}

}  // namespace patina::tools
