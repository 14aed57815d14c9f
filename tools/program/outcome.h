#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace patina::tools {

/// How the program ends.
enum ExitCode : int {
    kExitDone = 0,
    kExitFailed = 1,
    kExitUsage = 2,
    kExitShort = 3,  ///< it finished, or was interrupted, and wrote results, but these fall short of what was asked
    kExitInterrupted = 130  ///< interrupted with nothing written; what shells report for SIGINT
};

/// What a command that wrote its results fell short of: one sentence each, the first lines of its summary.
class Outcome {
  public:
    /// Sentences come in the order in which they are given, each once.
    void fall_short(std::string sentence) {
        if (std::ranges::find(shortfalls_, sentence) == shortfalls_.end()) shortfalls_.push_back(std::move(sentence));
    }

    const std::vector<std::string>& shortfalls() const { return shortfalls_; }
    ExitCode exit_code() const { return shortfalls_.empty() ? kExitDone : kExitShort; }

    /// The first lines of the summary; where that is not wanted (`quiet`), on standard error like errors.
    void print(bool quiet) const;

  private:
    std::vector<std::string> shortfalls_;
};

}  // namespace patina::tools
