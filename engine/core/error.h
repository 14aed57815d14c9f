#pragma once

#include <exception>
#include <sstream>
#include <stdexcept>
#include <string>

namespace patina {

/// Joins its arguments into one string, as an output stream would print them.
template <class... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream out;
    (out << ... << parts);
    return out.str();
}

/// What the outside causes: a file, a device, memory, settings, or a badly wired graph. The message is one sentence
/// that names the pass or file, the resource or line, and the two values that disagree. Caught once, at a program's
/// border.
class Error : public std::runtime_error {
  public:
    template <class... Parts>
    explicit Error(const Parts&... parts) : std::runtime_error(text(parts...)) {}
};

/// What an exception means, in words for a message: std::bad_alloc's own is the name of a class.
std::string reason_of(const std::exception& failure);

namespace detail {
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line, const std::string& values);
}

}  // namespace patina

/// Stops the program on a bug in our own code; the further arguments are the values that show it. Active in every
/// build.
#define PATINA_ASSERT(condition, ...)                                                                        \
    do {                                                                                                     \
        if (!(condition)) {                                                                                  \
            ::patina::detail::assertion_failed(#condition, __FILE__, __LINE__, ::patina::text(__VA_ARGS__)); \
        }                                                                                                    \
    } while (false)
