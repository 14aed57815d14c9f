#pragma once

#include <CLI/CLI.hpp>

#include "tools/run/run.h"

namespace patina::tools {

/// Adds the options that say how scene.glb is written: --up, --gltf-fresnel, --raw-attributes, --texture, --triangles,
/// --close-holes, --surface-error. `run` must live until the command line is parsed.
void declare_scene_choices(CLI::App& command, RunOptions& run);

/// Takes over those of them that were given on this command line.
void take_scene_choices(const CLI::App& command, const RunOptions& given, RunOptions& run);

}  // namespace patina::tools
