#pragma once

#include "engine/core/error.h"

namespace patina::tools {

/// The user asked to stop.
class Interrupted : public Error {
  public:
    using Error::Error;
};

/// While it lives, SIGINT and SIGTERM are noted instead of ending the program, so that work can stop between frames. A
/// second signal ends the program at once.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    bool requested() const;
};

}  // namespace patina::tools
