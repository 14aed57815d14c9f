#pragma once

#include <exception>
#include <string>

#include "patina/error.h"

namespace patina {

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
