#pragma once

#include <ctime>

namespace patina::bench {

/// Processor time of this process, all threads together: on a software device what the work takes of all cores,
/// whatever else runs on them.
inline double processor_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

}  // namespace patina::bench
