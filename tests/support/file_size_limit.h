#pragma once

#include <csignal>

#include <sys/resource.h>

namespace patina::test {

/// While it lives, no file of this process, and of programs that it starts, can grow beyond a size: writes are refused
/// as on a full disk, but without filling one.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) : earlier_signal_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &earlier_);
        const rlimit limit{bytes, earlier_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &earlier_);
        std::signal(SIGXFSZ, earlier_signal_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  private:
    void (*earlier_signal_)(int);
    rlimit earlier_{};
};

}  // namespace patina::test
