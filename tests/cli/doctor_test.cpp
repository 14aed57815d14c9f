#include <gmock/gmock.h>

#include "tests/cli/program.h"

// `patina doctor` over the stand-in for libusb, as a user with a Kinect meets it.

namespace patina::testing::doctor_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// `variable`: one of the stand-in, without its prefix.
Outcome doctor(const std::string& variable, const std::string& value) {
    return patina({"doctor"}, {{"LD_LIBRARY_PATH", PATINA_STAND_IN_FOLDER}, {"PATINA_KINECT2_" + variable, value}});
}

TEST(Doctor, ListsAKinectThatWorks) {
    const Outcome outcome = doctor("DEVICE", "camera");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("Kinect v2 at 2-1.3\n"), HasSubstr("speed             SuperSpeed\n"),
                                   HasSubstr("access            yes\n"), HasSubstr("serial number     012345678901\n"),
                                   HasSubstr("patina uses device")));
}

TEST(Doctor, PrintsTheUdevRuleWherePermissionLacks) {
    const Outcome outcome = doctor("ACCESS", "denied");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("access            no: Access denied"),
                                   HasSubstr(R"(SUBSYSTEM=="usb", ATTR{idVendor}=="045e")")));
}

TEST(Doctor, NamesASlowLink) { EXPECT_THAT(doctor("SPEED", "high").out, HasSubstr("high speed (USB 2): too slow")); }

TEST(Doctor, SaysThatThereIsNoKinect) {
    const Outcome outcome = doctor("DEVICE", "none");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("Kinect v2: none is connected\n"), Not(HasSubstr("2-1.3"))));
    EXPECT_THAT(doctor("DEVICE", "adaptor").out, HasSubstr("the adaptor is connected, the camera is not"));
}

}  // namespace
}  // namespace patina::testing::doctor_test
