// The patina program: parses the command line and catches errors, once, at its border.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

#include "engine/core/error.h"
#include "tools/commands/commands.h"
#include "tools/interrupt.h"
#include "tools/version.h"

namespace {

constexpr int kFailed = 1;
constexpr int kUsage = 2;
constexpr int kInterrupted = 130;  // what shells report for SIGINT

/// Every failure is one line on standard error, whatever a library put into its message.
int fail(std::string message, int exit_code) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    std::fprintf(stderr, "patina: %s\n", message.c_str());
    return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace patina;
    CLI::App app{"From RGB-D recordings to geometry with materials, on any Vulkan device", "patina"};
    app.set_version_flag("--version", std::string("patina ") + tools::kVersion);
    app.require_subcommand(1);
    tools::add_doctor(app);
    tools::add_info(app);
    tools::add_synth(app);
    tools::add_synth_hemi(app);
    tools::add_run(app);
    tools::add_render(app);
    tools::add_eval(app);
    tools::add_lights(app);
    try {
        app.parse(argc, argv);
        return 0;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);  // --help and --version
        return fail(std::string(error.what()) + " (patina --help shows the usage)", kUsage);
    } catch (const tools::Interrupted& interrupted) {
        return fail(interrupted.what(), kInterrupted);
    } catch (const std::exception& error) {
        return fail(error.what(), kFailed);
    }
}
