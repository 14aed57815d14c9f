#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <variant>

#include "sensor/live/live_source.h"
#include "sensor/live/newest_frame.h"

namespace patina::sensor {

/// Plays items as a camera would: each comes at the time that its timestamp says after the first one, on a thread of
/// its own. What cannot be read by then comes late. A gap between two timestamps is played as kLongestGap_s at most. An
/// Item is a frame, decoded or not, with `index` and `timestamp_s`.
template <class Item>
class Player {
  public:
    static constexpr double kLongestGap_s = 2;

    using Reading = std::variant<Item, Skipped>;
    using Read = std::function<std::optional<Reading>()>;
    /// Sees every reading before any is dropped, on the player's thread; must return before the next one.
    using Tap = std::function<void(const Reading&)>;

    /// `read` yields what is next, then nothing; it is called on the player's thread. Begins with the first next().
    explicit Player(Read read) : read_(std::move(read)) {}
    ~Player() { stop(); }
    Player(const Player&) = delete;
    Player& operator=(const Player&) = delete;

    /// To be called before the first next().
    void set_tap(Tap tap) { tap_ = std::move(tap); }

    /// Throws what `read` or the tap threw, after what came before.
    std::optional<Reading> next() {
        if (!thread_.joinable()) thread_ = std::jthread([this] { play(); });
        return newest_.take();
    }

    /// Once this returns, the tap is not called any more.
    void stop() {
        {
            const std::lock_guard lock(mutex_);
            stopped_ = true;
        }
        changed_.notify_all();
        newest_.end();
    }

    /// Now, on the clock of the timestamps; 0 before the first.
    double now_s() const {
        const std::lock_guard lock(clock_mutex_);
        return last_ ? last_->timestamp_s + std::chrono::duration<double>(Clock::now() - last_->at).count() : 0;
    }

    LiveCounts counts() const { return newest_.counts(); }

  private:
    using Clock = std::chrono::steady_clock;
    /// A moment on both clocks.
    struct Moment {
        double timestamp_s = 0;
        Clock::time_point at{};
    };

    void play() {
        std::exception_ptr failure;
        try {
            while (std::optional<Reading> reading = read_()) {
                const auto* item = std::get_if<Item>(&*reading);
                if (item && !wait_for(item->timestamp_s)) break;
                if (!hand_over(*std::move(reading))) break;
            }
        } catch (...) {
            failure = std::current_exception();
        }
        newest_.end(failure);
    }

    /// When an item is to come.
    Moment due(double timestamp_s) {
        const std::lock_guard lock(clock_mutex_);
        Moment moment{timestamp_s, Clock::now()};
        if (last_) {
            const double gap_s = std::clamp(timestamp_s - last_->timestamp_s, 0.0, kLongestGap_s);
            moment.at = last_->at + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(gap_s));
        }
        last_ = moment;
        return moment;
    }

    /// False once nobody takes items any more.
    bool wait_for(double timestamp_s) {
        const Moment moment = due(timestamp_s);
        std::unique_lock lock(mutex_);
        changed_.wait_until(lock, moment.at, [&] { return stopped_; });
        return !stopped_;
    }

    bool hand_over(Reading reading) {
        const std::lock_guard lock(mutex_);  // what the tap has seen is counted as captured
        if (stopped_) return false;
        if (tap_) tap_(reading);
        newest_.put(std::move(reading));
        return true;
    }

    Read read_;
    Tap tap_;
    Newest<Item> newest_;
    std::mutex mutex_;  ///< held while the tap runs
    std::condition_variable changed_;
    bool stopped_ = false;  ///< of mutex_
    mutable std::mutex clock_mutex_;
    std::optional<Moment> last_;  ///< of clock_mutex_: the exposure of the last item, or of the one that is waited for
    std::jthread thread_;         // last: joins before what it uses is destroyed
};

}  // namespace patina::sensor
