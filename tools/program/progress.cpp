#include "tools/program/progress.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "engine/core/printable.h"
#include "tools/program/standard_streams.h"

namespace patina::tools {

namespace {
using Clock = std::chrono::steady_clock;
}

Progress::Progress(std::optional<uint32_t> total, bool quiet)
    : total_(total), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0), start_(Clock::now()), last_(start_) {}

Progress::~Progress() { clear_line(); }

void Progress::clear_line() {
    if (line_open_) std::fputs("\r\033[K", stderr);
    line_open_ = false;
}

void Progress::update(uint32_t done, const std::string& detail) {
    if (quiet_) return;
    const auto now = Clock::now();
    // A terminal is redrawn often enough to look alive; a log gets one line a second.
    const auto interval = terminal_ ? std::chrono::milliseconds(50) : std::chrono::milliseconds(1000);
    if (now - last_ < interval) return;
    last_ = now;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const std::string line = fmt::format("frame {}{}  {:.1f} frames/s  {}", done,
                                         total_ ? fmt::format("/{}", *total_) : "", done / seconds, printable(detail));
    if (terminal_) {
        print_error("\r\033[K{}", line);
        std::fflush(stderr);
        line_open_ = true;
    } else {
        print_error("{}\n", line);
    }
}

void Progress::say(const std::string& message) {
    if (quiet_) return;
    clear_line();
    print_error("{}\n", printable(message));
}

}  // namespace patina::tools
