#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "patina/source.h"

namespace patina::sensor {

/// Frames that a live source skipped and that nobody has asked for yet. Its memory is bounded, however long the
/// consumer is away. Frames that were dropped one after the other are one entry. Of entries beyond kMostEntries, the
/// numbers of dropped and of damaged frames are kept; which of them was damaged, and why, is not.
class WaitingSkips {
  public:
    static constexpr size_t kMostEntries = 64;

    /// Indices rise by one.
    void push(Skipped skipped);

    /// The oldest one: every frame that was pushed comes once, as dropped or as damaged. Empty: none waits.
    std::optional<Skipped> pop();

    bool empty() const { return entries_.empty() && beyond_.count() == 0; }

  private:
    /// `count` frames with consecutive indices; more than one: dropped.
    struct Entry {
        Skipped first;
        uint32_t count = 1;
    };
    struct Beyond {
        uint32_t first = 0, last = 0, dropped = 0, damaged = 0;
        std::string dropped_for;  ///< the last one of them
        uint32_t next = 0;        ///< index of the frame that pop() yields next
        uint32_t count() const { return dropped + damaged; }
    };
    Skipped pop_beyond();

    std::deque<Entry> entries_;
    Beyond beyond_;  ///< newer than entries_
};

}  // namespace patina::sensor
