#pragma once

#include <filesystem>

namespace patina::sensor {

/// A folder that appears whole or not at all: files go to NAME.partial-PID beside it, which finish() renames.
class NewFolder {
  public:
    /// Creates the partial folder and its parents. Throws Error when there is a file or a folder with something in it
    /// at `folder`, or its place cannot be written.
    explicit NewFolder(const std::filesystem::path& folder);
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;

    /// Removes what was written, unless finish() was called.
    ~NewFolder();

    const std::filesystem::path& path() const { return folder_; }           ///< absolute, of the finished folder
    const std::filesystem::path& partial_path() const { return partial_; }  ///< where to write until then

    /// Throws Error when the folder cannot be put in place.
    void finish();

  private:
    std::filesystem::path folder_, partial_;
    bool finished_ = false;
};

}  // namespace patina::sensor
