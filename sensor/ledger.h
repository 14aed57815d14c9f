#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "patina/source.h"

namespace patina::sensor {

/// What became of a sequence's frames. Every reading is noted once when it arrives, and every frame once more when it
/// was used or could not be. One that was used may be undone.
class Ledger {
  public:
    /// Notes that a source yielded a frame or skipped one; a skipped one is settled with that. Dropped ones are only
    /// counted: there may be twenty a second.
    void note(const Reading& reading);

    /// Notes that a frame was used.
    void use(uint32_t index);

    /// Notes that a frame could not be used, and why.
    void skip(uint32_t index, std::string reason);

    /// Notes that a frame was left out because it says nothing that the one before did not. Such ones are only counted:
    /// nothing is missing.
    void repeat(uint32_t index);

    /// Notes that the last `count` frames that were used count no more: the user went back to before them.
    void undo(uint32_t count);

    uint32_t read() const { return read_; }
    uint32_t used() const { return used_; }
    uint32_t dropped() const { return dropped_; }
    uint32_t repeated() const { return repeated_; }
    uint32_t undone() const { return undone_; }
    const std::vector<Skipped>& skipped() const { return skipped_; }  ///< without those that were dropped

    /// Empty when every frame of the sequence was read once, and used (and perhaps undone), repeated, skipped or
    /// dropped once; otherwise one sentence that says by how much the numbers disagree. Of a source without a known
    /// length, what was read is what there was.
    std::optional<std::string> discrepancy(const SequenceInfo& info) const;

  private:
    void settle(uint32_t index);

    uint32_t read_ = 0;
    uint32_t used_ = 0;
    uint32_t dropped_ = 0;
    uint32_t repeated_ = 0;
    uint32_t undone_ = 0;
    std::vector<Skipped> skipped_;
    std::vector<uint32_t> settled_;  ///< how often, by frame index
};

}  // namespace patina::sensor
