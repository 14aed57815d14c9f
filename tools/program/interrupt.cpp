#include "tools/program/interrupt.h"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace patina::tools {

namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

/// What follows within this time is the same request: `timeout` sends SIGTERM twice, to the program and to its group.
constexpr int64_t kSameRequest_ns = 1'000'000'000;

// A signal handler can reach nothing but globals; it may run on any thread.
std::atomic<int64_t> first_signal_ns = 0;  ///< when; 0: there was none
std::atomic<bool> told_to_end = false;     ///< by another signal than SIGINT
static_assert(std::atomic<int64_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);
int guards = 0;

int64_t now_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);  // one of the few functions that a handler may call
    return int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

extern "C" void note_interrupt(int signal) {
    const int64_t now = now_ns();
    if (signal != SIGINT) told_to_end = true;
    int64_t first = 0;
    if (first_signal_ns.compare_exchange_strong(first, now)) return;
    // A terminal that is closed sends SIGHUP more than once: the shell does, then the kernel. Nobody asks with it.
    if (signal == SIGHUP || now - first < kSameRequest_ns) return;
    std::signal(signal, SIG_DFL);
    std::raise(signal);  // takes effect when this handler returns
}

}  // namespace

InterruptGuard::InterruptGuard() {
    if (guards++ > 0) return;
    first_signal_ns = 0;
    told_to_end = false;
    for (const int signal : kSignals) {
        if (std::signal(signal, note_interrupt) == SIG_IGN) std::signal(signal, SIG_IGN);
    }
}

InterruptGuard::~InterruptGuard() {
    if (--guards > 0) return;
    for (const int signal : kSignals) {
        if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
    }
}

bool InterruptGuard::requested() const { return first_signal_ns != 0; }

bool InterruptGuard::must_end() const { return told_to_end; }

void InterruptGuard::forget() { first_signal_ns = 0; }

}  // namespace patina::tools
