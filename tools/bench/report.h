#pragma once

#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/vulkan/device.h"
#include "tools/bench/distribution.h"

namespace patina::bench {

/// How the samples of one pass, stage or stretch of work spread, in milliseconds.
struct Row {
    std::string name;
    Distribution ms;
};

nlohmann::ordered_json to_json(const Distribution& distribution);

/// What a subject measured: the figures as text to read, and the same as JSON.
struct Report {
    std::string text;
    nlohmann::ordered_json json;

    /// Begins both with the device and its driver.
    explicit Report(const vulkan::DeviceCaps& caps);

    /// Appends to the text, as fmt::print does.
    template <class... Args>
    void print(fmt::format_string<Args...> format, Args&&... args) {
        fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
    }

    /// Appends a table with a row of minimum, median and 90th percentile for each of `rows`, below `title`; the same in
    /// json["ms"] by the rows' names.
    void table(const std::string& title, const std::vector<Row>& rows);

    /// Appends what work takes on two cores: half the difference of two medians of processor time, `with` and `without`
    /// the work; the same in json["two_cores_ms"][name].
    void difference(const std::string& name, const Distribution& with, const Distribution& without);
};

}  // namespace patina::bench
