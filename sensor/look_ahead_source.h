#pragma once

#include <cstddef>
#include <deque>
#include <memory>

#include "patina/source.h"

namespace patina::sensor {

/// Another source, whose next readings may be looked at before they are taken, so that it need not be opened twice.
class LookAheadSource : public Source {
  public:
    explicit LookAheadSource(std::unique_ptr<Source> source) : source_(std::move(source)) {}

    /// The reading that is `ahead` after the next one; null beyond the last. Keeps all up to it in memory.
    const Reading* peek(size_t ahead);

    const SequenceInfo& info() const override { return source_->info(); }
    std::optional<Reading> next() override;

  private:
    std::unique_ptr<Source> source_;
    std::deque<Reading> ahead_;
};

}  // namespace patina::sensor
