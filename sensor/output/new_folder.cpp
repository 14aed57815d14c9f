#include "sensor/output/new_folder.h"

#include <cerrno>
#include <cstdio>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "sensor/output/apart.h"
#include "sensor/output/new_file.h"
#include "sensor/output/place.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

const fs::path& checked_folder(const fs::path& folder, const std::vector<fs::path>& inputs) {
    expect_apart(folder, inputs);
    if (!path_exists(folder)) return folder;
    if (!is_folder(folder)) throw Error(folder.string(), " is a file, so that no folder can be written there");
    if (!entries_of(folder).empty())
        throw Error(folder.string(), " exists and is not empty; the result is written to a new folder");
    expect_movable(resolved(folder));
    return folder;
}

}  // namespace

NewFolder::NewFolder(const fs::path& folder, const std::vector<fs::path>& inputs)
    : partial_(checked_folder(folder, inputs)) {}

void NewFolder::finish() {
    try {
        flush_to_disk(partial_path());
        partial_.open_to_others();
        if (std::rename(partial_path().c_str(), path().c_str()) != 0)
            throw Error(partial_path().string(), " cannot be renamed to ", path().string(), ": ", disk_reason(errno));
    } catch (const std::exception& failure) {
        const fs::path kept = partial_.keep_beside(path());
        throw Error(reason_of(failure), "; what was written is in '", kept.string(), "'");
    }
    partial_.release();
    flush_names(path().parent_path());
}

}  // namespace patina::sensor
