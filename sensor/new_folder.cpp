#include "sensor/new_folder.h"

#include <system_error>

#include <unistd.h>

#include "engine/core/error.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

fs::path without_trailing_slash(const fs::path& folder) {
    const fs::path absolute = fs::absolute(folder).lexically_normal();
    return absolute.has_filename() ? absolute : absolute.parent_path();
}

void expect_free(const fs::path& folder) {
    if (!fs::exists(folder)) return;
    if (!fs::is_directory(folder)) throw Error(folder.string(), " is a file, so that no folder can be written there");
    if (!fs::is_empty(folder))
        throw Error(folder.string(), " exists and is not empty; the result is written to a new folder");
}

}  // namespace

NewFolder::NewFolder(const fs::path& folder)
    : folder_(without_trailing_slash(folder)), partial_(text(folder_.string(), ".partial-", getpid())) {
    expect_free(folder_);
    if (fs::exists(partial_))
        throw Error(partial_.string(), " exists already: another writer's, or left over; remove it");
    std::error_code failure;
    fs::create_directories(partial_, failure);
    if (failure) throw Error(partial_.string(), " cannot be created: ", failure.message());
}

NewFolder::~NewFolder() {
    std::error_code ignored;
    if (!finished_) fs::remove_all(partial_, ignored);
}

void NewFolder::finish() {
    std::error_code failure;
    fs::rename(partial_, folder_, failure);
    if (failure) throw Error(partial_.string(), " cannot be renamed to ", folder_.string(), ": ", failure.message());
    finished_ = true;
}

}  // namespace patina::sensor
