#pragma once

#include <filesystem>
#include <string_view>

namespace patina::sensor {

/// Whether something has this name, and whether that is a file or a folder itself: links are not followed. What cannot
/// be looked at counts as nothing.
bool is_taken(const std::filesystem::path& path);
bool is_real_file(const std::filesystem::path& path);
bool is_real_folder(const std::filesystem::path& path);

/// Whether a disk, or a part of one, begins at a folder: it is mounted there, or is a subvolume of its own. No file can
/// be moved from there to the folder above it.
bool begins_disk(const std::filesystem::path& folder);

/// Throws Error for a folder that no other can replace: a disk begins there, or it is or holds the folder that this
/// program was started in. `folder` is resolved and exists.
void expect_movable(const std::filesystem::path& folder);

/// Whether an errno of renameat2 means that the file system does not know what was asked of it.
bool rename_not_known(int error);

/// A rename that replaces nothing. Returns 0 or the errno.
int move_to_free_name(const std::filesystem::path& from, const std::filesystem::path& to);

/// The name beside `place` with a suffix and, from 2 on, a number: "dir/NAME-new", "dir/NAME-new-2".
std::filesystem::path numbered(const std::filesystem::path& place, std::string_view suffix, int number);

inline constexpr int kMostNumbered = 1000;  ///< names that are tried before a caller gives up

}  // namespace patina::sensor
