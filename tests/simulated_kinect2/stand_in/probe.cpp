// Runs the driver over whatever libusb is loaded and prints what came: kinect2_probe SECONDS [RUNS [compare]].
//   Frames, lost and unpaired ones, and the CPU time of this process without that of the stand-in's bus. With
//   "compare", frames whose numbers are both even or both odd must have the same bytes, as the stand-in sends them.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

#include "sensor/kinect2/device.h"
#include "sensor/kinect2/usb_transport.h"

namespace {

using namespace patina;
using namespace patina::sensor::kinect2;
using Clock = std::chrono::steady_clock;

/// User and system time of this process's threads but the simulated bus.
double cpu_seconds() {
    double ticks = 0;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        std::ifstream comm(task.path() / "comm"), stat(task.path() / "stat");
        std::string name, word;
        std::getline(comm, name);
        if (name == "kinect2-bus") continue;
        std::string line;
        std::getline(stat, line);
        std::istringstream fields(line.substr(line.rfind(')') + 2));
        for (int i = 0; i < 11; ++i) fields >> word;
        double user = 0, system = 0;
        fields >> user >> system;
        ticks += user + system;
    }
    return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// Counts frames that are not as the first of their kind.
class Comparison {
  public:
    explicit Comparison(bool compares) : compares_(compares) {}

    bool damaged(const RawFrame& frame) {
        if (frame.infrared.size() != kInfraredBytes || frame.color.size() < 4) return true;
        std::vector<uint8_t>& first = first_[frame.sequence % 2];
        if (compares_ && first.empty()) first = frame.infrared;
        return compares_ && first != frame.infrared;
    }

  private:
    bool compares_;
    std::vector<uint8_t> first_[2];
};

void run(Device& device, double seconds, Comparison& comparison) {
    device.start();
    RawFrame frame;
    uint64_t frames = 0, damaged = 0;
    uint32_t first = 0;
    const auto begin = Clock::now();
    double cpu = cpu_seconds();
    while (std::chrono::duration<double>(Clock::now() - begin).count() < seconds && device.next(frame)) {
        if (frames++ == 0) first = frame.sequence;
        damaged += comparison.damaged(frame) ? 1 : 0;
    }
    cpu = cpu_seconds() - cpu;
    const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
    device.stop();
    const StreamStatistics statistics = device.statistics();
    std::printf(
        "frames %ju of %u, damaged %ju, lost %ju infrared %ju colour, unpaired %ju %ju, dropped %ju, overruns %ju, "
        "packets lost %ju, cpu %.1f %%\n",
        static_cast<uintmax_t>(frames), frames == 0 ? 0 : frame.sequence - first + 1, static_cast<uintmax_t>(damaged),
        static_cast<uintmax_t>(statistics.infrared.lost_frames), static_cast<uintmax_t>(statistics.color.lost_frames),
        static_cast<uintmax_t>(statistics.unpaired_infrared), static_cast<uintmax_t>(statistics.unpaired_color),
        static_cast<uintmax_t>(statistics.dropped_frames), static_cast<uintmax_t>(statistics.overruns),
        static_cast<uintmax_t>(statistics.infrared.lost_packets), 100 * cpu / elapsed);
}

}  // namespace

int main(int argc, char** argv) {
    const double seconds = argc > 1 ? std::atof(argv[1]) : 2;
    const int runs = argc > 2 ? std::atoi(argv[2]) : 1;
    try {
        Device device(open_usb());
        Comparison comparison(argc > 3);
        for (int i = 0; i < runs; ++i) run(device, seconds, comparison);
        if (!device.warning().empty()) std::printf("warning: %s\n", device.warning().c_str());
    } catch (const std::exception& error) {
        std::printf("error: %s\n", error.what());
        return 1;
    }
    return 0;
}
