#pragma once

#include <chrono>

#include "sensor/kinect2/calibration.h"
#include "sensor/kinect2/commands.h"

namespace patina::sensor::kinect2 {

/// How long start_sensors() waits for a sensor that is not ready.
struct Readiness {
    std::chrono::milliseconds interval{100};
    int polls = 50;
};

/// What an opened device needs once: latencies, low power of its link, streams off. Throws Error when the link is not
/// SuperSpeed or reserves too little for the infrared stream, and as Transport.
void prepare(Transport& transport);

/// Wakes the sensors and reads what the device says of itself, in the order in which other drivers do. The streams run
/// afterwards. Throws Error when the sensor does not get ready or the host controller cannot reserve the bandwidth, and
/// as Commands::execute() and Transport.
CalibrationPages start_sensors(Transport& transport, Commands& commands, const Readiness& readiness = {});

/// Stops the streams and lets the sensors sleep. Throws as Commands::execute() and Transport.
void stop_sensors(Transport& transport, Commands& commands);

/// The last commands before a device is closed. Throws as Commands::execute().
void say_goodbye(Commands& commands);

}  // namespace patina::sensor::kinect2
