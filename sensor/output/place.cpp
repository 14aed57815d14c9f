#include "sensor/output/place.h"

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/core/error.h"
#include "sensor/output/apart.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

fs::file_type type_of(const fs::path& path) {
    std::error_code none;
    return fs::symlink_status(path, none).type();
}

bool is_mounted(const fs::path& folder) {
    struct statx status {};
    if (statx(AT_FDCWD, folder.c_str(), AT_SYMLINK_NOFOLLOW, STATX_TYPE, &status) != 0) return false;
    return (status.stx_attributes & status.stx_attributes_mask & STATX_ATTR_MOUNT_ROOT) != 0;
}

/// False where the folder that the program was started in is gone.
bool holds_working_folder(const fs::path& folder) {
    std::error_code gone;
    const fs::path working = fs::current_path(gone);
    return !gone && lies_in(working, folder);
}

}  // namespace

bool is_taken(const fs::path& path) {
    const fs::file_type type = type_of(path);
    return type != fs::file_type::none && type != fs::file_type::not_found;
}

bool is_real_file(const fs::path& path) { return type_of(path) == fs::file_type::regular; }

bool is_real_folder(const fs::path& path) { return type_of(path) == fs::file_type::directory; }

bool begins_disk(const fs::path& folder) {
    if (folder == folder.root_path() || is_mounted(folder)) return true;
    struct stat inner {
    }, outer{};
    return lstat(folder.c_str(), &inner) == 0 && lstat(folder.parent_path().c_str(), &outer) == 0 &&
           inner.st_dev != outer.st_dev;
}

void expect_movable(const fs::path& folder) {
    if (begins_disk(folder))
        throw Error("'", folder.string(), "' is where a disk is mounted, or a part of one begins, ",
                    "which cannot be replaced; give a folder inside it");
    if (holds_working_folder(folder))
        throw Error("'", folder.string(), "' is or holds the folder that this program was started in, ",
                    "which cannot be replaced; start it elsewhere, or give a folder inside it");
}

bool rename_not_known(int error) { return error == EINVAL || error == ENOSYS || error == ENOTSUP; }

int move_to_free_name(const fs::path& from, const fs::path& to) {
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
    if (!rename_not_known(errno)) return errno;
    if (is_taken(to)) return EEXIST;
    return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

fs::path numbered(const fs::path& place, std::string_view suffix, int number) {
    const std::string name = text(place.filename().string(), suffix);
    return place.parent_path() / (number == 1 ? name : text(name, "-", number));
}

}  // namespace patina::sensor
