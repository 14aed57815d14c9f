#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace patina::tools {

/// Tells a person how far a run is, on standard error: one line that is rewritten on a terminal, one line a second
/// elsewhere, nothing when quiet.
class Progress {
  public:
    /// `stage`: in words, what is being done. `total` is empty where nobody knows it.
    Progress(std::string stage, std::optional<uint32_t> total, bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Says that `done` of the frames are through; `detail` follows the count, the rate and the time left.
    void update(uint32_t done, const std::string& detail);
    /// A message on a line of its own.
    void say(const std::string& message);

  private:
    void clear_line();

    std::string stage_;
    std::optional<uint32_t> total_;
    bool quiet_;
    bool terminal_;
    bool line_open_ = false;
    std::chrono::steady_clock::time_point start_, last_;
};

/// How long work takes that is as fast as it was so far, for a person: "50 s left", "4 min left". Empty before the
/// first seconds, and where the total is not known.
std::string time_left(double seconds, uint32_t done, std::optional<uint32_t> total);

}  // namespace patina::tools
