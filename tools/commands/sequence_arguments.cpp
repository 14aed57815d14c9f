#include <memory>

#include "reconstruction/api/access.h"
#include "reconstruction/session/choices.h"
#include "reconstruction/setting_table.h"
#include "scenes/files/scene_file.h"
#include "sensor/open.h"
#include "tools/commands/commands.h"
#include "tools/commands/parse.h"

namespace patina::tools {

namespace {

ReflectanceStageSettings& reflectance_of(Settings& given) {
    ReconstructionSettings& settings = Access::values(given);
    return settings.reflectance ? *settings.reflectance : settings.reflectance.emplace();
}

void add_truth_option(CLI::App& command, const std::string& name, bool& wanted, const std::string& help) {
    command
        .add_option_function<std::string>(
            name, [&wanted](const std::string&) { wanted = true; }, help)
        ->check(one_of({"truth"}));
}

}  // namespace

void SequenceArguments::add_to(CLI::App& command, SequenceOptions& options) {
    command
        .add_option("sequence", options.sequence,
                    "Folder of a sequence, or synthetic:SCENE, rendered as it is used; SCENE is a JSON file or one "
                    "of: " +
                        scenes::scene_names())
        ->required();
    command.add_option("--format", options.format, sensor::format_names() + ", instead of recognising it");
    command
        .add_option("--frames", options.frames, "Use at most so many frames; without it all (of a synthetic scene 120)")
        ->check(at_least_one());
    command.add_option("--lights", lights,
                       "lights.json: estimate what surfaces reflect under these lights, not only where they are");
    command.add_option(
        "--lighting", lighting,
        "Where lights are found: a sequence of low exposure, or one that holds lighting/; self: in what they "
        "light; none: no reflectance; by default in the sequence's lighting/");
    add_white_option(command, options.white_albedo);
    command
        .add_option("--labels", options.labels,
                    "Segments: geometry finds them, truth takes those of truth/labels, off does without")
        ->transform(one_of<Labels>({{"off", Labels::kOff}, {"geometry", Labels::kGeometry}, {"truth", Labels::kTruth}}))
        ->option_text("off|geometry|truth")
        ->default_str("geometry");
    add_truth_option(command, "--materials", truth_materials,
                     "Specular materials by label: truth takes those of truth/materials.json");
    command
        .add_option("--specular", specular,
                    "Specular materials of segments: fit (Ward's model, to the observations), hemicnn (the network), "
                    "both (its estimates hold where observations do not tell) or off; by default both where there is "
                    "a network, else fit")
        ->check(one_of({"fit", "hemicnn", "both", "off"}));
    command.add_option("--network", options.network, "Weights of the network, instead of those that ship with patina");
    command.add_flag_callback(
        "--no-shadows", [&options] { reflectance_of(options.settings).refine.shadows = false; },
        "Every light reaches every surface, as in the paper");
    command
        .add_option_function<uint32_t>(
            "--observation-mm",
            [&options](uint32_t mm) { reflectance_of(options.settings).voxel_m = static_cast<float>(mm) / 1000; },
            "Size of the voxels of reflectance, 20 or 10")
        ->check(one_of({"10", "20"}));
    command
        .add_option("--detail", options.detail,
                    "How fine the surface is: voxels of 2.5 mm up to 3 m (fine), 5 mm up to 6 m (normal), 10 mm up to "
                    "12 m (coarse); by default as the first frames' depth suggests")
        ->transform(one_of<Detail>({{"auto", Detail::kAuto},
                                    {"fine", Detail::kFine},
                                    {"normal", Detail::kNormal},
                                    {"coarse", Detail::kCoarse}}))
        ->option_text("auto|fine|normal|coarse");
    command.add_option_function<uint64_t>(
        "--seed", [&options](const uint64_t& seed) { options.seed = seed; },
        "Another seed for everything that is drawn at random; of a synthetic scene also for noise and samples");
    command.add_flag("--quiet", options.quiet, "Print nothing but errors");
    command.add_option("--settings", settings_file, "TOML file with settings");
    command.add_option("--set", assignments, "One setting as KEY=VALUE, such as fusion.max_depth_m=3; may be repeated")
        ->take_all();
    device.add_to(command);
}

LightingChoice SequenceArguments::lighting_choice() const {
    if (!lights.empty()) return LightsFromFile{lights};
    if (lighting.empty()) return LightsBeside{};
    if (lighting == "none") return NoLights{};
    if (lighting == "self") return LightsFromMain{};
    return LightsFromSequence{lighting};
}

Materials SequenceArguments::materials_choice() const {
    if (truth_materials) return Materials::kTruth;
    for (const Materials choice : {Materials::kFit, Materials::kNetwork, Materials::kBoth, Materials::kOff})
        if (specular == name_of(choice)) return choice;
    return Materials::kAuto;
}

void SequenceArguments::finish(SequenceOptions& options) const {
    if (!settings_file.empty()) options.settings.load(settings_file);
    for (const std::string& assignment : assignments) Access::assign(options.settings, assignment, "--set");
    options.settings_file = settings_file;
    options.lighting = lighting_choice();
    options.materials = materials_choice();
    options.hints.lights = "--lights FILE, --lighting SEQUENCE, --lighting self";
    options.hints.network = "--network FILE";
    options.device = device.choice();
}

}  // namespace patina::tools
