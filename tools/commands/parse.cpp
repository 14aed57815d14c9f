#include "tools/commands/parse.h"

#include <algorithm>

#include <CLI/CLI.hpp>

namespace patina::tools {

Extent2D parse_extent(const std::string& text) {
    constexpr uint32_t kMost =
        8192;  // pixels of random numbers are told apart by 16 bits, and devices hold images of it
    Extent2D extent;
    if (!parse_pair(text, 'x', extent.width, extent.height) || extent.area() == 0 ||
        std::max(extent.width, extent.height) > kMost) {
        throw CLI::ValidationError("--extent", patina::text("'", text, "' is not WIDTHxHEIGHT of 1 to ", kMost,
                                                            " pixels each, such as 512x424"));
    }
    return extent;
}

}  // namespace patina::tools
