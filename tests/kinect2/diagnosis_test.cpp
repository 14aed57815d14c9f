#include "sensor/kinect2/diagnosis.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "tests/export/temporary_folder.h"

namespace patina::sensor::kinect2::testing::diagnosis_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

ConnectedDevice fine() {
    ConnectedDevice device;
    device.name = "Kinect v2 at 2-1";
    device.speed = "SuperSpeed";
    device.fast_enough = true;
    device.controller.name = "Intel (8086:a36d), driver xhci_hcd";
    device.serial = "012345678901";
    return device;
}

TEST(Kinect2Diagnosis, WhatWorksHasNoRemedies) {
    Diagnosis diagnosis;
    diagnosis.devices = {fine()};
    diagnosis.usbfs_memory_mib = 64;
    EXPECT_EQ(format(diagnosis),
              "Kinect v2 at 2-1\n"
              "  speed             SuperSpeed\n"
              "  controller        Intel (8086:a36d), driver xhci_hcd\n"
              "  access            yes\n"
              "  serial number     012345678901\n"
              "  USB memory        64 MiB (usbcore.usbfs_memory_mb)\n");
}

TEST(Kinect2Diagnosis, EachObstacleHasItsRemedy) {
    Diagnosis diagnosis;
    ConnectedDevice device = fine();
    device.speed = "high speed (USB 2)";
    device.fast_enough = false;
    device.controller.doubtful = true;
    device.access_error = "Access denied";
    device.denied = true;
    diagnosis.devices = {device};
    diagnosis.usbfs_memory_mib = 8;
    EXPECT_THAT(
        format(diagnosis),
        AllOf(HasSubstr("high speed (USB 2): too slow; check that port, cable and power supply are those of USB 3"),
              HasSubstr("mostly do not carry the infrared stream"), HasSubstr("no: Access denied"),
              HasSubstr("/etc/udev/rules.d/60-kinect2.rules"),
              HasSubstr(
                  R"(    SUBSYSTEM=="usb", ATTR{idVendor}=="045e", ATTR{idProduct}=="02c4|02d8|02d9", MODE="0660", )"
                  R"(TAG+="uaccess")"),
              HasSubstr("8 MiB (usbcore.usbfs_memory_mb): too little, 16 are needed; boot with "
                        "usbcore.usbfs_memory_mb=64")));
}

TEST(Kinect2Diagnosis, AbsenceIsOneLine) {
    Diagnosis diagnosis;
    EXPECT_EQ(format(diagnosis), "Kinect v2: none is connected\n");
    diagnosis.adaptor_alone = true;
    EXPECT_THAT(format(diagnosis), HasSubstr("the adaptor is connected, the camera is not"));
    diagnosis.usb_error = "the system's USB cannot be reached: no permission";
    EXPECT_EQ(format(diagnosis), "Kinect v2: the system's USB cannot be reached: no permission\n");
}

TEST(Kinect2Diagnosis, ControllerIsTheParentOfTheBussRootHub) {
    const test::TemporaryFolder folder;
    const fs::path root = folder.path();
    const fs::path controller = root / "pci0000:00/0000:00:14.0";
    fs::create_directories(controller / "usb2");
    fs::create_directories(root / "bus");
    fs::create_directory_symlink(controller / "usb2", root / "bus/usb2");
    fs::create_directory_symlink("/sys/bus/pci/drivers/xhci_hcd", controller / "driver");
    const auto find = [&](const char* vendor) {
        std::ofstream(controller / "vendor") << vendor << "\n";
        std::ofstream(controller / "device") << "0xa36d\n";
        return find_controller(root / "bus", 2);
    };
    EXPECT_EQ(find("0x8086").name, "Intel (8086:a36d), driver xhci_hcd");
    EXPECT_FALSE(find("0x8086").doubtful);
    EXPECT_EQ(find("0x1b21").name, "ASMedia (1b21:a36d), driver xhci_hcd");
    EXPECT_TRUE(find("0x1b21").doubtful);
    EXPECT_EQ(find("0x4242").name, "unknown make (4242:a36d), driver xhci_hcd");
    EXPECT_EQ(find_controller(root / "bus", 3).name, "");
}

TEST(Kinect2Diagnosis, MemoryOfTheSystemIsRead) {
    const test::TemporaryFolder folder;
    const fs::path file = folder / "usbfs";
    const auto read = [&](const char* content) {
        std::ofstream(file) << content;
        return diagnose({"/nowhere", file}).usbfs_memory_mib;
    };
    EXPECT_EQ(read("64\n"), 64u);
    EXPECT_EQ(read("0\n"), 0u);
    EXPECT_EQ(read("many"), std::nullopt);
    EXPECT_EQ(diagnose({"/nowhere", "/nowhere/either"}).usbfs_memory_mib, std::nullopt);
    Diagnosis diagnosis;
    diagnosis.usbfs_memory_mib = 0;
    EXPECT_THAT(format(diagnosis), HasSubstr("USB memory        not limited"));
}

}  // namespace
}  // namespace patina::sensor::kinect2::testing::diagnosis_test
