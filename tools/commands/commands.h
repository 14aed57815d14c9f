#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "engine/vulkan/device.h"

namespace patina::tools {

/// What every subcommand that computes takes: which device, and whether to validate.
struct DeviceArguments {
    std::string selector;
    bool validation = false;

    /// Adds --device (also from PATINA_DEVICE) and --validation.
    void add_to(CLI::App& command);
    /// With the pipeline cache in the user's cache folder.
    vulkan::DeviceOptions options() const;
};

/// Each adds one subcommand with its options; the work happens in its callback. Errors are thrown.
void add_doctor(CLI::App& app);
void add_info(CLI::App& app);
void add_synth(CLI::App& app);
void add_run(CLI::App& app);
void add_eval(CLI::App& app);
void add_lights(CLI::App& app);

}  // namespace patina::tools
