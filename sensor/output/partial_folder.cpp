#include "sensor/output/partial_folder.h"

#include <algorithm>
#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/core/error.h"
#include "sensor/output/apart.h"
#include "sensor/output/new_file.h"
#include "sensor/output/place.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
constexpr mode_t kAll = 0777, kOwnerAlone = 0700;

/// What the system makes of a new folder in `folder`: its permissions, and its owner as the disk shows it. One is
/// created to learn them: asking for the umask changes it, also for other threads. Returns 0 or the errno.
int create_probe_in(const OpenFile& folder, struct stat& made) {
    constexpr const char* kProbe = ".patina-probe";
    unlinkat(folder.get(), kProbe, AT_REMOVEDIR);  // a killed process's
    if (mkdirat(folder.get(), kProbe, kAll) != 0) return errno;
    const int error = fstatat(folder.get(), kProbe, &made, AT_SYMLINK_NOFOLLOW) == 0 ? 0 : errno;
    unlinkat(folder.get(), kProbe, AT_REMOVEDIR);
    return error;
}

void expect_owner(const fs::path& folder, const OpenFile& opened, uid_t or_user) {
    struct stat status {};
    if (fstat(opened.get(), &status) != 0) throw Error(folder.string(), " cannot be opened: ", disk_reason(errno));
    if (status.st_uid == geteuid() || status.st_uid == or_user) return;
    throw Error(folder.string(), " belongs to user ", status.st_uid, ", not to this one, ", geteuid());
}

/// As lock_folder(); none where the folder is missing.
std::optional<OpenFile> try_to_lock(const fs::path& folder, const fs::path& target) {
    OpenFile opened(open(folder.c_str(), kFolder));
    if (!opened && errno == ENOENT) return std::nullopt;
    if (!opened) throw Error(folder.string(), " cannot be opened: ", disk_reason(errno));
    if (flock(opened.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        throw Error("another process is writing '", target.string(), "': '", folder.string(), "' is locked");
    return opened;
}

bool still_named(const fs::path& path, int descriptor) {
    struct stat named {
    }, open{};
    return lstat(path.c_str(), &named) == 0 && fstat(descriptor, &open) == 0 && named.st_dev == open.st_dev &&
           named.st_ino == open.st_ino;
}

void remove_contents(const fs::path& folder) {
    std::error_code failure;
    fs::directory_iterator entries(folder, failure);
    for (const auto& entry : entries) {
        fs::remove_all(entry.path(), failure);
        if (failure) throw Error(entry.path().string(), " cannot be removed: ", failure.message());
    }
}

std::vector<fs::path> all_below(const fs::path& folder) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_directory() || entry.is_regular_file()) paths.push_back(entry.path());
    }
    paths.push_back(folder);
    return paths;
}

}  // namespace

OpenFile::~OpenFile() {
    if (descriptor_ >= 0) close(descriptor_);
}

OpenFile::OpenFile(OpenFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

OpenFile& OpenFile::operator=(OpenFile&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
}

OpenFile lock_folder(const fs::path& folder, const fs::path& target) {
    std::optional<OpenFile> locked = try_to_lock(folder, target);
    if (!locked) throw Error(folder.string(), " cannot be opened: ", disk_reason(ENOENT));
    return std::move(*locked);
}

void expect_own(const fs::path& folder, const OpenFile& opened, const fs::path& or_of) {
    struct stat other {};
    const bool has_other = !or_of.empty() && stat(or_of.c_str(), &other) == 0;
    expect_owner(folder, opened, has_other ? other.st_uid : geteuid());
}

fs::path hidden_beside(const fs::path& target, std::string_view kind) {
    return target.parent_path() / text(".", target.filename().string(), ".patina-", kind);
}

void flush_to_disk(const fs::path& folder) {
    const std::vector<fs::path> paths = all_below(folder);
    // All are started before any is waited for, so that they share the disk's work.
    for (const fs::path& path : paths) {
        const OpenFile file(open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
        if (file) sync_file_range(file.get(), 0, 0, SYNC_FILE_RANGE_WRITE);
    }
    for (const fs::path& path : paths) {
        const OpenFile file(open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
        const bool done = file && (fsync(file.get()) == 0 || errno == EINVAL || errno == ENOTSUP);
        if (!done) throw Error(path.string(), " cannot be brought to the disk: ", disk_reason(errno));
    }
}

void flush_names(const fs::path& folder) {
    const OpenFile opened(open(folder.c_str(), kFolder));
    if (opened) fsync(opened.get());
}

PartialFolder::PartialFolder(const fs::path& target)
    : target_(resolved(target)), path_(hidden_beside(target_, "partial")) {
    create_parents();
    try {
        constexpr int kTries = 100;  // another process may remove the folder between two calls
        for (int i = 0; !try_to_take(); ++i) {
            if (i == kTries) throw Error(path_.string(), " is taken and given up again all the time");
        }
        remove_contents(path_);
    } catch (...) {
        if (lock_ && still_named(path_, lock_.get())) rmdir(path_.c_str());
        remove_parents();
        throw;
    }
}

bool PartialFolder::try_to_take() {
    if (mkdir(path_.c_str(), kOwnerAlone) != 0 && errno != EEXIST)
        throw Error("'", target_.parent_path().string(), "' cannot be written to: ", disk_reason(errno));
    std::optional<OpenFile> locked = try_to_lock(path_, target_);
    if (!locked || !still_named(path_, locked->get())) return false;
    lock_ = std::move(*locked);
    learn_owner_and_mode();
    return true;
}

/// Some disks show all files as one user's, whoever creates them: what this process creates in the folder is so, too.
void PartialFolder::learn_owner_and_mode() {
    struct stat made {};
    const int error = create_probe_in(lock_, made);
    expect_owner(path_, lock_, error == 0 ? made.st_uid : geteuid());
    if (error != 0) throw Error("'", path_.string(), "' cannot be written to: ", disk_reason(error));
    new_mode_ = made.st_mode & 07777;
}

PartialFolder::~PartialFolder() {
    std::error_code ignored;
    if (!released_ && still_named(path_, lock_.get())) fs::remove_all(path_, ignored);
    if (!released_) remove_parents();
}

void PartialFolder::release() { released_ = true; }

void PartialFolder::open_to_others(const fs::path& like) const {
    struct stat status {};
    const bool copied = !like.empty() && stat(like.c_str(), &status) == 0;
    if (copied) {
        const bool whole = fchown(lock_.get(), status.st_uid, status.st_gid) == 0;
        const bool group = whole || fchown(lock_.get(), static_cast<uid_t>(-1), status.st_gid) == 0;
        static_cast<void>(group);  // it stays this user's
    }
    const mode_t mode = copied ? status.st_mode & 07777 : new_mode_;
    const bool opened = fchmod(lock_.get(), mode) == 0;
    const bool has_modes = errno != EPERM && errno != ENOTSUP;  // some file systems have none
    if (!opened && has_modes) throw Error(path_.string(), " cannot be opened to others: ", disk_reason(errno));
}

fs::path PartialFolder::keep_beside(const fs::path& place) {
    release();
    try {
        open_to_others();
    } catch (const std::exception&) {  // it stays this user's, who can do that
    }
    for (int i = 1; i <= kMostNumbered; ++i) {
        fs::path other = numbered(place, "-new", i);
        const int error = move_to_free_name(path_, other);
        if (error == EEXIST) continue;
        if (error != 0) break;
        flush_names(other.parent_path());
        return other;
    }
    return path_;
}

void PartialFolder::create_parents() {
    std::vector<fs::path> missing;
    for (fs::path folder = target_.parent_path(); !folder.empty() && !is_taken(folder); folder = folder.parent_path())
        missing.push_back(folder);
    std::reverse(missing.begin(), missing.end());
    for (const fs::path& folder : missing) {
        if (mkdir(folder.c_str(), kAll) == 0) {
            created_.push_back(folder);
        } else if (errno != EEXIST) {
            const int error = errno;
            remove_parents();
            throw Error("'", folder.string(), "' cannot be created: ", disk_reason(error));
        }
    }
}

void PartialFolder::remove_parents() {
    for (; !created_.empty(); created_.pop_back()) rmdir(created_.back().c_str());
}

}  // namespace patina::sensor
