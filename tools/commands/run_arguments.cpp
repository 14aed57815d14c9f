#include "tools/commands/run_arguments.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "engine/core/error.h"
#include "reconstruction/api/access.h"
#include "reconstruction/session/choices.h"
#include "reconstruction/store/map_file.h"
#include "tools/commands/parse.h"
#include "tools/commands/scene_choices.h"
#include "tools/commands/viewer_arguments.h"

namespace patina::tools {

namespace fs = std::filesystem;

namespace {

/// More segments than a frame of a room shows; the network's activations of so many take 77 MB.
constexpr uint32_t kPaperSegments = 128;

/// What a first run does not need comes in a group of its own, below the others.
void fold_rare_options(CLI::App& command) {
    constexpr std::array<std::string_view, 12> kBasic{"--help",   "--out",      "--lights", "--lighting",
                                                      "--poses",  "--frames",   "--up",     "--texture",
                                                      "--detail", "--hold-out", "--quiet",  "--resume"};
    for (CLI::Option* option : command.get_options()) {
        const bool basic = std::ranges::find(kBasic, option->get_name()) != kBasic.end();
        if (!basic && !option->get_positional()) option->group("More options");
    }
}

}  // namespace

void declare(CLI::App& command, RunArguments& arguments) {
    RunOptions& run = arguments.run;
    arguments.sequence.add_to(command, run);
    command.get_option("sequence")->required(false);  // a run that goes on has its own
    command.add_option("--out", run.out, "Folder for the results");
    CLI::Option* window =
        command.add_flag("--window", arguments.window, "Show the scene in a window while it is reconstructed");
    declare_viewer(command, arguments.viewer, "--window-extent");
    command.get_option("--offscreen")->excludes(window);
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
    command
        .add_flag_callback(
            "--paper",
            [&arguments] {
                ReconstructionSettings& settings = Access::values(arguments.run.settings);
                if (!settings.reflectance) settings.reflectance.emplace();
                if (!settings.specular) settings.specular.emplace();
                settings.reflectance->detail = false;
                settings.specular->segments_per_frame = kPaperSegments;
                arguments.sequence.specular = name_of(Materials::kNetwork);
            },
            "As the paper has it: HemiCNN alone, of every segment in every frame, and no detail restored")
        ->excludes("--specular");
    command.add_flag("--tiles", run.tiles,
                     "Write tiles/ too: the scene in cells of 8 m and levels of detail, as 3D Tiles");
    declare_scene_choices(command, run);
    command.add_option("--hold-out", run.hold_out,
                       "Keep every so many-th frame out of the model, and compare its colours in the end");
    command.add_option("--dump-graph", run.dump_graph, "Write PATH.dot and PATH.json of the last frame's last graph");
    command.add_flag("--no-map", arguments.no_map,
                     "Do not keep OUT/map.sqlite, which view, export and --extend begin from");
    command
        .add_option("--checkpoint-every", run.checkpoint_every,
                    "Keep OUT/map.sqlite not only at the end but every so many frames, to go on from after whatever "
                    "stopped the run")
        ->check(at_least_one())
        ->excludes("--no-map");
    command
        .add_option("--extend", arguments.extends,
                    "Begin from the map that another run left in this folder: its model, its world, its lights")
        ->excludes("--lights")
        ->excludes("--lighting");
    command
        .add_option("--resume", arguments.resume,
                    "Go on from the map in this folder; alone: with the arguments that the run was started with")
        ->excludes("--no-map");
    fold_rare_options(command);
}

fs::path map_in(const fs::path& run_folder) { return run_folder / "map.sqlite"; }

void name_map(RunArguments& arguments) {
    if (arguments.no_map) return;
    RunOptions& run = arguments.run;
    run.map = map_in(arguments.resume.value_or(run.out));
    if (run.checkpoint_every == 0) run.checkpoint_every = SessionOptions::kAtEnd;
    std::error_code failure;
    run.started_in = fs::current_path(failure);
    if (failure && run.checkpoint_every != SessionOptions::kAtEnd)
        throw Error("the folder that this program was started in is gone: ", failure.message());
}

std::shared_ptr<RunArguments> kept_arguments(const fs::path& file) {
    const auto map = MapFile::with_state(file);
    std::vector<std::string> words;
    for (const auto& word : map->expect_json("arguments")) words.push_back(word.get<std::string>());
    if (words.empty())
        throw Error("'", file.string(), "' is of 'patina live': what its camera saw cannot be read again");
    const fs::path started_in = map->expect_text("started_in");
    std::error_code failure;
    fs::current_path(started_in, failure);
    if (failure)
        throw Error("the run of '", file.string(), "' was started in '", started_in.string(),
                    "', which cannot be entered: ", failure.message(), "; give its sequence and options again");
    auto arguments = std::make_shared<RunArguments>();
    CLI::App command;
    declare(command, *arguments);
    command.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // the last comes first
    arguments->run.arguments = words;
    return arguments;
}

}  // namespace patina::tools
