#include "tools/commands/scene_choices.h"

#include <string>

#include "tools/commands/parse.h"

namespace patina::tools {

namespace {

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

void declare_scene_choices(CLI::App& command, RunOptions& run) {
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
    command.add_flag("--raw-attributes", run.files.glb.raw_attributes,
                     "Write the exact kd, ks and alpha into scene.glb, too, as vertex attributes _KD, _KS, "
                     "_WARD_ALPHA; and _FILLED, "
                     "1 where a hole was closed");
    command
        .add_option_function<std::string>(
            "--texture", [&run](const std::string& text) { set_texture(run, text); },
            "Texture of scene.glb: as fine as the pictures, from 0.5 to 2 mm a texel (auto); with texels of so many "
            "millimetres; or none, and colours at vertices in its place (off)")
        ->option_text("auto|off|MM");
    command.add_option(
        "--triangles", run.files.tidy.most_triangles,
        "Most triangles of scene.glb, about: by default 100000, or more where it would be off by more than 1 cm; "
        "0: as many as --surface-error leaves");
    command
        .add_option_function<double>(
            "--close-holes", [&run](double most_mm) { run.files.tidy.most_hole_m = most_mm / 1000; },
            "Close holes of scene.glb's surface that are no larger than this, in millimetres: 50 by default; 0 closes "
            "none")
        ->option_text("MM")
        ->check(CLI::Range(0.0, 1000.0));
    command
        .add_option_function<double>(
            "--surface-error",
            [&run](double error_mm) {
                run.files.tidy.error_m = error_mm / 1000;
                if (error_mm > 0) return;
                run.files.tidy.least_part_m = 0;
                run.files.tidy.least_patch_vertices = 0;
            },
            "About how far scene.glb's surface may be from what was reconstructed, in millimetres: 1 by default; 0 "
            "keeps all triangles, those of stray parts too, and specks of segments")
        ->option_text("MM")
        ->check(CLI::Range(0.0, 1000.0));
}

void take_scene_choices(const CLI::App& command, const RunOptions& given, RunOptions& run) {
    if (command.count("--up") > 0) run.files.up = given.files.up;
    if (command.count("--gltf-fresnel") > 0) run.files.glb.fresnel = given.files.glb.fresnel;
    if (command.count("--raw-attributes") > 0) run.files.glb.raw_attributes = given.files.glb.raw_attributes;
    if (command.count("--texture") > 0) {
        run.texture = given.texture;
        run.texel_m = given.texel_m;
    }
    if (command.count("--triangles") > 0) run.files.tidy.most_triangles = given.files.tidy.most_triangles;
    if (command.count("--close-holes") > 0) run.files.tidy.most_hole_m = given.files.tidy.most_hole_m;
    if (command.count("--surface-error") > 0) {
        run.files.tidy.error_m = given.files.tidy.error_m;
        run.files.tidy.least_part_m = given.files.tidy.least_part_m;
        run.files.tidy.least_patch_vertices = given.files.tidy.least_patch_vertices;
    }
}

}  // namespace patina::tools
