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
    /// `total` is empty where nobody knows it.
    Progress(std::optional<uint32_t> total, bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Says that `done` of the frames are through; `detail` follows the count and rate.
    void update(uint32_t done, const std::string& detail);
    /// A message on a line of its own.
    void say(const std::string& message);

  private:
    void clear_line();

    std::optional<uint32_t> total_;
    bool quiet_;
    bool terminal_;
    bool line_open_ = false;
    std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace patina::tools
