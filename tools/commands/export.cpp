#include <algorithm>
#include <memory>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "reconstruction/store/map_file.h"
#include "sensor/open.h"
#include "sensor/output/partial_folder.h"
#include "tools/commands/commands.h"
#include "tools/commands/run_arguments.h"
#include "tools/commands/scene_choices.h"
#include "tools/convert/export_native.h"
#include "tools/convert/export_scene.h"
#include "tools/program/map_text.h"

namespace patina::tools {

namespace {

namespace fs = std::filesystem;

/// What `patina export` takes.
struct Arguments {
    std::string source;
    std::vector<std::string> files;
    std::string html, points, native, format;
    std::vector<double> from_m;
    RunOptions choices;  ///< how the scene is written
    bool lods = false;
    bool quiet = false;
};

std::vector<SceneOutput> outputs_of(const Arguments& arguments) {
    std::vector<SceneOutput> outputs;
    for (const std::string& file : arguments.files) outputs.push_back({format_by_ending(file), fs::absolute(file)});
    if (!arguments.html.empty()) outputs.push_back({SceneFormat::kHtml, fs::absolute(arguments.html)});
    if (!arguments.points.empty()) outputs.push_back({SceneFormat::kPoints, fs::absolute(arguments.points)});
    return outputs;
}

/// What a finished scene cannot be given, as it has no more than it shows.
std::string needs_map(const CLI::App& command, const Arguments& arguments, const fs::path& source) {
    for (const char* option : {"--gltf-fresnel", "--raw-attributes", "--surface-error", "--close-holes"})
        if (command.count(option) > 0) return option;
    if (command.count("--texture") > 0 && arguments.choices.texture) return "--texture";
    const std::optional<uint64_t> triangles = arguments.choices.files.tidy.most_triangles;
    if (!triangles || (*triangles > 0 && *triangles <= triangles_in(scene_at(source)))) return "";
    return text("--triangles ", *triangles);
}

/// Writes the scene of a map to a folder, as the run that left it would with other choices. The session goes on from
/// its end, so that nothing is computed again but the scene.
ExitCode write_scene_of_map(const CLI::App& command, const Arguments& given, const fs::path& map,
                            const fs::path& folder) {
    if (!MapFile::with_state(map)->expect_json("progress").value("ended", false))
        throw Error("the run of '", map.string(),
                    "' has not come to its end; go on with it first: patina run --resume ", map.parent_path().string());
    const auto arguments = kept_arguments(map);
    RunOptions& run_options = arguments->run;
    arguments->sequence.finish(run_options);
    if (arguments->extends) run_options.extends = map_in(*arguments->extends);
    take_scene_choices(command, given.choices, run_options);
    run_options.resume = true;
    run_options.map = map;
    run_options.checkpoint_every = 0;
    run_options.out = folder;
    run_options.quiet = true;
    return run(run_options).exit_code();
}

int export_scene_of(const CLI::App& command, const Arguments& arguments) {
    ExportSceneOptions options;
    options.source = fs::absolute(arguments.source);
    options.outputs = outputs_of(arguments);
    options.quiet = arguments.quiet;
    options.lods = arguments.lods;
    const auto is_glb = [](const SceneOutput& output) { return output.format == SceneFormat::kGlb; };
    if (options.lods && std::ranges::none_of(options.outputs, is_glb))
        throw CLI::RequiredError("--lods: a .glb to write");
    if (!arguments.from_m.empty())
        options.from_m = glm::dvec3(arguments.from_m[0], arguments.from_m[1], arguments.from_m[2]);
    const fs::path map = map_at(options.source);
    const bool is_map = !map.empty() && !is_folder(options.source);
    const std::string needs = is_map ? "the scene" : needs_map(command, arguments, options.source);
    if (!map.empty() && !needs.empty()) {
        const sensor::PartialFolder partial(options.outputs.front().file.string() + ".map");
        options.source = partial.path() / "run";
        const ExitCode of_run = write_scene_of_map(command, arguments, fs::absolute(map), options.source);
        const ExitCode of_export = export_scene(options).exit_code();
        return of_run == kExitDone ? of_export : of_run;
    }
    if (!needs.empty())
        throw Error(needs, " needs the map of the run, and '", arguments.source,
                    "' has none: give a map.sqlite, which patina run leaves");
    options.changes = {arguments.choices.files.tidy.most_triangles,
                       command.count("--texture") > 0 && !arguments.choices.texture, arguments.choices.files.up};
    return export_scene(options).exit_code();
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
    CLI::App* command =
        app.add_subcommand("export", "Write a finished scene, or what a recording holds, in another format");
    const auto arguments = std::make_shared<Arguments>();
    command->add_option("source", arguments->source, "A run's folder, its scene.glb, its map.sqlite; or a recording")
        ->required();
    CLI::Option* files = command->add_option(
        "files", arguments->files,
        "Files to write, by their endings: .glb, .ply, .obj, .usdz, .html (a viewer), .exr (the lights, lat-long)");
    CLI::Option* html = command->add_option("--html", arguments->html, "A viewer in one HTML file of at most 8 MB");
    CLI::Option* points = command->add_option("--points", arguments->points, "The vertices alone, as PLY");
    command->add_option("--from", arguments->from_m, "Where the lights of an .exr are seen from, metres; y is up")
        ->expected(3)
        ->delimiter(',')
        ->option_text("X,Y,Z");
    declare_scene_choices(*command, arguments->choices);
    command->add_flag(
        "--lods", arguments->lods,
        "Also write levels of detail beside each .glb: NAME_lod1.glb and NAME_lod2.glb, with down to a quarter and "
        "a sixteenth of its triangles");
    CLI::Option* native =
        command->add_option("--native", arguments->native, "Folder to create: a recording in Patina's own format");
    for (CLI::Option* each : {files, html, points}) native->excludes(each);
    command->add_option("--format", arguments->format, sensor::format_names() + ", instead of recognising it")
        ->needs(native);
    command->add_flag("--quiet", arguments->quiet, "Print nothing but errors");
    command->callback([arguments, command, &exit_code] {
        if (!arguments->native.empty()) {
            exit_code =
                export_native({arguments->source, arguments->format, arguments->native, arguments->quiet}).exit_code();
        } else if (arguments->files.empty() && arguments->html.empty() && arguments->points.empty()) {
            throw CLI::RequiredError("a file to write, --html, --points or --native");
        } else {
            exit_code = export_scene_of(*command, *arguments);
        }
    });
}

}  // namespace patina::tools
