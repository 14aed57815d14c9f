#include "tools/program/standard_streams.h"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace patina::tools {

namespace {

/// Whether the pipe or socket behind standard output has no reader any more.
bool reader_is_gone() {
    pollfd output{STDOUT_FILENO, POLLOUT, 0};
    return poll(&output, 1, 0) > 0 && (output.revents & (POLLERR | POLLHUP)) != 0;
}

}  // namespace

void prepare_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        // The lowest free number is the one that is missing.
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDWR) < 0) break;
    }
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

std::optional<std::string> standard_output_failure() {
    errno = 0;
    const bool flushed = std::fflush(stdout) == 0;
    const int failure = errno;
    if (flushed && std::ferror(stdout) == 0) return std::nullopt;
    if (failure == EPIPE || reader_is_gone()) return std::nullopt;
    return std::string("standard output cannot be written to") +
           (failure != 0 ? std::string(": ") + std::strerror(failure) : std::string());
}

}  // namespace patina::tools
