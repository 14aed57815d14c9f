#pragma once

#include <functional>
#include <stop_token>
#include <thread>

namespace patina::sensor::kinect2::testing {

/// Lets the intervals of a bus pass, in real time, on a thread named "kinect2-bus": 8000 a second at 30 frames a
/// second. It ends with the object.
class BusClock {
  public:
    BusClock(double frames_per_second, std::function<void()> pass_interval);

  private:
    void run(const std::stop_token& stop) const;

    double intervals_per_second_;
    std::function<void()> pass_interval_;
    std::jthread thread_;
};

}  // namespace patina::sensor::kinect2::testing
