#include "tools/render/render.h"

#include <memory>

#include "tools/commands/commands.h"
#include "tools/commands/parse.h"

namespace patina::tools {

void add_render(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("render", "Reconstruct a sequence and render views of the model");
    struct Arguments {
        RenderOptions render;
        SequenceArguments sequence;
    };
    const auto arguments = std::make_shared<Arguments>();
    RenderOptions& options = arguments->render;
    arguments->sequence.add_to(*command, options);
    command->add_option("--out", options.out, "Folder to create, for the views as NNNNNN.png");
    command->add_option("--video", options.video, "Video to write: .avi or .mp4");
    CLI::Option* orbit =
        command->add_option("--orbit", options.orbit, "So many views once around the model, not the recorded ones")
            ->check(CLI::Range(1u, 100000u));
    command->add_option("--orbit-seconds", options.orbit_seconds, "How long the video of the orbit is")
        ->check(CLI::PositiveNumber)
        ->needs(orbit);
    command->add_option("--poses", options.poses, "trajectory.txt of other views, of the depth camera as in a sequence")
        ->excludes(orbit);
    command->add_option_function<std::string>(
        "--extent", [&options](const std::string& text) { options.extent = parse_extent(text); },
        "Size of the pictures, WIDTHxHEIGHT; the vertical field of view stays");
    CLI::Option* relight =
        command->add_option("--relight", options.relight,
                            "lights.json, or an environment map (.hdr, .exr), to show the model under, instead of its "
                            "own light; twice: both");
    relight->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command
        ->add_option("--relight-turn", options.relight_turn_deg,
                     "Turns the environment about up, degrees, anticlockwise seen from above")
        ->check(CLI::Range(-360.0, 360.0))
        ->needs(relight);
    command->add_option("--show", options.show, "rgb (re-rendering), kd (diffuse albedo), normals or labels")
        ->transform(one_of<Show>(
            {{"rgb", Show::kRgb}, {"kd", Show::kKd}, {"normals", Show::kNormals}, {"labels", Show::kLabels}}))
        ->option_text("rgb|kd|normals|labels");
    command->add_option("--exposure", options.exposure, "What radiance is multiplied with before it is clipped at 1")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->callback([arguments, &exit_code] {
        RenderOptions& render_options = arguments->render;
        arguments->sequence.finish(render_options);
        if (render_options.show == Show::kKd) render_options.reflectance_for = "--show kd";
        if (!render_options.relight.empty()) render_options.reflectance_for = "--relight";
        exit_code = render(render_options).exit_code();
    });
}

}  // namespace patina::tools
