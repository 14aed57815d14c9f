#include "tools/run/run.h"

#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "engine/core/error.h"
#include "reconstruction/store/map_file.h"
#include "tools/commands/commands.h"
#include "tools/commands/parse.h"

namespace patina::tools {

namespace {

namespace fs = std::filesystem;

struct RunArguments {
    RunOptions run;
    SequenceArguments sequence;
    std::optional<fs::path> extends;  ///< the folder whose map the run begins from
    std::optional<fs::path> resume;   ///< the folder whose map the run goes on from; none: it begins
};

/// Both must live until the command line is parsed.
void declare(CLI::App& command, RunArguments& arguments) {
    RunOptions& run = arguments.run;
    arguments.sequence.add_to(command, run);
    command.get_option("sequence")->required(false);  // expect_complete()
    command.add_option("--out", run.out, "Folder for the results");
    command.add_option("--dump-every", run.dump_every, "Write frames/NNNNNN.exr of every so many frames");
    command
        .add_option("--gains", run.gains,
                    "Bring each frame's colours to the exposure and white balance of the first: auto (where the "
                    "recording does not tell the exposure), on, off")
        ->transform(one_of<Gains>({{"auto", Gains::kAuto}, {"on", Gains::kOn}, {"off", Gains::kOff}}))
        ->option_text("auto|on|off");
    command
        .add_option("--poses", run.poses,
                    "The camera's poses: given by the sequence, tracked, or tracked from the given motion on (prior); "
                    "by default given where there are any")
        ->transform(one_of<Poses>({{"given", Poses::kGiven}, {"track", Poses::kTrack}, {"prior", Poses::kPrior}}))
        ->option_text("given|track|prior");
    command.add_flag("--tiles", run.tiles,
                     "Write tiles/ too: the scene in cells of 8 m and levels of detail, as 3D Tiles");
    command.add_option("--hold-out", run.hold_out,
                       "Keep the colours of every so many-th frame out of the model, and compare them in the end");
    command.add_option("--dump-graph", run.dump_graph, "Write PATH.dot and PATH.json of the last frame's last graph");
    command
        .add_option("--checkpoint-every", run.checkpoint_every,
                    "Keep the state of the run in OUT/map.sqlite every so many frames, to go on from after whatever "
                    "stopped it")
        ->check(at_least_one());
    command
        .add_option("--extend", arguments.extends,
                    "Begin from the map that another run left in this folder: its model, its world, its lights")
        ->excludes("--lights")
        ->excludes("--lighting");
    command.add_option("--resume", arguments.resume,
                       "Go on from the map in this folder; alone: with the arguments that the run was started with");
}

/// Throws CLI::RequiredError where something is missing that a run begins with.
void expect_complete(const CLI::App& command) {
    for (const char* option : {"sequence", "--out"})
        if (command.count(option) == 0) throw CLI::RequiredError(option);
}

fs::path map_in(const fs::path& folder) { return folder / "map.sqlite"; }

/// The arguments of the run that a map is of, as if they were given now, where it was started.
std::shared_ptr<RunArguments> kept_arguments(const fs::path& folder) {
    const auto map = MapFile::with_state(map_in(folder));
    std::vector<std::string> words;
    for (const auto& word : map->expect_json("arguments")) words.push_back(word.get<std::string>());
    const fs::path started_in = map->expect_text("started_in");
    std::error_code failure;
    fs::current_path(started_in, failure);
    if (failure)
        throw Error("the run in '", folder.string(), "' was started in '", started_in.string(),
                    "', which cannot be entered: ", failure.message(), "; give its sequence and options again");
    auto arguments = std::make_shared<RunArguments>();
    CLI::App command;
    declare(command, *arguments);
    command.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // the last comes first
    arguments->run.arguments = words;
    return arguments;
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
    auto arguments = kept_arguments(folder);
    arguments->resume = arguments->run.out = folder;
    arguments->run.quiet = given.run.quiet;
    return arguments;
}

fs::path working_folder() {
    std::error_code failure;
    const fs::path folder = fs::current_path(failure);
    if (failure) throw Error("the folder that this program was started in is gone: ", failure.message());
    return folder;
}

int start(RunArguments& arguments) {
    RunOptions& run_options = arguments.run;
    arguments.sequence.finish(run_options);
    if (arguments.extends) run_options.extends = map_in(*arguments.extends);
    run_options.hints.track = "--poses track";
    run_options.resume = arguments.resume.has_value();
    run_options.hints.resume = "--resume " + run_options.out.string();
    if (run_options.resume || run_options.checkpoint_every > 0) {
        run_options.map = map_in(arguments.resume.value_or(run_options.out));
        run_options.started_in = working_folder();
    }
    return run(run_options).exit_code();
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
