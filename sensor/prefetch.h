#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "patina/source.h"

namespace patina::sensor {

/// Reads another source ahead on a thread of its own, at most `capacity` readings. Nothing is dropped and the order
/// stays. What the source throws, next() throws after the readings before it, and again on every further call.
/// Destruction waits for no more than the reading that is being decoded. next() may be called from one thread at a
/// time.
class PrefetchSource : public Source {
  public:
    explicit PrefetchSource(std::unique_ptr<Source> source, size_t capacity = 4);

    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override;

  private:
    void read_ahead(std::stop_token stop);

    std::unique_ptr<Source> source_;
    SequenceInfo info_;
    size_t capacity_;

    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::deque<Reading> queue_;
    bool ended_ = false;
    std::exception_ptr failure_;

    std::jthread thread_;  // last: stops and joins before what it uses is destroyed
};

}  // namespace patina::sensor
