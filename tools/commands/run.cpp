#include "tools/run.h"

#include <map>
#include <memory>

#include "sensor/synthetic/scene_file.h"
#include "tools/commands/commands.h"
#include "tools/run_settings.h"

namespace patina::tools {

namespace {

ReflectanceModelSettings& reflectance_of(ReconstructionSettings& settings) {
    return settings.reflectance ? *settings.reflectance : settings.reflectance.emplace();
}

void add_truth_option(CLI::App& command, const std::string& name, bool& wanted, const std::string& help) {
    command
        .add_option_function<std::string>(
            name, [&wanted](const std::string&) { wanted = true; }, help)
        ->check(CLI::IsMember({"truth"}));
}

}  // namespace

void add_run(CLI::App& app) {
    CLI::App* command = app.add_subcommand("run", "Reconstruct a sequence into a scene");
    struct Arguments {
        RunOptions run;
        DeviceArguments device;
        std::string settings_file;
        std::vector<std::string> assignments;
    };
    const auto arguments = std::make_shared<Arguments>();
    RunOptions& run_options = arguments->run;
    command
        ->add_option("sequence", run_options.sequence,
                     "Folder of a sequence, or synthetic:SCENE, rendered as it is used; SCENE is a JSON file or one "
                     "of: " +
                         sensor::scene_names())
        ->required();
    command->add_option("--out", run_options.out, "Folder for the results")->required();
    command->add_option("--format", run_options.format, "patina-sequence, 7-scenes or tum, instead of recognising it");
    command->add_option("--frames", run_options.frames,
                        "Use at most so many frames (synthetic scenes: 120 by default)");
    command->add_option("--dump-every", run_options.dump_every, "Write frames/NNNNNN.exr of every so many frames");
    command->add_option("--lights", run_options.lights,
                        "lights.json: estimate what surfaces reflect under these lights, not only where they are");
    command->add_option("--lighting", run_options.lighting,
                        "Sequence of low exposure, or one that holds lighting/, in which the lights are found");
    add_truth_option(*command, "--labels", run_options.truth_labels, "Segments: truth takes those of truth/labels");
    add_truth_option(*command, "--materials", run_options.truth_materials,
                     "Specular materials by label: truth takes those of truth/materials.json");
    command->add_flag_callback(
        "--no-shadows", [&run_options] { reflectance_of(run_options.settings).refine.shadows = false; },
        "Every light reaches every surface, as in the paper");
    command
        ->add_option_function<uint32_t>(
            "--observation-mm",
            [&run_options](uint32_t mm) {
                reflectance_of(run_options.settings).voxel_m = static_cast<float>(mm) / 1000;
            },
            "Size of the voxels of reflectance, 20 or 10")
        ->check(CLI::IsMember({10, 20}));
    command
        ->add_option("--gains", run_options.gains,
                     "Bring each frame's colours to the exposure and white balance of the first: auto (where the "
                     "recording does not tell the exposure), on, off")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, GainMode>{{"auto", GainMode::kAuto}, {"on", GainMode::kOn}, {"off", GainMode::kOff}}))
        ->option_text("auto|on|off");
    command->add_option("--hold-out", run_options.hold_out,
                        "Keep the colours of every so many-th frame out of the model, and compare them in the end");
    command->add_option("--seed", run_options.seed, "Seed of everything that is drawn at random")
        ->capture_default_str();
    command->add_flag("--quiet", run_options.quiet, "Print nothing but errors");
    command->add_option("--dump-graph", run_options.dump_graph, "Write PATH.dot and PATH.json of the last fused frame");
    command->add_option("--settings", arguments->settings_file, "TOML file with settings");
    command
        ->add_option("--set", arguments->assignments,
                     "One setting as KEY=VALUE, such as fusion.max_depth_m=3; may be repeated")
        ->take_all();
    arguments->device.add_to(*command);
    command->callback([arguments] {
        if (!arguments->settings_file.empty()) load_settings(arguments->run.settings, arguments->settings_file);
        for (const std::string& assignment : arguments->assignments) apply_setting(arguments->run.settings, assignment);
        arguments->run.device = arguments->device.options();
        run(arguments->run);
    });
}

}  // namespace patina::tools
