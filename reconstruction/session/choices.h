#pragma once

#include <string>

#include "patina/session.h"

namespace patina {

/// The scene of "synthetic:SCENE"; empty for a recording.
std::optional<std::string> synthetic_scene(const SessionOptions& options);

/// The words by which command line and run.json know a choice.
std::string name_of(const LightingChoice& lighting);  ///< "", "none", "self", or the sequence that is named
std::string name_of(Labels labels);
std::string name_of(Poses poses);
std::string name_of(Materials materials);  ///< "" where it is open
std::string name_of(Detail detail);

/// Whether poses of the source are used for more than the first frame's.
bool uses_given_poses(const SessionOptions& options);

/// A sentence that asks for something, with a hint of SessionHints in brackets, if there is one.
std::string hinted(const std::string& sentence, const std::string& hint);

/// The end of a sentence that asks for lights.
std::string give_lights(const SessionOptions& options);

/// Calls what the caller gave, if anything.
void report(const SessionCallbacks& callbacks, const SessionProgress& progress);
void report(const SessionCallbacks& callbacks, const std::string& message);
bool stop_requested(const SessionCallbacks& callbacks);

}  // namespace patina
