#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace patina::tools {

/// To be called first. Opens /dev/null in place of a standard stream that is closed, so that no file of ours gets its
/// number. Ignores SIGPIPE and SIGXFSZ: what cannot be written is an error of the write, not the program's end.
void prepare_standard_streams();

/// Why standard output could not be written to; flushes it. Empty where all arrived, or the reader has closed it before
/// the end (`patina ... | head -1`), having seen enough.
std::optional<std::string> standard_output_failure();

/// Prints to standard output. A failure loses nothing but the text: standard_output_failure() knows of it.
template <class... Args>
void print_out(fmt::format_string<Args...> format, Args&&... args) {
    std::fputs(fmt::format(format, std::forward<Args>(args)...).c_str(), stdout);
}

/// Prints to standard error, where nothing can be done about a failure.
template <class... Args>
void print_error(fmt::format_string<Args...> format, Args&&... args) {
    std::fputs(fmt::format(format, std::forward<Args>(args)...).c_str(), stderr);
}

}  // namespace patina::tools
