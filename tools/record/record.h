#pragma once

#include <filesystem>
#include <string>

#include "tools/program/outcome.h"

namespace patina::tools {

/// What `patina record` was asked to do.
struct RecordOptions {
    std::string source;          ///< a camera (is_camera), or a recording
    std::string format;          ///< of it; empty: recognised
    std::string lighting;        ///< the sequence of low exposure; empty: the one that belongs to the source, if any
    double low_exposure_ms = 1;  ///< of a camera's sequence of low exposure
    std::filesystem::path out;   ///< a new file
    bool simulate = false;       ///< the sources play as a camera would, else as fast as they are read
    /// What is raw is decoded before it is recorded; what comes as pictures stays as it is.
    bool decoded = false;
    double seconds = 0;  ///< of each sequence, from its first frame on; 0: all of it
    bool quiet = false;
};

/// Records sources into one file, which is whole whenever it ends (Recorder). A recording in one file is copied row by
/// row, decoded where that is asked for. With a camera, and with `simulate`, prints what each sequence is for, and how
/// its exposure is. An interrupt ends the recording; where a camera records two sequences, the first one ends the first
/// sequence. Returns what it falls short of. Throws Error where a source cannot be read, or the disk refuses: the file
/// keeps what was recorded before. Throws Error, or Interrupted, where no frame was recorded, and leaves no file.
Outcome record(const RecordOptions& options);

}  // namespace patina::tools
