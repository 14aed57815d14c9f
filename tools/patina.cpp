// The patina program: parses the command line and catches errors, once, at its border.

#include <cstdio>
#include <exception>

#include "engine/core/error.h"
#include "tools/commands/commands.h"
#include "tools/interrupt.h"
#include "tools/version.h"

int main(int argc, char** argv) {
    using namespace patina;
    CLI::App app{"From RGB-D recordings to geometry with materials, on any Vulkan device", "patina"};
    app.set_version_flag("--version", std::string("patina ") + tools::kVersion);
    app.require_subcommand(1);
    tools::add_doctor(app);
    tools::add_info(app);
    tools::add_synth(app);
    tools::add_run(app);
    try {
        app.parse(argc, argv);
        return 0;
    } catch (const CLI::ParseError& error) {
        return app.exit(error);
    } catch (const tools::Interrupted& interrupted) {
        std::fprintf(stderr, "patina: %s\n", interrupted.what());
        return 130;  // what shells report for SIGINT
    } catch (const std::exception& error) {
        std::fprintf(stderr, "patina: %s\n", error.what());
        return 1;
    }
}
