#include "sensor/recording/log_keeper.h"

#include <system_error>
#include <utility>

#include "engine/core/error.h"
#include "engine/store/database.h"

namespace patina::sensor {

LogKeeper::LogKeeper(std::filesystem::path file)
    : file_(std::move(file)), thread_([this](std::stop_token stop) { keep(stop); }) {}

LogKeeper::~LogKeeper() = default;

void LogKeeper::committed(uint64_t most_log_bytes) {
    std::unique_lock lock(mutex_);
    ++commits_;
    changed_.notify_all();
    std::error_code failure;
    const uint64_t bytes = std::filesystem::file_size(file_.string() + "-wal", failure);
    if (failure || bytes <= most_log_bytes) return;
    changed_.wait(lock, [&] { return in_file_ == commits_ || !problem_.empty(); });
}

std::string LogKeeper::problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
}

void LogKeeper::keep(std::stop_token stop) {
    try {
        Database database(file_, DatabaseUse::kLog);
        std::unique_lock lock(mutex_);
        while (changed_.wait(lock, stop, [&] { return in_file_ != commits_; })) {
            const uint64_t commits = commits_;
            lock.unlock();
            database.run("PRAGMA wal_checkpoint(PASSIVE)");
            lock.lock();
            in_file_ = commits;
            changed_.notify_all();
        }
    } catch (const std::exception& error) {
        const std::lock_guard lock(mutex_);
        problem_ = reason_of(error);
        changed_.notify_all();
    }
}

}  // namespace patina::sensor
