#include "tools/commands/viewer_arguments.h"

#include "tools/commands/parse.h"

namespace patina::tools {

void declare_viewer(CLI::App& command, ViewerOptions& options, const char* extent) {
    std::vector<std::pair<std::string, Layer>> layers;
    for (const LayerText& text : kLayers) layers.emplace_back(text.word, text.layer);
    command.add_option("--offscreen", options.offscreen,
                       "Draw the window's frames to this file, without a display: a video (.mp4, .avi), or pictures "
                       "(.png), where #### in the name becomes the frame's number");
    command.add_option("--layer", options.layer, "What is shown at first")
        ->transform(one_of<Layer>(layers))
        ->option_text("color|rerendering|kd|ks|alpha|normals|segments|confidence|coverage");
    command
        .add_option_function<std::string>(
            extent, [&options](const std::string& text) { options.extent = parse_extent(text); },
            "Size of the window, or of the frames, WIDTHxHEIGHT; by default 1280x800")
        ->option_text("WIDTHxHEIGHT");
    command.add_flag_callback(
        "--no-panels", [&options] { options.panels = false; }, "Draw pictures alone, without the user interface");
}

}  // namespace patina::tools
