#include "tools/commands/run_arguments.h"

#include <system_error>

#include "engine/core/error.h"
#include "reconstruction/api/access.h"
#include "reconstruction/session/choices.h"
#include "reconstruction/store/map_file.h"
#include "tools/commands/parse.h"
#include "tools/commands/viewer_arguments.h"

namespace patina::tools {

namespace fs = std::filesystem;

namespace {

/// More segments than a frame of a room shows; the network's activations of so many take 77 MB.
constexpr uint32_t kPaperSegments = 128;

/// The value of --texture.
void set_texture(RunOptions& run, const std::string& text) {
    double texel_mm = 0;
    run.texture = text != "off";
    if (text == "off" || text == "auto") return;
    if (!parse(text, texel_mm) || !(texel_mm >= 0.1 && texel_mm <= 100))
        throw CLI::ValidationError(
            "--texture", patina::text("'", text, "' is neither auto nor off nor a size of 0.1 to 100 millimetres"));
    run.texel_m = texel_mm / 1000;
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
    command
        .add_option_function<std::string>(
            "--up", [&run](const std::string& text) { run.files.up = parse_up(text); },
            "The direction that is up in the recording's world, as 0,0,1: scene.glb stands upright by it; by default "
            "it is found")
        ->option_text("X,Y,Z");
    command
        .add_option("--gltf-fresnel", run.files.glb.fresnel,
                    "How highlights in scene.glb change with the angle: as those of glass do (ior), or not at all as "
                    "Ward's do (constant), for renderers that take specular colours above 1")
        ->transform(one_of<GltfFresnel>({{"ior", GltfFresnel::kIor}, {"constant", GltfFresnel::kConstant}}))
        ->option_text("ior|constant");
    command.add_flag(
        "--raw-attributes", run.files.glb.raw_attributes,
        "Write the exact kd, ks and alpha into scene.glb, too, as vertex attributes _KD, _KS, _WARD_ALPHA");
    command
        .add_option_function<std::string>(
            "--texture", [&run](const std::string& text) { set_texture(run, text); },
            "Texture of scene.glb: as fine as the pictures, from 0.5 to 2 mm a texel (auto); with texels of so many "
            "millimetres; or none, and colours at vertices in its place (off)")
        ->option_text("auto|off|MM");
    command.add_option(
        "--triangles", run.files.tidy.most_triangles,
        "Most triangles of scene.glb, about: by default 100000, or more where it would be off by more than 5 mm; "
        "0: as many as --surface-error leaves");
    command
        .add_option_function<double>(
            "--surface-error",
            [&run](double error_mm) {
                run.files.tidy.error_m = error_mm / 1000;
                if (error_mm == 0) run.files.tidy.least_part_m = 0;
            },
            "About how far scene.glb's surface may be from what was reconstructed, in millimetres: 1 by default; 0 "
            "keeps all triangles, those of stray parts too")
        ->option_text("MM")
        ->check(CLI::Range(0.0, 1000.0));
    command.add_option("--hold-out", run.hold_out,
                       "Keep every so many-th frame out of the model, and compare its colours in the end");
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

fs::path map_in(const fs::path& run_folder) { return run_folder / "map.sqlite"; }

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

}  // namespace patina::tools
