#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "sensor/output/partial_folder.h"
#include "tools/report/result_names.h"

namespace patina {

/// The folder a command writes its results to. They appear together or not at all: until commit(), everything is
/// written to a hidden folder beside it, ".NAME.patina-partial", and the folder itself is as it was. Results of an
/// earlier run are then replaced, none of them stays; files of the user's own are carried over.
class OutputFolder {
  public:
    /// Checks that results can be written to `path`, locks it, and creates the hidden folder; `path` itself is not
    /// touched. Throws Error where `path` is, holds or lies inside one of the inputs (links are followed), is a file,
    /// a disk's root or the folder that the program was started in, cannot be written to, holds files with names of
    /// results that Patina did not write, or where another process writes to it.
    explicit OutputFolder(const std::filesystem::path& path, const std::vector<std::filesystem::path>& inputs = {},
                          ResultKind kind = ResultKind::kRun);

    const std::filesystem::path& path() const { return path_; }  ///< as it was given

    /// Writes a file of these bytes. `name` is relative, as "frames/000012.exr", and one of is_result_name(); folders
    /// in it are created. Throws Error when the disk refuses.
    void write(const std::string& name, std::string_view bytes);

    /// Where to write the file `name` until publish(name) is called; it does not exist yet and has the extension of
    /// `name`. Creates the folders in `name`. Throws Error when they cannot be created.
    std::filesystem::path stage(const std::string& name);

    /// Counts a staged file among the results. Throws Error when it is missing.
    void publish(const std::string& name);

    /// Removes what was staged and not published, where that failed and the results do without it.
    void discard_staged();

    /// Removes published files whose names begin so, where the results do without them.
    void withdraw(const std::string& beginning);

    /// Where a published file lies until commit().
    std::filesystem::path published(const std::string& name) const;

    /// The names of all results so far, sorted.
    std::vector<std::string> files() const;

    /// A number for names and bytes of the results as they were when they were published, but for report.html, which
    /// holds times.
    uint64_t digest() const;

    /// Puts the results in place. Throws Error when that cannot be done; they are then left under another name, which
    /// the Error names, or the old ones are, where only they cannot be removed.
    void commit();

    /// As commit(), for results that are not whole: where the folder holds whole ones, these stay, and the new ones
    /// go beside it, to NAME-unfinished. Returns where they went.
    std::filesystem::path commit_unfinished();

    /// Instead of commit(), where the file that marks results as whole cannot be written: leaves what was published
    /// under another name beside the folder and returns that; none where nothing was published.
    std::optional<std::filesystem::path> keep();

  private:
    void put_in(const std::filesystem::path& place);

    std::filesystem::path path_;
    ResultKind kind_;
    std::optional<sensor::PartialFolder> partial_;
    std::set<std::string> staged_;             ///< names staged and not yet published
    std::map<std::string, uint64_t> digests_;  ///< of published files
};

}  // namespace patina
