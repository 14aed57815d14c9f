#pragma once

#include <optional>
#include <string>
#include <variant>

#include "sensor/frame.h"

namespace patina::sensor {

/// A frame that could not be used, and why, in one sentence that names its file.
struct Skipped {
    uint32_t index = 0;
    std::string reason;
};

/// One step of a source: a frame, or the reason why there is none at this index.
using Reading = std::variant<Frame, Skipped>;

/// Where frames come from. Knows no reconstruction. Every index from 0 to info().frames - 1 is yielded once, in order,
/// as a frame or as skipped, so that a ledger of what became of them adds up to the sequence.
class Source {
  public:
    virtual ~Source() = default;

    /// What holds for the whole sequence; valid from construction on.
    virtual const SequenceInfo& info() const = 0;

    /// The next frame; empty after the last one. A damaged frame is skipped; what makes the whole sequence unusable
    /// throws Error.
    virtual std::optional<Reading> next() = 0;
};

}  // namespace patina::sensor
