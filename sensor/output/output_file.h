#pragma once

#include <filesystem>
#include <vector>

#include "sensor/output/partial_folder.h"

namespace patina::sensor {

/// A file that appears whole or not at all: it is written in a PartialFolder beside its place and renamed into it.
class OutputFile {
  public:
    /// Whether a file that has the name already is replaced.
    enum class Existing { kReplaced, kRefused };

    /// Touches nothing but the partial folder. Throws Error when the file is or lies inside one of the inputs, its
    /// folder is missing or cannot be written to, it is a folder or a device, it exists and may not be replaced, or
    /// another process writes it.
    explicit OutputFile(const std::filesystem::path& file, const std::vector<std::filesystem::path>& inputs = {},
                        Existing existing = Existing::kReplaced);

    const std::filesystem::path& path() const { return partial_.target(); }  ///< of the finished file, resolved
    const std::filesystem::path& partial_path() const { return place_; }     ///< where to write it; has its extension

    /// Brings what was written to the disk and puts it in place. Throws Error when that fails, or a file that may not
    /// be replaced has appeared; what was written is then kept in a folder beside it, which the message names.
    void finish();

  private:
    PartialFolder partial_;
    std::filesystem::path place_;
    Existing existing_;
};

}  // namespace patina::sensor
