#include "tools/program/progress.h"

#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "engine/core/printable.h"
#include "tools/program/standard_streams.h"

namespace patina::tools {

namespace {
using Clock = std::chrono::steady_clock;
}

Progress::Progress(std::string stage, std::optional<uint32_t> total, bool quiet)
    : stage_(std::move(stage)),
      total_(total),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {}

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
    const std::string left = time_left(seconds, done, total_);
    const std::string line = fmt::format("{}: frame {}{}, {:.1f} frames/s{}{}  {}", stage_, done,
                                         total_ ? fmt::format(" of {}", *total_) : "", done / seconds,
                                         left.empty() ? "" : ", ", left, printable(detail));
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

std::string time_left(double seconds, uint32_t done, std::optional<uint32_t> total) {
    constexpr double kFirst_s = 2;  // a rate over less says little
    if (!total || done == 0 || done > *total || seconds < kFirst_s) return {};
    const double left_s = seconds / done * (*total - done);
    if (left_s < 100) return fmt::format("{:.0f} s left", left_s);
    if (left_s < 6000) return fmt::format("{:.0f} min left", left_s / 60);
    return fmt::format("{:.1f} h left", left_s / 3600);
}

}  // namespace patina::tools
