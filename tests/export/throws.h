#pragma once

#include <gmock/gmock.h>

#include "engine/core/error.h"

namespace patina::test {

/// Matches a callable that throws patina::Error with a sentence that contains `part`.
inline auto throws_error_with(const std::string& part) {
    return testing::ThrowsMessage<Error>(testing::HasSubstr(part));
}

}  // namespace patina::test
