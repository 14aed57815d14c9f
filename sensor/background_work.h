#pragma once

#include <algorithm>
#include <deque>
#include <future>
#include <thread>
#include <utility>

namespace patina::sensor {

/// Runs pieces of work on other threads, as many at a time as there are cores. Destruction waits for them. Calls come
/// from one thread at a time.
class BackgroundWork {
  public:
    /// Starts `work`, once the oldest piece is done where there are too many. Throws what an earlier piece threw.
    template <class Work>
    void start(Work work) {
        if (running_.size() == most_) wait_for_oldest();
        running_.push_back(std::async(std::launch::async, std::move(work)));
    }

    /// Waits for all that was started. Throws what the first piece that failed threw.
    void finish() {
        while (!running_.empty()) wait_for_oldest();
    }

    /// Waits for all that was started, whatever became of it.
    void abandon() { running_.clear(); }  // the futures of std::async wait as they are destroyed

  private:
    void wait_for_oldest() {
        std::future<void> oldest = std::move(running_.front());
        running_.pop_front();
        oldest.get();
    }

    size_t most_ = std::max(1u, std::thread::hardware_concurrency());
    std::deque<std::future<void>> running_;
};

}  // namespace patina::sensor
