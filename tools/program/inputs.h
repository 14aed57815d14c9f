#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/program/sequence_options.h"

namespace patina::tools {

/// What is read where a command is given this sequence: its folder, with the main sequence's where it is the lighting/
/// of one; of "synthetic:SCENE" the scene's file where SCENE is one.
std::vector<std::filesystem::path> sequence_inputs(const std::string& sequence);

/// All that is read where a sequence is reconstructed with these options. Nothing may be written to it.
std::vector<std::filesystem::path> inputs_of(const SequenceOptions& options);

}  // namespace patina::tools
