#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace patina::sensor {

/// Owns an open file or folder, which keeps the lock on it.
class OpenFile {
  public:
    OpenFile() = default;
    explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
    ~OpenFile();
    OpenFile(OpenFile&& other) noexcept;
    OpenFile& operator=(OpenFile&& other) noexcept;

    int get() const { return descriptor_; }
    explicit operator bool() const { return descriptor_ >= 0; }

  private:
    int descriptor_ = -1;
};

/// Opens a folder, which must not be a link, and locks it for this process as long as the result lives. Throws Error
/// when it cannot be opened, or another process has locked it; `target` is what that process writes, for the message.
/// Where a file system knows no locks, there is none.
OpenFile lock_folder(const std::filesystem::path& folder, const std::filesystem::path& target);

/// Throws Error unless an open folder belongs to this process's user, or to the user of `or_of`, where that exists.
/// What another user has put under a name that is easy to guess is not trusted.
void expect_own(const std::filesystem::path& folder, const OpenFile& opened, const std::filesystem::path& or_of = {});

/// The hidden name beside `target`: "dir/.NAME.patina-KIND".
std::filesystem::path hidden_beside(const std::filesystem::path& target, std::string_view kind);

/// Brings all files and folders below a folder, and it itself, to the disk. Throws Error, naming the file that could
/// not.
void flush_to_disk(const std::filesystem::path& folder);

/// Brings a folder's list of names to the disk; a file system that cannot is left alone.
void flush_names(const std::filesystem::path& folder);

/// Where results are written until they are whole: the hidden folder ".NAME.patina-partial" beside the target, open to
/// this user alone. It is locked, so that one process at a time writes a target. What a killed process left there is
/// removed. The target itself is not touched.
class PartialFolder {
  public:
    /// Creates the folder, and folders above it where missing. Throws Error when it cannot be created, belongs to
    /// another user, or another process writes this target.
    explicit PartialFolder(const std::filesystem::path& target);
    /// Removes the folder with all it holds, and those above it that were created and hold nothing.
    ~PartialFolder();
    PartialFolder(const PartialFolder&) = delete;
    PartialFolder& operator=(const PartialFolder&) = delete;

    const std::filesystem::path& target() const { return target_; }  ///< resolved
    const std::filesystem::path& path() const { return path_; }

    /// To be called when the folder has become the target: it is left where it is.
    void release();
    bool released() const { return released_; }

    /// Gives the folder the permissions of a new one, or those of `like`, its owner too where that can be done. Throws
    /// Error when the disk refuses.
    void open_to_others(const std::filesystem::path& like = {}) const;

    /// For results that cannot be put in `place`: the folder gets the first free of the names "NAME-new", "NAME-new-2"
    /// and so on beside it, or, where it cannot be renamed, stays where it is, and is released. Returns where it is.
    std::filesystem::path keep_beside(const std::filesystem::path& place);

  private:
    void create_parents();
    void remove_parents();
    bool try_to_take();
    void learn_owner_and_mode();

    std::filesystem::path target_, path_;
    std::vector<std::filesystem::path> created_;  ///< folders above it, the outermost first
    OpenFile lock_;
    mode_t new_mode_ = 0;  ///< the permissions of a new folder
    bool released_ = false;
};

}  // namespace patina::sensor
