#pragma once

#include <filesystem>

#include "passes/state/network.h"

namespace patina {

/// Reads a network that estimates materials from HemiImages (format: docs/develop/specular.md). Throws Error as
/// read_tensor_file(), and, naming the file and the field, when the list of layers is missing, has an unknown kind,
/// takes another input or gives another output than a material, or when tensors are missing, superfluous, or have
/// shapes that the layers do not ask for.
NetworkDescription read_network_file(const std::filesystem::path& file);

}  // namespace patina
