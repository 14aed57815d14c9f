#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

namespace patina::sensor {

/// Brings what was committed to a recording's log to the disk, and from the log into the file, on a thread of its own:
/// the one that commits never waits for the disk. It has its own connection to the database.
class LogKeeper {
  public:
    explicit LogKeeper(std::filesystem::path file);
    /// Waits for the work under way.
    ~LogKeeper();
    LogKeeper(const LogKeeper&) = delete;
    LogKeeper& operator=(const LogKeeper&) = delete;

    /// To be called after each commit, while no transaction is open. Where the log is longer than `most_log_bytes`,
    /// waits until all of it is in the file: the next transaction begins the log anew then.
    void committed(uint64_t most_log_bytes);

    /// Why commits are not brought to the disk any more, in one sentence; empty while they are. The log keeps all.
    std::string problem() const;

  private:
    void keep(std::stop_token stop);

    std::filesystem::path file_;
    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    uint64_t commits_ = 0;  ///< so far
    uint64_t in_file_ = 0;  ///< of these, those before the last checkpoint that began
    std::string problem_;
    std::jthread thread_;  // last: stops and joins before what it uses is destroyed
};

}  // namespace patina::sensor
