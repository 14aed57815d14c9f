#include "sensor/output/output_file.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include <unistd.h>

#include "engine/core/error.h"
#include "sensor/output/apart.h"
#include "sensor/output/new_file.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

/// The file, where it can be written.
const fs::path& checked_file(const fs::path& file, const std::vector<fs::path>& inputs, OutputFile::Existing existing) {
    expect_apart(file, inputs);
    const fs::path place = resolved(file), parent = place.parent_path();
    std::error_code failure;
    if (!fs::is_directory(parent, failure))
        throw Error("'", file.string(), "' cannot be written: there is no folder '", parent.string(), "'");
    if (fs::is_directory(place, failure)) throw Error("'", file.string(), "' cannot be written: it is a folder");
    if (fs::exists(place, failure) && !fs::is_regular_file(place, failure))
        throw Error("'", file.string(), "' cannot be written: it is a device or the like, not a file");
    if (existing == OutputFile::Existing::kRefused && fs::exists(place, failure))
        throw Error(file.string(), " exists already");
    return file;
}

}  // namespace

OutputFile::OutputFile(const fs::path& file, const std::vector<fs::path>& inputs, Existing existing)
    : partial_(checked_file(file, inputs, existing)),
      place_(partial_.path() / partial_.target().filename()),
      existing_(existing) {}

void OutputFile::finish() {
    flush_to_disk(partial_.path());
    // A link, unlike a rename, does not replace; file systems without links take the rename.
    const bool linked = existing_ == Existing::kRefused && link(place_.c_str(), path().c_str()) == 0;
    const bool taken = !linked && existing_ == Existing::kRefused && errno == EEXIST;
    if (taken || (!linked && std::rename(place_.c_str(), path().c_str()) != 0)) {
        const std::string reason = taken ? "it exists already" : disk_reason(errno);
        const fs::path kept = partial_.keep_beside(path()) / place_.filename();
        throw Error("'", path().string(), "' cannot be put in place: ", reason, "; what was written is '",
                    kept.string(), "'");
    }
    flush_names(path().parent_path());
}

}  // namespace patina::sensor
