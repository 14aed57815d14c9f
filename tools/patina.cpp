// The patina program: parses the command line and catches errors, once, at its border.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/core/version.h"
#include "tools/commands/commands.h"
#include "tools/commands/usage.h"
#include "tools/program/interrupt.h"
#include "tools/program/outcome.h"
#include "tools/program/standard_streams.h"

namespace {

/// Every failure is one line on standard error, whatever a library or a file's name put into its message.
int fail(std::string message, int exit_code) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    std::fprintf(stderr, "patina: %s\n", patina::printable(message).c_str());
    return exit_code;
}

/// Runs the subcommand; returns the exit code.
int run_command(int argc, char** argv) {
    using namespace patina;
    CLI::App app{"From RGB-D recordings to geometry with materials, on any Vulkan device", "patina"};
    app.set_version_flag("--version", std::string("patina ") + kVersion);
    app.require_subcommand(1);
    tools::add_doctor(app);
    tools::add_info(app);
    tools::add_synth(app);
    tools::add_synth_hemi(app);
    int exit_code = tools::kExitDone;
    tools::add_run(app, exit_code, {argv + std::min(argc, 2), argv + argc});
    tools::add_live(app, exit_code);
    tools::add_record(app, exit_code);
    tools::add_export(app, exit_code);
    tools::add_render(app, exit_code);
    tools::add_view(app);
    tools::add_eval(app);
    tools::add_lights(app);
    tools::add_settings(app);
    tools::add_bench(app);
    try {
        app.parse(argc, argv);
        return exit_code;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);  // --help and --version
        return fail(tools::usage_message(app, error) + " (patina --help shows the usage)", tools::kExitUsage);
    } catch (const Interrupted& interrupted) {
        return fail(interrupted.what(), tools::kExitInterrupted);
    } catch (const std::exception& error) {
        return fail(reason_of(error), tools::kExitFailed);
    }
}

}  // namespace

int main(int argc, char** argv) {
    using namespace patina::tools;
    prepare_standard_streams();
    const int exit_code = run_command(argc, argv);
    if (exit_code != kExitDone && exit_code != kExitShort) return exit_code;
    if (const auto failure = standard_output_failure()) return fail(*failure, kExitFailed);
    return exit_code;
}
