#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "patina/image.h"
#include "tools/bench/report.h"

namespace CLI {
class App;
}

namespace patina::bench {

/// The options that all subjects share, with the subject's default for what was not given.
struct Conditions {
    vulkan::DeviceOptions device;
    uint32_t warmup = 0;             ///< frames before those that are measured
    uint32_t frames = 0;             ///< to measure, at least 1
    std::optional<Extent2D> extent;  ///< of colour and depth, in pixels; empty: as recorded
};

inline constexpr const char* kAsRecorded = "as recorded";

/// A subject's defaults of the shared options; one that is empty does not apply to the subject, and is refused.
struct Defaults {
    std::optional<uint32_t> warmup{};
    std::optional<uint32_t> frames{};
    std::optional<std::string> extent{};  ///< WIDTHxHEIGHT, or kAsRecorded
};

/// Measures, once the command line is parsed. Throws Error for what cannot be read or met.
using Measure = std::function<Report(const Conditions&)>;

/// Something to measure.
struct Subject {
    std::string name;      ///< of its subcommand, `patina bench NAME`
    std::string sentence;  ///< what is measured, for --help
    Defaults defaults;
    /// Adds the options that are the subject's own. What it returns holds their values.
    std::function<Measure(CLI::App&)> add_options;
};

}  // namespace patina::bench
