#include "tools/commands/parse.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/core/did_you_mean.h"

namespace patina::tools {

CLI::Validator one_of(const std::vector<std::string>& words) {
    const std::string list = CLI::detail::join(words, ", ");
    return {[words, list](std::string& given) -> std::string {
                if (std::find(words.begin(), words.end(), given) != words.end()) return "";
                return text("'", given, "' is none of ", list, did_you_mean(given, words));
            },
            "{" + CLI::detail::join(words, ",") + "}"};
}

CLI::Validator at_least_one() {
    return {[](std::string& given) -> std::string {
                uint32_t number = 0;
                if (parse<uint32_t>(given, number) && number > 0) return "";
                return text("'", given, "' is not a whole number from 1");
            },
            ""};
}

void add_white_option(CLI::App& command, float& albedo) {
    command
        .add_option("--white", albedo,
                    "Albedo of bright surfaces, up to 1; it fixes how bright the light is where no lamp is known, or "
                    "lamps are found in what they light")
        ->check(CLI::Range(0.01f, 1.0f))
        ->capture_default_str();
}

glm::dvec3 parse_up(const std::string& text) {
    glm::dvec3 up(0);
    const size_t comma = text.find(',');
    const bool parsed = comma != text.npos && parse(std::string_view(text).substr(0, comma), up.x) &&
                        parse_pair(std::string_view(text).substr(comma + 1), ',', up.y, up.z);
    const double length = glm::length(up);
    if (!parsed || !std::isfinite(length) || length == 0) {
        throw CLI::ValidationError("--up",
                                   patina::text("'", text, "' is not X,Y,Z with one that is not 0, such as 0,0,1"));
    }
    return up;
}

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
