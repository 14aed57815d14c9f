#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace patina::tools {

/// What is wrong with the command line, in one sentence. A subcommand or an option that there is none of comes first,
/// with the one that was meant: it is often why another one is missed.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error);

}  // namespace patina::tools
