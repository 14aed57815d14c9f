#pragma once

#include <optional>
#include <string>

#include "patina/session.h"
#include "tools/program/interrupt.h"
#include "tools/program/progress.h"

namespace patina::tools {

/// Shows on the terminal what a session reports, and stops it when the user asks. Lives as long as what calls it.
class Console {
  public:
    explicit Console(bool quiet) : quiet_(quiet) {}
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    /// Callbacks that refer to this.
    SessionCallbacks callbacks();

    /// Says what comes after the frames, in words.
    void stage(const std::string& words) { say(words + " ..."); }

    /// Removes the line of progress.
    void end() { progress_.reset(); }

    const InterruptGuard& interrupt() const { return interrupt_; }

  private:
    void show(const SessionProgress& progress);
    void say(const std::string& message);

    InterruptGuard interrupt_;
    bool quiet_;
    std::string task_;
    std::optional<Progress> progress_;  ///< of the task under way
};

}  // namespace patina::tools
