#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "engine/vulkan/device.h"
#include "tools/program/sequence_options.h"

namespace patina::tools {

/// What every subcommand that computes takes: which device, and whether to validate.
struct DeviceArguments {
    std::string selector;
    bool validation = false;
    uint64_t memory_mib = 0;  ///< 0: no limit

    /// Adds --device (also from PATINA_DEVICE), --validation and --memory.
    void add_to(CLI::App& command);
    /// With the pipeline cache in the user's cache folder.
    DeviceChoice choice() const;
    vulkan::DeviceOptions options() const;  ///< the same for what uses the engine alone
};

/// What run and render take to make a reconstruction, the device included.
struct SequenceArguments {
    DeviceArguments device;
    std::string settings_file;
    std::vector<std::string> assignments;
    std::string lights, lighting, specular;
    bool truth_materials = false;

    /// Adds the options. Both this and `options` must outlive the parsing.
    void add_to(CLI::App& command, SequenceOptions& options);
    /// Brings settings and device into the options, once the command line is parsed.
    void finish(SequenceOptions& options) const;

  private:
    LightingChoice lighting_choice() const;
    Materials materials_choice() const;
};

/// Each adds one subcommand with its options; the work happens in its callback. Errors are thrown; `exit_code` becomes
/// that of a subcommand that wrote results which fall short (outcome.h), and must outlive the parsing.
void add_doctor(CLI::App& app);
void add_info(CLI::App& app);
void add_synth(CLI::App& app);
void add_synth_hemi(CLI::App& app);
/// `arguments`: the command line after "run".
void add_run(CLI::App& app, int& exit_code, const std::vector<std::string>& arguments);
void add_live(CLI::App& app, int& exit_code);
void add_record(CLI::App& app, int& exit_code);
void add_export(CLI::App& app, int& exit_code);
void add_render(CLI::App& app, int& exit_code);
void add_view(CLI::App& app);
void add_eval(CLI::App& app);
void add_lights(CLI::App& app);
void add_settings(CLI::App& app);
void add_bench(CLI::App& app);

}  // namespace patina::tools
