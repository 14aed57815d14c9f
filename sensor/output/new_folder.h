#pragma once

#include <filesystem>
#include <vector>

#include "sensor/output/partial_folder.h"

namespace patina::sensor {

/// A folder that appears whole or not at all: files go to a PartialFolder beside it, which finish() renames.
class NewFolder {
  public:
    /// Creates the partial folder and those above it. Throws Error when there is a file or a folder with something in
    /// it at `folder`, or one that cannot be replaced (expect_movable), it is, holds or lies inside one of the inputs,
    /// its place cannot be written, or another process writes it.
    explicit NewFolder(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& inputs = {});

    const std::filesystem::path& path() const { return partial_.target(); }        ///< of the finished folder, resolved
    const std::filesystem::path& partial_path() const { return partial_.path(); }  ///< where to write until then

    /// Brings what was written to the disk and renames the folder. Throws Error when it cannot be put in place; what
    /// was written is then left under another name, which the Error names.
    void finish();

  private:
    PartialFolder partial_;
};

}  // namespace patina::sensor
