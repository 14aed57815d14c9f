#include "tools/report/swap_folder.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/core/error.h"
#include "sensor/output/new_file.h"
#include "sensor/output/place.h"

namespace patina {
namespace {

namespace fs = std::filesystem;
using sensor::disk_reason;
using sensor::is_real_folder;
using sensor::is_taken;
using sensor::move_to_free_name;

fs::path retired(const fs::path& place) { return sensor::hidden_beside(place, "old"); }

bool same_file(const fs::path& a, const fs::path& b) {
    struct stat of_a {
    }, of_b{};
    return lstat(a.c_str(), &of_a) == 0 && lstat(b.c_str(), &of_b) == 0 && of_a.st_dev == of_b.st_dev &&
           of_a.st_ino == of_b.st_ino;
}

[[noreturn]] void refuse(const fs::path& place, const std::string& reason) {
    throw Error("'", place.string(), "' ", reason);
}

/// Throws Error unless every folder below `folder` can be read and moved. Where results are replaced, those move that
/// are not Patina's, and after hours of work it is too late to find that they cannot.
void expect_movable_below(const fs::path& folder, const fs::path& place) {
    std::error_code failure;
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure)) {
        const fs::path& inner = entry->path();
        if (!is_real_folder(inner)) continue;
        const std::string name = inner.lexically_relative(place).string();
        if (sensor::begins_disk(inner))
            refuse(place, text("holds '", name, "', where a disk is mounted, or a part of one begins, which cannot be ",
                               "moved; give another folder"));
        if (faccessat(AT_FDCWD, inner.c_str(), R_OK | W_OK | X_OK, AT_EACCESS) != 0)
            refuse(place, text("holds '", name, "', which cannot be read and written: ", disk_reason(errno)));
        expect_movable_below(inner, place);
    }
    if (failure) refuse(place, text("cannot be read: '", folder.string(), "': ", disk_reason(failure.value())));
}

/// Where two folders meet, entries of the first go into the second; what has its place taken stays. Returns 0, or the
/// errno of the first move that failed for another reason.
int carry_over(const fs::path& from, const fs::path& to, const std::string& but) {
    int first_error = 0;
    for (const auto& entry : fs::directory_iterator(from)) {
        const fs::path name = entry.path().filename(), target = to / name;
        if (name == but) continue;
        int error = 0;
        if (is_real_folder(entry.path()) && is_real_folder(target)) {
            error = carry_over(entry.path(), target, "");
            rmdir(entry.path().c_str());
        } else if (same_file(entry.path(), target)) {
            fs::remove(entry.path());
        } else {
            error = move_to_free_name(entry.path(), target);
        }
        if (first_error == 0 && error != EEXIST) first_error = error;
    }
    return first_error;
}

void remove_results(const fs::path& folder, const EarlierResults& results, const std::string& mark) {
    for (const std::string& name : results.files) {
        if (name == mark) continue;
        fs::remove(folder / name);
        const fs::path parent = (folder / name).parent_path();
        if (parent != folder) rmdir(parent.c_str());  // once it is empty
    }
}

/// The mark is removed last: it says which files are Patina's. Returns why `old` is still there; empty where it is
/// gone.
std::string retire(const fs::path& old, const fs::path& place, ResultKind kind) {
    const std::string mark = mark_of(kind);
    const EarlierResults results = results_in(old, kind);
    const bool marked = results.files.contains(mark);
    try {
        remove_results(old, results, mark);
        const int error = carry_over(old, place, marked ? mark : "");
        if (marked) fs::remove(old / mark);
        if (rmdir(old.c_str()) != 0) return disk_reason(error != 0 ? error : errno);
    } catch (const fs::filesystem_error& failure) {
        return failure.code().message();
    }
    sensor::flush_names(place);
    sensor::flush_names(place.parent_path());
    return {};
}

/// Creates the folders of `name` in `to` that are missing, with the owner and the permissions they have in `from`.
void create_folders_like(const fs::path& from, const fs::path& to, const fs::path& name) {
    if (name.empty() || is_taken(to / name)) return;
    create_folders_like(from, to, name.parent_path());
    struct stat status {};
    if (stat((from / name).c_str(), &status) != 0 || mkdir((to / name).c_str(), 0700) != 0) return;
    const bool owned = chown((to / name).c_str(), status.st_uid, status.st_gid) == 0;
    static_cast<void>(owned);  // else it is this user's
    chmod((to / name).c_str(), status.st_mode & 07777);
}

/// Files of the user's have a second name in the new folder before the first goes, so that no moment is without one.
/// Where that cannot be, carry_over() moves them.
void link_foreign_files(const fs::path& place, const fs::path& partial, ResultKind kind) {
    const EarlierResults results = results_in(place, kind);
    for (const auto& entry : fs::recursive_directory_iterator(place)) {
        const fs::path name = entry.path().lexically_relative(place);
        if (is_real_folder(entry.path()) || results.files.contains(name.string())) continue;
        create_folders_like(place, partial, name.parent_path());
        const int ignored = linkat(AT_FDCWD, entry.path().c_str(), AT_FDCWD, (partial / name).c_str(), 0);
        static_cast<void>(ignored);
    }
}

/// From here on the new folder has the name of what an exchange leaves, so that whoever finds that after this process
/// was killed knows that users' files may be in it.
void exchange(const fs::path& partial, const fs::path& place) {
    const fs::path old = retired(place);
    if (const int error = move_to_free_name(partial, old)) refuse(place, "cannot be exchanged: " + disk_reason(error));
    if (renameat2(AT_FDCWD, old.c_str(), AT_FDCWD, place.c_str(), RENAME_EXCHANGE) == 0) return;
    int error = errno;
    if (move_to_free_name(old, partial) != 0) refuse(place, "cannot be exchanged: " + disk_reason(error));
    if (sensor::rename_not_known(error)) {
        error = move_to_free_name(place, old);
        if (error == 0) {
            error = move_to_free_name(partial, place);
            if (error == 0) return;
            move_to_free_name(old, place);
        }
    }
    refuse(place, "cannot be exchanged: " + disk_reason(error));
}

}  // namespace

void expect_replaceable(const fs::path& place, ResultKind kind) {
    if (!is_taken(place)) return;
    if (!is_real_folder(place)) refuse(place, "is a file, not a folder");
    sensor::expect_movable(place);
    if (faccessat(AT_FDCWD, place.c_str(), R_OK | W_OK | X_OK, AT_EACCESS) != 0)
        refuse(place, "cannot be written to: " + disk_reason(errno));
    expect_movable_below(place, place);
    const EarlierResults found = results_in(place, kind);
    for (const std::string& name : found.names) {
        if (found.files.contains(name)) continue;
        refuse(place, text("holds '", name, "', which has the name of a result, but is of no finished ",
                           kind == ResultKind::kRun ? "run" : "evaluation", "; remove it, or give another folder"));
    }
}

void swap_in(sensor::PartialFolder& partial, const fs::path& place, ResultKind kind) {
    expect_replaceable(place, kind);
    if (!is_taken(place)) {
        partial.open_to_others();
        if (const int error = move_to_free_name(partial.path(), place))
            refuse(place, "cannot be put in place: " + disk_reason(error));
        partial.release();
        sensor::flush_names(place.parent_path());
        return;
    }
    const sensor::OpenFile lock = sensor::lock_folder(place, place);  // the old folder's, until it is gone
    partial.open_to_others(place);
    link_foreign_files(place, partial.path(), kind);
    sensor::flush_names(partial.path());
    exchange(partial.path(), place);
    partial.release();
    sensor::flush_names(place.parent_path());
    const std::string reason = retire(retired(place), place, kind);
    if (reason.empty()) return;
    throw Error("the results are in '", place.string(), "', but files that were there before are still in '",
                retired(place).string(), "': ", reason);
}

void settle(const fs::path& place, ResultKind kind) {
    const fs::path old = retired(place);
    if (!is_taken(old)) return;
    const sensor::OpenFile lock = sensor::lock_folder(old, place);
    sensor::expect_own(old, lock, place);
    if (!is_taken(place)) {
        if (const int error = move_to_free_name(old, place))
            refuse(place, text("cannot be restored from '", old.string(), "': ", disk_reason(error)));
        return;
    }
    const std::string reason = retire(old, place, kind);
    if (reason.empty()) return;
    refuse(place,
           text("was being replaced when an earlier run was stopped, and files that were in it before cannot be ",
                "moved back from '", old.string(), "': ", reason, "; move or remove them"));
}

}  // namespace patina
