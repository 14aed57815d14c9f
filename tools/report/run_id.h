#pragma once

#include <filesystem>
#include <string>

#include "export/write_exr.h"

namespace patina {

/// Stands in the files of a run until its id is known; as long as one.
inline const std::string kRunIdPending(16, '0');

/// Writes a run's id in place of kRunIdPending into an OpenEXR file of write_exr(). Throws Error, naming the file, when
/// it has none pending, or the disk refuses.
void stamp_run_id(const std::filesystem::path& exr, const std::string& id);

}  // namespace patina
