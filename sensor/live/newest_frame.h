#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>

#include "sensor/live/live_source.h"
#include "sensor/live/waiting_skips.h"

namespace patina::sensor {

/// Where a camera's thread leaves readings for the consumer: the newest item, and before it, one after the other, what
/// was dropped or damaged. Its memory is bounded by one item and WaitingSkips. Both sides may be on any thread. An Item
/// is a frame, decoded or not, with an `index`.
template <class Item>
class Newest {
  public:
    using ItemOrSkipped = std::variant<Item, Skipped>;

    /// Takes the next item; one that still waits becomes Skipped.
    void put(ItemOrSkipped reading) {
        {
            const std::lock_guard lock(mutex_);
            if (ended_) return;
            ++counts_.captured;
            drop_waiting();
            if (auto* skipped = std::get_if<Skipped>(&reading)) {
                before_.push(std::move(*skipped));
                ++counts_.damaged;
            } else {
                item_ = std::get<Item>(std::move(reading));
            }
        }
        changed_.notify_all();
    }

    /// No more come; take() ends after those that wait. With a failure, it throws that then.
    void end(std::exception_ptr failure = nullptr) {
        {
            const std::lock_guard lock(mutex_);
            if (ended_) return;
            ended_ = true;
            failure_ = std::move(failure);
        }
        changed_.notify_all();
    }

    /// Waits for the next one; empty at the end.
    std::optional<ItemOrSkipped> take() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !before_.empty() || item_ || ended_; });
        if (auto skipped = before_.pop()) return std::move(*skipped);
        if (item_) {
            ++counts_.delivered;
            return std::exchange(item_, std::nullopt);
        }
        if (failure_) std::rethrow_exception(failure_);
        return std::nullopt;
    }

    LiveCounts counts() const {
        const std::lock_guard lock(mutex_);
        return counts_;
    }

  private:
    void drop_waiting() {
        if (!item_) return;
        before_.push({item_->index, "dropped: a newer frame came before it was asked for", true});
        item_.reset();
        ++counts_.dropped;
    }

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    WaitingSkips before_;  ///< dropped and damaged, older than item_
    std::optional<Item> item_;
    bool ended_ = false;
    std::exception_ptr failure_;
    LiveCounts counts_;
};

using NewestFrame = Newest<Frame>;

}  // namespace patina::sensor
