#pragma once

#include <filesystem>
#include <string>

#include "tools/program/outcome.h"

namespace patina::tools {

/// What `patina record` was asked to do.
struct RecordOptions {
    std::string source;         ///< a camera (is_camera), or a recording
    std::string format;         ///< of it; empty: recognised
    std::string lighting;       ///< the sequence of low exposure; empty: the one that belongs to the source, if any
    std::filesystem::path out;  ///< a new file
    bool simulate = false;      ///< the sources play as a camera would, else as fast as they are read
    double seconds = 0;         ///< of each sequence, from its first frame on; 0: all of it
    bool quiet = false;
};

/// Records sources into one file, which is whole whenever it ends (Recorder). With `simulate` a person is told what
/// each sequence is for, and how its exposure is. An interrupt ends the recording. Returns what it falls short of.
/// Throws Error where a source cannot be read, or the disk refuses; the file then keeps what was recorded before.
Outcome record(const RecordOptions& options);

}  // namespace patina::tools
