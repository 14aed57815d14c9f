#include "tests/simulated_kinect2/bus_clock.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>

#include <pthread.h>

namespace patina::sensor::kinect2::testing {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Of a thread that was kept waiting: time that it makes up for. The rest passes for nobody.
constexpr uint64_t kMostAtOnce = 80;

}  // namespace

BusClock::BusClock(double frames_per_second, std::function<void()> pass_interval)
    : intervals_per_second_(frames_per_second * 800 / 3),
      pass_interval_(std::move(pass_interval)),
      thread_([this](std::stop_token stop) { run(stop); }) {}

void BusClock::run(const std::stop_token& stop) const {
    pthread_setname_np(pthread_self(), "kinect2-bus");
    auto last = Clock::now();
    double due = 0;
    while (!stop.stop_requested()) {
        std::this_thread::sleep_for(1ms);
        const auto now = Clock::now();
        due += std::chrono::duration<double>(now - last).count() * intervals_per_second_;
        last = now;
        const auto whole = static_cast<uint64_t>(due);
        due -= static_cast<double>(whole);
        for (uint64_t i = 0; i < std::min(whole, kMostAtOnce); ++i) pass_interval_();
    }
}

}  // namespace patina::sensor::kinect2::testing
