#pragma once

#include <filesystem>
#include <string>

namespace patina {

/// The string attribute of a run's frames/NNNNNN.exr that holds the id which `run.json` has as "id". A run's id is made
/// of what it was given and of what it wrote, so that runs that did the same have the same, and others another.
inline constexpr const char* kRunIdAttribute = "patina.run";

/// Stands in the files of a run until its id is known; as long as one.
inline const std::string kRunIdPending(16, '0');

/// Writes a run's id in place of kRunIdPending into an OpenEXR file of write_exr(). Throws Error, naming the file, when
/// it has none pending, or the disk refuses.
void stamp_run_id(const std::filesystem::path& exr, const std::string& id);

}  // namespace patina
