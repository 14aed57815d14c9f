#pragma once

#include <filesystem>

#include "sensor/output/partial_folder.h"
#include "tools/report/result_names.h"

namespace patina {

/// Throws Error when results of a kind cannot be written to a folder: a file, a place where a disk begins or the
/// program was started, one that cannot be written to, one that holds a folder that cannot be read or moved, or one
/// with files where results go that Patina did not write. `place` is resolved and need not exist.
void expect_replaceable(const std::filesystem::path& place, ResultKind kind);

/// Puts a partial folder, whose files are on the disk, in a place: it is exchanged with the folder that is there in one
/// step, where the file system can do that. What Patina had written in the old folder goes; every
/// other file and folder of it is carried over. Throws Error, leaving the place as it was and the partial folder where
/// it was, when this cannot be done; when only the old folder cannot be removed, the Error says so and the results are
/// in place (PartialFolder::released()).
void swap_in(sensor::PartialFolder& partial, const std::filesystem::path& place, ResultKind kind);

/// Ends an exchange that was cut short: what it left in the hidden folder ".NAME.patina-old". Files of Patina's in it
/// go, all others come back into `place`. Throws Error when they cannot, or another process is at it.
void settle(const std::filesystem::path& place, ResultKind kind);

}  // namespace patina
