#pragma once

#include <filesystem>
#include <string>

#include "tools/program/outcome.h"

namespace patina::tools {

/// What is unpacked, and where to.
struct ExportNativeOptions {
    std::string sequence;       ///< a recording, or a sequence in any format
    std::string format;         ///< of it; empty: recognised
    std::filesystem::path out;  ///< a folder to create
    bool quiet = false;
};

/// Writes a sequence, and the lighting sequence that belongs to it, as a folder in the native format, whole or not at
/// all. Frames without a picture are left out, and those after them move up; times stay. Depth in metres is rounded to
/// the sequence's unit. A camera that decodes from infrared light gets its pictures as infrared/NNNNNN.png, 16 bits a
/// pixel, of the depth camera. Returns how many were left out. Throws Error where the sequence cannot be read or the
/// folder written, Interrupted where the user stops it.
Outcome export_native(const ExportNativeOptions& options);

}  // namespace patina::tools
