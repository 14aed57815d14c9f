#pragma once

#include "engine/core/error.h"

namespace patina::tools {

/// While one lives, SIGINT, SIGTERM and SIGHUP are noted instead of ending the program, so that work can stop between
/// frames. A SIGINT or SIGTERM that comes a second or more after the first signal ends the program at once; earlier
/// ones, and every further SIGHUP, change nothing. Guards may be nested; a signal noted under an inner one is known to
/// the outer ones too. A signal that was ignored before (nohup) stays ignored.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    bool requested() const;

    /// Whether the program is to end, rather than what it does at present: a SIGTERM or SIGHUP has come.
    bool must_end() const;

    /// Forgets what was requested: the next signal is the first one again.
    void forget();
};

}  // namespace patina::tools
