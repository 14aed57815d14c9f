#pragma once

#include <filesystem>

#include "patina/session.h"

namespace patina::tools {

/// What the commands that reconstruct a sequence have in common.
struct SequenceOptions : SessionOptions {
    bool quiet = false;
    DeviceChoice device;
    std::filesystem::path settings_file;  ///< that settings were read from; empty: none
};

}  // namespace patina::tools
