#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <sys/wait.h>

#include "sensor/kinect2/raw_frame.h"

// The driver over libusb's own API, in a process that loads the stand-in. The bus runs at a third of its speed, so that
// a busy machine loses nothing.

namespace patina::sensor::kinect2::testing::usb_test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

struct Outcome {
    std::string out;
    int exit_code = -1;
};

/// Runs the probe with changes to the environment: "SPEED=high".
Outcome probe(const std::string& arguments, const std::string& changes = "") {
    std::string line = "LD_LIBRARY_PATH=" PATINA_STAND_IN_FOLDER " PATINA_KINECT2_RATE=10";
    if (!changes.empty()) line += " PATINA_KINECT2_" + changes;
    line += " timeout 60 " PATINA_KINECT2_PROBE " " + arguments + " 2>&1";
    Outcome outcome;
    FILE* pipe = popen(line.c_str(), "r");
    if (!pipe) return outcome;
    std::array<char, 4096> buffer{};
    while (fgets(buffer.data(), static_cast<int>(buffer.size()), pipe)) outcome.out += buffer.data();
    const int status = pclose(pipe);
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
    return outcome;
}

TEST(Kinect2Usb, FramesComeThroughAndStreamsStartAnew) {
    const Outcome outcome = probe("2 2 compare");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
    EXPECT_THAT(outcome.out, AllOf(ContainsRegex("frames [0-9]+ .*damaged 0.*\nframes [0-9]+ .*damaged 0"),
                                   Not(HasSubstr("frames 0 ")), Not(HasSubstr("warning"))));
}

TEST(Kinect2Usb, LostPacketsCostTheirFrames) {
    const Outcome outcome = probe("2 1 compare", "LOSE_EVERY=4");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
    EXPECT_THAT(outcome.out,
                AllOf(HasSubstr("damaged 0"), Not(HasSubstr("frames 0 ")), Not(HasSubstr("packets lost 0,"))));
}

TEST(Kinect2Usb, UnpluggingEndsTheRun) {
    for (const char* frames : {"0.01", "0.5", "5", "12"}) {
        const Outcome outcome = probe("20", std::string("UNPLUG_AFTER=") + frames);
        EXPECT_EQ(outcome.exit_code, 1);
        EXPECT_EQ(outcome.out, "error: Kinect v2 at 2-1.3 was unplugged\n") << frames;
    }
}

TEST(Kinect2Usb, DeviceThatMovesOnTheBusIsOpenedAgain) {
    const Outcome outcome = probe("1", "RESET=moves");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
    EXPECT_THAT(outcome.out, Not(HasSubstr("frames 0 ")));
}

TEST(Kinect2Usb, FewerTransfersThanAskedForAreAWarning) {
    const Outcome outcome = probe("1", "USBFS_MB=8");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.out, ContainsRegex("only [0-9]+ of 60 infrared transfers fit into the system's USB memory"));
    EXPECT_THAT(
        probe("1", "USBFS_MB=2").out,
        ContainsRegex("only [0-9]+ of 60 infrared transfers could be submitted .Insufficient memory.; boot with "
                      "usbcore.usbfs_memory_mb=64"));
}

TEST(Kinect2Usb, SubmissionsThatFailForAWhileAreMadeUpFor) {
    const Outcome outcome = probe("2 1 compare", "SUBMIT_FAILS=30");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("damaged 0"), Not(HasSubstr("frames 0 "))));
}

TEST(Kinect2Usb, TransfersThatDoNotComeBackCostTheRunAlone) {
    const Outcome outcome = probe("1", "CANCEL=hangs");
    EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
    EXPECT_THAT(outcome.out, HasSubstr("was closed, because it did not give back its transfers"));
}

TEST(Kinect2Usb, WhatKeepsItFromOpeningIsSaidInOneLine) {
    const auto reason = [](const std::string& changes) {
        const Outcome outcome = probe("1", changes);
        EXPECT_EQ(outcome.exit_code, 1);
        return outcome.out;
    };
    EXPECT_EQ(reason("DEVICE=none"), "error: no Kinect v2 is connected\n");
    EXPECT_EQ(reason("DEVICE=adaptor"),
              "error: the Kinect's adaptor is connected, the Kinect is not; check its power supply and cable\n");
    EXPECT_THAT(reason("SPEED=high"), HasSubstr("came up slower than USB 3 (SuperSpeed)"));
    EXPECT_THAT(reason("ACCESS=denied"), HasSubstr("permission denied; patina doctor prints the udev rule"));
    EXPECT_THAT(reason("ACCESS=busy"), HasSubstr("is used by another program"));
    EXPECT_THAT(reason("BANDWIDTH=none"), HasSubstr("does not reserve the bandwidth of the infrared stream"));
}

}  // namespace
}  // namespace patina::sensor::kinect2::testing::usb_test
