#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>

namespace patina {

/// The folder a command writes into. Every file appears whole or not at all: it is written beside its place under a
/// temporary name and renamed into it. What was there before stays until its replacement is complete, except for the
/// file that is written last, a run's `run.json`: that is removed at once, so that its presence says that this run
/// finished.
class OutputFolder {
  public:
    /// Creates the folder and its parents where missing, checks that it can be written to, and removes an earlier
    /// `finished_mark`. Throws Error where the path is a file or cannot be written to.
    explicit OutputFolder(std::filesystem::path path, const std::string& finished_mark = "run.json");

    /// Removes what was staged but not published.
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

    /// Puts a file of these bytes in its place. `name` is relative, as "frames/000012.exr"; folders in it are created.
    /// Throws Error when the disk refuses.
    void write(const std::string& name, std::string_view bytes);

    /// Where to write the file `name` until publish(name) is called; it has the extension of `name`. Creates the
    /// folders in `name`. Throws Error when they cannot be created.
    std::filesystem::path stage(const std::string& name);

    /// Renames a staged file into its place, replacing what was there. Throws Error when the staged file is missing or
    /// the disk refuses.
    void publish(const std::string& name);

  private:
    std::filesystem::path path_;
    std::set<std::string> staged_;  ///< names staged and not yet published
};

}  // namespace patina
