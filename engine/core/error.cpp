#include "engine/core/error.h"

#include <cstdio>
#include <cstdlib>
#include <new>

namespace patina {

std::string reason_of(const std::exception& failure) {
    return dynamic_cast<const std::bad_alloc*>(&failure) ? "there is not enough memory" : failure.what();
}

namespace detail {

void assertion_failed(const char* condition, const char* file, int line, const std::string& values) {
    std::fprintf(stderr, "%s:%d: assertion failed: %s (%s)\n", file, line, condition, values.c_str());
    std::abort();
}

}  // namespace detail

}  // namespace patina
