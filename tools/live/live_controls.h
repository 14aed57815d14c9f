#pragma once

#include <string>

namespace patina::tools {

/// What a window's user steers of a live source.
class LiveControls {
  public:
    virtual ~LiveControls() = default;

    /// Ends the source: the run is whole then.
    virtual void end_source() = 0;

    virtual bool is_recording() const = 0;
    /// Begins a recording of all that the source yields from now on, in a file that was not there; or ends the one that
    /// goes on. Returns one sentence for the user.
    virtual std::string toggle_recording() = 0;
};

}  // namespace patina::tools
