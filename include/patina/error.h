#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace patina {

/// Joins its arguments into one string, as an output stream prints them.
template <class... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream out;
    (out << ... << parts);
    return out.str();
}

/// What the outside causes: a file, a device, memory, settings, or wrong arguments. The message is one sentence that
/// names the file or the pass and the two values that disagree. Every function of the library may throw it; what may
/// be the reason stands beside each.
class Error : public std::runtime_error {
  public:
    template <class... Parts>
    explicit Error(const Parts&... parts) : std::runtime_error(text(parts...)) {}
};

/// The caller asked to stop (SessionCallbacks::stop). What was fused so far is still there.
class Interrupted : public Error {
  public:
    using Error::Error;
};

}  // namespace patina
